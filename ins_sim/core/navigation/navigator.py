"""The inertial navigator of a simulated IMU: started from the truth, compared with the truth."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from . import mechanization
from .errors import ErrorMeter
from .mechanization import DAMPED, FREE, FROM_TRUTH
from .strapdown import Strapdown

CHANNELS = {'truth': FROM_TRUTH, 'free': FREE, 'damped': DAMPED}


class InertialNavigator:
    """
    The strapdown of one IMU, without aiding but for its vertical channel.

    settings: StrapdownSettings.  The first sample after ``initial.after_s`` starts it at the
    truth plus the initial errors; its increments serve only as the sample before.
    """

    def __init__(self, settings):
        self._settings = settings
        self._spin = ellipsoid.rotation_rate(settings.earth.rotation)
        self._integrated = settings.input == 'integrated'
        self._channel = CHANNELS[settings.vertical.channel]
        self._after_ns = round(settings.initial.after_s * 1e9)
        self._strapdown = self._first_ns = None

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self._strapdown is not None

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb at the last sample."""
        return self._strapdown.solution

    def step(self, t_ns, omega, f, truth):
        """
        Take the reading that ends at t_ns; return the errors of the solution, or None before it.

        omega, f: tuples, rad/s and m/s^2; truth: (lat, lon, height, v_n, q_nb) at t_ns.  The
        errors are those of ``ErrorMeter``: attitude, velocity, position, drift.
        """
        ins = self._strapdown
        if ins is None:
            if self._first_ns is None:
                self._first_ns = t_ns
            if t_ns < self._first_ns + self._after_ns:
                return None
            self._start(t_ns, truth)
            ins = self._strapdown
            self._last = mechanization.integrals(omega, f, 1.0 / self._settings.rate_hz)
        else:
            now = mechanization.integrals(omega, f, (t_ns - ins.t_ns) * 1e-9)
            phi, u = mechanization.fixed_rate_increments(self._integrated, now, self._last)
            self._last = now
            ins.advance(t_ns, phi, u, self._reference(truth))
        return self._meter.measure(ins.elapsed_s, (ins.q_ib, ins.lat, ins.lon, ins.height, ins.v),
                                   truth)

    def _reference(self, truth):
        if self._channel == FROM_TRUTH:
            return truth[2], truth[3][2]
        return (truth[2],) if self._channel == DAMPED else ()

    def _start(self, t_ns, truth):
        lat, lon, height, v, q_nb = truth
        initial, vertical = self._settings.initial, self._settings.vertical
        damping = ()
        if self._channel == DAMPED:
            damping = mechanization.damping(vertical.time_constant_s)
        error = quaternion.exponential(tuple(map(math.radians, initial.attitude_error_deg)))
        ins = Strapdown(t_ns, (lat, lon, height, v, quaternion.multiply(error, q_nb)), self._spin,
                        self._channel, damping, self._settings.orientation)
        # The attitude error is one of the inertial attitude, which the place does not change.
        ins.lat, ins.lon, off_height = ellipsoid.moved(lat, lon, height, initial.position_error_m)
        ins.v = tuple(a + b for a, b in zip(v, initial.velocity_error_m_s))
        if self._channel != FROM_TRUTH:
            ins.height = off_height
        else:
            ins.v = (*ins.v[:2], v[2])
        self._strapdown, self._meter = ins, ErrorMeter(self._spin)
