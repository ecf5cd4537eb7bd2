"""
The strapdown over recorded samples: any rate, jitter of the stamps, no truth beside it.

A sample is the value at its stamp, the mean since the sample before, or the rotation vector and
the inertially rotated velocity increment over that interval, by the interval.
"""

import math

from . import attitude, orientation, strapdown


def increments(kind, last, now, dt, dt_last):
    """
    Return the rotation vector and the velocity increment of the interval that ends now.

    kind: one of navigate_settings.INPUTS; last, now: (omega, f) at the stamps; dt, dt_last: this
    interval and the one before, s.  Rate and force are taken to be straight lines in time.  Two
    values at the ends of one interval have the cross products of twice their product with the
    trapezoid; two means over unequal intervals those of the earlier one, scaled.
    """
    (w0, f0), (w1, f1) = last, now
    if kind == 'rotation_vector':
        return _scaled(w1, dt), _scaled(f1, dt)
    if kind == 'integrated':
        scale = dt * 2.0 * dt / (dt + dt_last)
        return strapdown.two_sample_increments(_scaled(w1, dt), _scaled(f1, dt),
                                               _scaled(w0, scale), _scaled(f0, scale))
    half = 0.5 * dt
    alpha = (half * (w0[0] + w1[0]), half * (w0[1] + w1[1]), half * (w0[2] + w1[2]))
    nu = (half * (f0[0] + f1[0]), half * (f0[1] + f1[1]), half * (f0[2] + f1[2]))
    return strapdown.two_sample_increments(alpha, nu, _scaled(w0, 2.0 * dt),
                                           _scaled(f0, 2.0 * dt))


def _scaled(v, s):
    return s * v[0], s * v[1], s * v[2]


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
        self._state = (strapdown.inertial_attitude(lat, lon, q_nb), lat, lon, height, v)
        self._start_ns = self.t_ns = t_ns
        self._last, self._dt_last = (omega, f), None
        self._damping = None if time_constant_s is None else strapdown.damping(time_constant_s)
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
        channel, reference = strapdown.FREE, ()
        if self._damping is not None:
            channel, reference = strapdown.DAMPED, (height, *self._damping, self._wander)
        q_ib, *place = self._state
        *place, self._wander = strapdown.step(q_ib, *place, u, dt, self._spin, turned, channel,
                                              reference)
        self._state = (orientation.turn(q_ib, phi), *place)
        self._last, self._dt_last, self.t_ns = now, dt, t_ns

    def solution(self):
        """Return lat, lon, height, v_n, q_nb at the last sample."""
        q_ib, lat, lon, height, v = self._state
        inertial_lon = lon + self._spin * ((self.t_ns - self._start_ns) * 1e-9)
        q_in = strapdown.level_frame(lat, inertial_lon)
        return lat, lon, height, v, attitude.multiply(attitude.conjugate(q_in), q_ib)


def runs_away(solution):
    """Return whether a solution has left what the strapdown's formulas hold for."""
    lat, _, height, v, _ = solution
    return not (abs(lat) < 0.4999 * math.pi and -1e5 < height < 1e6 and math.hypot(*v) < 1e5)
