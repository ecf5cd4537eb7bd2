"""
The strapdown system: start from truth, step on IMU samples, compare with truth.

``Strapdown`` takes matched samples; ``Navigator`` those of two streams.
"""

import math

from . import attitude, earth, strapdown
from .errors import ErrorMeter
from .matching import MatchedStreams
from .orientation import Orientation

CHANNELS = {'truth': strapdown.FROM_TRUTH, 'free': strapdown.FREE, 'damped': strapdown.DAMPED}


class Strapdown:
    """
    The navigator of one IMU.

    settings: StrapdownSettings.  The first sample after ``initial.after_s`` starts it at the
    truth plus the initial errors; its increments serve only as the sample before.
    """

    def __init__(self, settings):
        self._settings = settings
        self._spin = earth.ROTATION_RATE if settings.earth.rotation else 0.0
        self._integrated = settings.input == 'integrated'
        self._channel = CHANNELS[settings.vertical.channel]
        self._damping = strapdown.damping(settings.vertical.time_constant_s)
        self._after_ns = round(settings.initial.after_s * 1e9)
        self._place = self._orientation = None
        self._first_ns = None

    @property
    def state(self):
        """Return (q_ib, lat, lon, height, v), or None before the start."""
        return None if self._place is None else (self._orientation.q, *self._place)

    def step(self, t_ns, omega, f, truth):
        """
        Take the reading that ends at t_ns and the truth then; return whether it navigates.

        omega, f: tuples, rad/s and m/s^2; truth: (lat, lon, height, v_n, q_nb).
        """
        if self._place is None:
            if self._first_ns is None:
                self._first_ns = t_ns
            if t_ns < self._first_ns + self._after_ns:
                return False
            self._start(t_ns, truth)
            dt = 1.0 / self._settings.rate_hz
            self._last = (t_ns, tuple(w * dt for w in omega), tuple(a * dt for a in f))
            return True
        last_ns, alpha_last, nu_last = self._last
        dt = (t_ns - last_ns) * 1e-9
        alpha = (omega[0] * dt, omega[1] * dt, omega[2] * dt)
        nu = (f[0] * dt, f[1] * dt, f[2] * dt)
        if self._integrated:
            phi, u = strapdown.two_sample_increments(alpha, nu, alpha_last, nu_last)
        else:
            phi, u = alpha, nu
        reference = ()
        if self._channel == strapdown.FROM_TRUTH:
            reference = (truth[2], truth[3][2])
        elif self._channel == strapdown.DAMPED:
            reference = (truth[2], *self._damping, self._wander)
        turned = self._spin * (0.5 * ((last_ns - self._start_ns) + (t_ns - self._start_ns)) * 1e-9)
        *place, self._wander = strapdown.step(self._orientation.q, *self._place, u, dt, self._spin,
                                              turned, self._channel, reference)
        self._place = tuple(place)
        self._orientation.advance(phi, dt)
        self._last = (t_ns, alpha, nu)
        return True

    def _start(self, t_ns, truth):
        lat, lon, height, v, q_nb = truth
        initial = self._settings.initial
        error = attitude.exponential(tuple(map(math.radians, initial.attitude_error_deg)))
        q_ib = strapdown.inertial_attitude(lat, lon, attitude.multiply(error, q_nb))
        lat, lon, off_height = earth.displaced(lat, lon, height, initial.position_error_m)
        v = tuple(a + b for a, b in zip(v, initial.velocity_error_m_s))
        if self._channel != strapdown.FROM_TRUTH:
            height = off_height
        else:
            v = (*v[:2], truth[3][2])
        self._orientation = Orientation(self._settings.orientation, q_ib)
        self._place = (lat, lon, height, v)
        self._start_ns = t_ns
        self._wander = 0.0
        self._meter = ErrorMeter(self._spin)

    def solution(self, t_ns):
        """Return lat, lon, height, v_n, q_nb at the last step."""
        lat, lon, height, v = self._place
        inertial_lon = lon + self._spin * ((t_ns - self._start_ns) * 1e-9)
        q_in = strapdown.level_frame(lat, inertial_lon)
        q_nb = attitude.multiply(attitude.conjugate(q_in), self._orientation.q)
        return lat, lon, height, v, q_nb

    def errors(self, t_ns, truth):
        """Return attitude, velocity, position errors and drift; once a step, in order."""
        return self._meter.measure((t_ns - self._start_ns) * 1e-9, self.state, truth)


class Navigator(MatchedStreams):
    """A Strapdown on two live streams, IMU and truth; outputs are (t_ns, solution, errors)."""

    def begin(self):
        """Forget the solution."""
        self._strapdown = Strapdown(self._settings)

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self._strapdown.state is not None

    def advance(self, t_ns, omega, f, truth):
        """Take matched samples; return the outputs."""
        if not self._strapdown.step(t_ns, omega, f, truth):
            return []
        return [(t_ns, self._strapdown.solution(t_ns), self._strapdown.errors(t_ns, truth))]
