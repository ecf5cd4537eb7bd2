"""One dynamically tuned gyro, step by step."""

import math
import warnings

import numpy as np

from ins_sim.core.numerics import compilation
from ins_sim.core.numerics.fixed_order import product, solve
from .rotor_step import disturbed_step, rotor_stages, rotor_step, run_rotor
from .stability import rk4_window
from .state_space import state_space
from .step_matrices import disturbance_matrix, exact_matrices, HOLDS, METHODS, rk4_matrices


def _check_stability(roots, dt_s, method):
    """Return a sentence that says why the integration is unstable, or None if it is stable."""
    if method == 'exact':
        if roots[0].real < 0.0:
            return None
        return (f'the gyro is unstable: a root grows with {roots[0].real:.4g} 1/s at '
                f'{abs(roots[0].imag) / (2.0 * math.pi):.4g} Hz; expected every root to decay')
    window = rk4_window(roots)
    if window is None:
        return 'the gyro is unstable and no RK4 step damps it; expected every root to decay'
    if window[0] < dt_s < window[1]:
        return None
    return (f'the RK4 step is {1e3 * dt_s:g} ms, at which the gyro is unstable; expected between '
            f'{1e3 * window[0]:.4g} and {1e3 * window[1]:.4g} ms')


def floats_of(rows):
    """Return a complex array as nested tuples of floats, two for each number."""
    found = np.ascontiguousarray(rows, dtype=complex).view(float)
    return tuple(map(tuple, found.tolist())) if found.ndim == 2 else tuple(found.tolist())


class TunedGyro:
    """
    One tuned gyro: rates in, mean readings out. Raises ValueError if the steps would diverge.

    Parameters
    ----------
    parameters : TunedGyroParameters
    dt_s : step, s
    method : exact or rk4
    hold : quadratic or linear; used by the exact method
    on_unstable : refuse or warn
    speed_hz : speed of the rotor if it is not the nominal one

    Attributes
    ----------
    state : (theta, v) or, in closed loop, (theta, v, integral of theta), rad, rad/s, rad s, as
        four or six floats; it can be saved and set back. At first it is zero: a rotor without tilt
        that does not turn in inertial space (see ``settle``)
    gains, added, stages : constants of the functions of ``rotor_step``; stages for RK4 only
    """

    def __init__(self, parameters, dt_s, method='exact', hold='quadratic', on_unstable='refuse',
                 speed_hz=None):
        for name, value, choices in (('method', method, METHODS), ('hold', hold, HOLDS),
                                     ('on_unstable', on_unstable, ('refuse', 'warn'))):
            if value not in choices:
                raise ValueError(f'{name} is {value!r}; expected {" or ".join(choices)}')
        if not 0.0 < dt_s < math.inf:
            raise ValueError(f'dt_s is {dt_s!r}; expected a finite number above 0')
        self.parameters, self.dt_s = parameters, dt_s
        self._options = method, hold, on_unstable
        self._build(speed_hz)
        self.state = (0.0,) * (2 * len(self._space.g))

    def _build(self, speed_hz):
        method, hold, on_unstable = self._options
        space = state_space(self.parameters, speed_hz)
        sentence = _check_stability(space.roots, self.dt_s, method)
        if sentence and on_unstable == 'refuse':
            raise ValueError(sentence)
        if sentence:
            warnings.warn(sentence, stacklevel=3)
        self.stages = None
        if method == 'exact':
            table = exact_matrices(space, self.dt_s, hold)
            added = disturbance_matrix(table, space, self.dt_s,
                                       lambda s: exact_matrices(s, self.dt_s, hold))
        else:
            table, stages = rk4_matrices(space, self.dt_s)
            added = disturbance_matrix(table, space, self.dt_s,
                                       lambda s: rk4_matrices(s, self.dt_s)[0])
            self.stages = floats_of(stages)
        self.speed_hz = self.parameters.speed_hz if speed_hz is None else speed_hz
        self._space, self.matrices = space, (table, added)
        self.gains, self.added = floats_of(table), floats_of(added)

    @property
    def space(self):
        """The StateSpace at the present speed."""
        return self._space

    @property
    def physical_state(self):
        """The state as complex numbers."""
        return tuple(map(complex, self.state[::2], self.state[1::2]))

    def set_speed(self, speed_hz):
        """Continue with another rotor speed: the tilt is kept, the matrices are rebuilt."""
        if not 0.0 < speed_hz < math.inf:
            raise ValueError(f'speed_hz is {speed_hz!r}; expected a finite number above 0')
        self._build(speed_hz)

    def settle(self, u, moment=0.0, tilt=0.0):
        """Set the steady state at the constant rate u, moment (rad/s) and pick-off tilt (rad)."""
        space = self._space
        driven = product(np.column_stack((space.g, space.moment, space.tilt)),
                         np.array(((u,), (moment,), (tilt,)), dtype=complex))
        self.state = floats_of(solve(space.f, -driven[:, 0]))

    def step(self, u_start, u_mid, u_end):
        """Advance by dt with rates u_y + j u_z of the case, rad/s; return the mean reading."""
        self.state, mean = rotor_step(self.gains, self.state, floats_of((u_start, u_mid, u_end)))
        return complex(*mean)

    def step_disturbed(self, u_start, u_mid, u_end, moment, tilt, jump):
        """
        Advance by dt under disturbances, otherwise as ``step``; return the mean reading.

        Parameters
        ----------
        u_start, u_mid, u_end : complex rates of the case, rad/s
        moment : complex disturbing moment as the equivalent rate, rad/s, constant over the step
        tilt : complex pick-off error, rad, constant over the step
        jump : change of tilt since the step before, rad
        """
        self.state, mean = disturbed_step(
            self.gains, self.added, self.state, floats_of((u_start, u_mid, u_end)),
            floats_of((moment, tilt, jump)))
        return complex(*mean)

    def reading(self, u):
        """Return the reading at this instant for the rate u, rad/s."""
        total = self._space.d * u
        for gain, x in zip(self._space.c.tolist(), self.physical_state):
            total += gain * x
        return total

    def step_stages(self, u_start, u_mid, u_end):
        """Advance by dt with RK4; return the readings at its four stages."""
        u = floats_of((u_start, u_mid, u_end))
        found = rotor_stages(self.stages, self.state, u)
        self.state, _ = rotor_step(self.gains, self.state, u)
        return [complex(*reading) for reading in found]

    def run(self, u, d=None):
        """
        Return the mean readings (n, 2), real and imaginary parts, of n steps.

        Parameters
        ----------
        u, d : (n, 6) inputs of the steps, see ``rotor_step``; d may be None
        """
        readings = np.empty((len(u), 2))
        self.state = compilation.run(
            run_rotor, len(u), (len(u), self.gains, self.added, self.state, u, d), readings)
        return readings

    def advance(self, u):
        """Return the mean readings (n,) of n steps; u (n, 3): complex rates as for ``step``."""
        return self.run(np.ascontiguousarray(u, dtype=complex).view(float)).view(complex)[:, 0]
