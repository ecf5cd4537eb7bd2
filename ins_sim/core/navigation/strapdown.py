"""The strapdown: position, velocity and attitude from increments."""

import math

from ins_sim.core.attitude import integration, quaternion
from ins_sim.core.attitude.integration import Orientation
from ins_sim.core.earth import ellipsoid, frames
from . import mechanization
from .errors import ErrorMeter
from .mechanization import increments

CHANNELS = {'truth': mechanization.FROM_TRUTH, 'free': mechanization.FREE,
            'damped': mechanization.DAMPED}


class Strapdown:
    """
    The navigator of one IMU.

    settings: StrapdownSettings.  The first sample after ``initial.after_s`` starts it at the
    truth plus the initial errors; its increments serve only as the sample before.
    """

    def __init__(self, settings):
        self._settings = settings
        self._spin = ellipsoid.rotation_rate(settings.earth.rotation)
        self._integrated = settings.input == 'integrated'
        self._channel = CHANNELS[settings.vertical.channel]
        self._damping = mechanization.damping(settings.vertical.time_constant_s)
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
            phi, u = mechanization.two_sample_increments(alpha, nu, alpha_last, nu_last)
        else:
            phi, u = alpha, nu
        reference = ()
        if self._channel == mechanization.FROM_TRUTH:
            reference = (truth[2], truth[3][2])
        elif self._channel == mechanization.DAMPED:
            reference = (truth[2], *self._damping, self._wander)
        turned = self._spin * (0.5 * ((last_ns - self._start_ns) + (t_ns - self._start_ns)) * 1e-9)
        *place, self._wander = mechanization.step(self._orientation.q, *self._place, u, dt,
                                                  self._spin, turned, self._channel, reference)
        self._place = tuple(place)
        self._orientation.advance(phi, dt)
        self._last = (t_ns, alpha, nu)
        return True

    def _start(self, t_ns, truth):
        lat, lon, height, v, q_nb = truth
        initial = self._settings.initial
        error = quaternion.exponential(tuple(map(math.radians, initial.attitude_error_deg)))
        q_ib = frames.inertial_attitude(lat, lon, quaternion.multiply(error, q_nb))
        lat, lon, off_height = ellipsoid.moved(lat, lon, height, initial.position_error_m)
        v = tuple(a + b for a, b in zip(v, initial.velocity_error_m_s))
        if self._channel != mechanization.FROM_TRUTH:
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
        q_in = frames.level_frame(lat, inertial_lon)
        q_nb = quaternion.multiply(quaternion.conjugate(q_in), self._orientation.q)
        return lat, lon, height, v, q_nb

    def errors(self, t_ns, truth):
        """Return attitude, velocity, position errors and drift; once a step, in order."""
        return self._meter.measure((t_ns - self._start_ns) * 1e-9, self.state, truth)


class FreeNavigation:
    """
    The navigator of a recorded IMU, from an initial state.

    kind: one of navigate_settings.INPUTS; spin: rate of the Earth, rad/s; t_ns, omega, f: the
    sample at the start; lat, lon, height, v_n, q_nb: the state there; time_constant_s: of the
    damped vertical channel, None for the free one.
    """

    def __init__(self, kind, spin, t_ns, omega, f, initial, time_constant_s=None):
        lat, lon, height, v, q_nb = initial
        self._kind, self._spin = kind, spin
        self._state = (frames.inertial_attitude(lat, lon, q_nb), lat, lon, height, v)
        self._start_ns = self.t_ns = t_ns
        self._last, self._dt_last = (omega, f), None
        self._damping = None if time_constant_s is None else mechanization.damping(time_constant_s)
        self._wander = 0.0

    def step(self, t_ns, omega, f, height=None):
        """Take the sample of stamp t_ns; height: that of the reference, for the damping, m."""
        self._advance(self._kind, t_ns, (omega, f), height)

    def bridge(self, t_ns, omega, f, step_ns, height=None):
        """Step over a gap: rate and force go straight from the last sample to this one."""
        first_ns, (w0, f0) = self.t_ns, self._last
        count = max(1, round((t_ns - first_ns) / step_ns))
        for k in range(1, count + 1):
            part = k / count
            now = tuple(tuple(a + part * (b - a) for a, b in zip(*ends))
                        for ends in ((w0, omega), (f0, f)))
            self._advance('instant', first_ns + (t_ns - first_ns) * k // count, now, height)

    def _advance(self, kind, t_ns, now, height):
        dt = (t_ns - self.t_ns) * 1e-9
        phi, u = increments(kind, self._last, now, dt, self._dt_last or dt)
        turned = self._spin * (0.5 * ((self.t_ns - self._start_ns)
                                      + (t_ns - self._start_ns)) * 1e-9)
        channel, reference = mechanization.FREE, ()
        if self._damping is not None:
            channel, reference = mechanization.DAMPED, (height, *self._damping, self._wander)
        q_ib, *place = self._state
        *place, self._wander = mechanization.step(q_ib, *place, u, dt, self._spin, turned, channel,
                                                  reference)
        self._state = (integration.turn(q_ib, phi), *place)
        self._last, self._dt_last, self.t_ns = now, dt, t_ns

    def solution(self):
        """Return lat, lon, height, v_n, q_nb at the last sample."""
        q_ib, lat, lon, height, v = self._state
        inertial_lon = lon + self._spin * ((self.t_ns - self._start_ns) * 1e-9)
        q_in = frames.level_frame(lat, inertial_lon)
        return lat, lon, height, v, quaternion.multiply(quaternion.conjugate(q_in), q_ib)


def runs_away(solution):
    """Return whether a solution has left what the strapdown's formulas hold for."""
    lat, _, height, v, _ = solution
    return not (abs(lat) < 0.4999 * math.pi and -1e5 < height < 1e6 and math.hypot(*v) < 1e5)
