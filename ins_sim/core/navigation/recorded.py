"""The inertial navigator of a recorded IMU: any initial state, uneven intervals, gaps."""

import copy

from ins_sim.core.numerics.instants import seconds
from ins_sim.core.streams.faults import StreamFault
from .increments import uneven_increments
from .loop import NavigationLoop
from .strapdown import Strapdown
from .vertical_channel import DAMPED, damping, FREE, NO_DAMPING


class RecordedNavigator:
    """
    The strapdown of a recorded IMU, started with a given state at the first sample.

    Parameters
    ----------
    kind : what the readings are, one of settings.recorded_imu.INPUTS
    spin : rotation rate of the Earth, rad/s
    initial : lat, lon, height, v_n, q_nb at the first sample
    time_constant_s : time constant of the damped vertical channel, None for the free one
    gravity : terms of the gravity formula, one of ``ellipsoid.GRAVITY_TERMS``

    """

    def __init__(self, kind, spin, initial, time_constant_s=None, gravity=None):
        self._kind, self._spin, self._initial = kind, spin, initial
        self._gravity = gravity
        self._channel, self._damping = FREE, NO_DAMPING
        if time_constant_s is not None:
            self._channel, self._damping = DAMPED, damping(time_constant_s)
        self._strapdown = self._bridge_ns = None

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb at the last sample."""
        return self._strapdown.solution

    def copy(self):
        """Return a snapshot."""
        other = copy.copy(self)
        if self._strapdown is not None:
            other._strapdown = self._strapdown.copy()
        return other

    def bridge_next(self, step_ns):
        """
        Bridge the gap between the last sample and the next one, in steps of about step_ns.

        Rate and force are interpolated linearly between the two samples.
        """
        self._bridge_ns = step_ns

    def step(self, t_ns, omega, f, height=0.0):
        """
        Process the sample with stamp t_ns; return lat, lon, height, v_n, q_nb at that instant.

        omega, f: rad/s and m/s^2; height: reference height for the damping, m.
        """
        if self._strapdown is None:
            self._strapdown = Strapdown(t_ns, self._initial, self._spin, self._channel,
                                        self._damping, gravity=self._gravity)
            self._last, self._dt_last = (omega, f), None
        elif self._bridge_ns is not None:
            self._bridge(t_ns, (omega, f), height)
            self._bridge_ns = None
        else:
            self._advance(self._kind, t_ns, (omega, f), height)
        return self._strapdown.solution

    def _bridge(self, t_ns, end, height):
        first_ns, start = self._strapdown.t_ns, self._last
        count = max(1, round((t_ns - first_ns) / self._bridge_ns))
        for k in range(1, count + 1):
            part = k / count
            now = tuple(tuple(a + part * (b - a) for a, b in zip(*ends))
                        for ends in zip(start, end))
            self._advance('instant', first_ns + (t_ns - first_ns) * k // count, now, height)

    def _advance(self, kind, t_ns, now, height):
        dt = (t_ns - self._strapdown.t_ns) * 1e-9
        phi, u = uneven_increments(kind, self._last, now, dt, self._dt_last or dt)
        self._strapdown.advance(t_ns, phi, u, height)
        self._last, self._dt_last = now, dt


class RecordedLoop(NavigationLoop):
    """
    Steps a RecordedNavigator until the first gap, or across gaps by linear interpolation.

    Parameters
    ----------
    make_navigator : see NavigationLoop
    step_ns : typical step of the stamps, ns
    limit_ns : longest step that is not a gap, ns
    bridges_ns : longest gap that is bridged, ns; 0 to bridge no gap

    Attributes
    ----------
    gap : description of the gap that ended the loop, or None
    bridged : number of gaps bridged

    """

    def __init__(self, make_navigator, step_ns, limit_ns, bridges_ns):
        super().__init__(make_navigator, step_ns)
        self._limit_ns, self._bridges_ns, self._gap_ns = limit_ns, bridges_ns, 0
        self.gap, self.bridged = None, 0

    def check(self, t_ns, last_ns):
        """Raise StreamFault for a gap; shorter steps may have any length."""
        if t_ns - last_ns > self._limit_ns:
            self._gap_ns = t_ns - last_ns
            raise StreamFault(f'gap of {(t_ns - last_ns) * 1e-9:.6g} s from {seconds(last_ns)}',
                              restart=True)

    def recover(self, fault):
        """Bridge the gap or end the loop; return whether the loop continues."""
        if self._gap_ns > self._bridges_ns:
            self.gap = str(fault)
            return False
        self.navigator.bridge_next(self.dt_ns)
        self.bridged += 1
        return True
