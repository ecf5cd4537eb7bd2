"""The inertial navigator of a recorded IMU: any initial state, uneven intervals, gaps."""

from . import mechanization
from .mechanization import DAMPED, FREE
from .strapdown import Strapdown


class RecordedNavigator:
    """
    The strapdown of a recorded IMU, from an initial state.

    kind: one of settings.navigate.INPUTS; spin: rate of the Earth, rad/s; t_ns, omega, f: the
    sample at the start; initial: lat, lon, height, v_n, q_nb there; time_constant_s: of the damped
    vertical channel, None for the free one.
    """

    def __init__(self, kind, spin, t_ns, omega, f, initial, time_constant_s=None):
        self._kind = kind
        channel, damping = FREE, ()
        if time_constant_s is not None:
            channel, damping = DAMPED, mechanization.damping(time_constant_s)
        self._strapdown = Strapdown(t_ns, initial, spin, channel, damping)
        self._last, self._dt_last = (omega, f), None

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb at the last sample."""
        return self._strapdown.solution

    def step(self, t_ns, omega, f, height=None):
        """Take the sample of stamp t_ns; height: that of the reference, for the damping, m."""
        self._advance(self._kind, t_ns, (omega, f), height)

    def bridge(self, t_ns, omega, f, step_ns, height=None):
        """Step over a gap: rate and force go straight from the last sample to this one."""
        first_ns, (w0, f0) = self._strapdown.t_ns, self._last
        count = max(1, round((t_ns - first_ns) / step_ns))
        for k in range(1, count + 1):
            part = k / count
            now = tuple(tuple(a + part * (b - a) for a, b in zip(*ends))
                        for ends in ((w0, omega), (f0, f)))
            self._advance('instant', first_ns + (t_ns - first_ns) * k // count, now, height)

    def _advance(self, kind, t_ns, now, height):
        dt = (t_ns - self._strapdown.t_ns) * 1e-9
        phi, u = mechanization.uneven_increments(kind, self._last, now, dt, self._dt_last or dt)
        self._strapdown.advance(t_ns, phi, u, () if height is None else (height,))
        self._last, self._dt_last = now, dt
