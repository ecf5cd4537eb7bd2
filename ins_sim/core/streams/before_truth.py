"""The motion before the first sample of streamed truth, for channels that need the past."""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.rotation_vectors import exponentials

# With a delay above this fraction of the truth step, the change of the motion is extrapolated.
# Below it the first value is held, with an error of half the delay times the rate of change: 5 %
# of the change in one step.
SHORT = 0.1
# The change is not extrapolated further back than this from the first sample, s.
LINE_S = 0.05


class BeforeTruth:
    """
    The motion before the first sample: extrapolated backwards, or at rest.

    Rate and specific force follow the straight line through the first two samples for LINE_S and
    are constant before that. For delays below SHORT steps the first value is held. No knowledge
    of the earlier motion is needed.

    Parameters
    ----------
    first : the first sample (t_ns, q_mb, omega_mb_b, FORCE_M, RATE, FORCE_B)
    frozen : whether the vehicle was at rest before
    delay_ns : longest delay of a channel, ns

    """

    def __init__(self, first, frozen, delay_ns):
        self.first = first
        self._frozen, self._delay_ns, self._slopes = frozen, delay_ns, None

    def take_second(self, sample):
        """Set the second sample; needed before any value of the past is requested."""
        step_ns = sample[0] - self.first[0]
        if not self._frozen and self._delay_ns > SHORT * step_ns:
            per_s = 1e9 / step_ns
            self._slopes = (None, None, *(tuple((b - a) * per_s for a, b in zip(*ends))
                                          for ends in zip(self.first[2:], sample[2:])))

    def attitude(self, t_ns):
        """Return q_mb at an instant that is not later than the first sample."""
        first_ns, q = self.first[:2]
        if self._frozen or t_ns == first_ns:
            return q
        s = (t_ns - first_ns) * 1e-9
        if self._slopes is None or s >= -LINE_S:
            return quaternion.multiply(q, quaternion.exponential(self._turn(s)))
        q = quaternion.multiply(q, quaternion.exponential(self._turn(-LINE_S)))
        return quaternion.multiply(q, quaternion.exponential(self._early_turn(s)))

    def attitudes(self, t_ns):
        """Return q_mb (n, 4) at instants (n,) before the first sample."""
        first_ns, q = self.first[:2]
        if self._frozen:
            return np.tile(q, (len(t_ns), 1))
        s = (t_ns - first_ns) * 1e-9
        if self._slopes is None:
            return np.stack(quaternion.multiply(q, exponentials(self._turn(s))), axis=-1)
        found = np.stack(quaternion.multiply(q, exponentials(
            self._turn(np.maximum(s, -LINE_S)))), axis=-1)
        early = np.flatnonzero(s < -LINE_S)
        if len(early):
            turned = exponentials(self._early_turn(s[early]))
            found[early] = np.stack(quaternion.multiply(tuple(found[early].T), turned), axis=-1)
        return found

    def _turn(self, s):
        """Return the rotation vector from the first sample to s seconds after it (s < 0), rad."""
        w = self.first[2]
        if self._slopes is None:
            return w[0] * s, w[1] * s, w[2] * s
        a, square = self._slopes[2], s * s
        half, twelfth = 0.5 * square, square * s / 12.0
        # The rotation for the rate w + a s is its integral plus the coning of the two terms.
        c = quaternion.cross(w, a)
        return (w[0] * s + a[0] * half + c[0] * twelfth, w[1] * s + a[1] * half + c[1] * twelfth,
                w[2] * s + a[2] * half + c[2] * twelfth)

    def _early_turn(self, s):
        """Return the rotation vector from LINE_S before the first sample to s seconds after it."""
        return tuple((w - LINE_S * a) * (s + LINE_S)
                     for w, a in zip(self.first[2], self._slopes[2]))

    def value(self, t_ns, field):
        """Return FORCE_M, RATE or FORCE_B at instants before the first sample; float or array."""
        value = self.first[field]
        if self._slopes is None:
            return value
        s = (t_ns - self.first[0]) * 1e-9
        s = np.maximum(s, -LINE_S) if isinstance(s, np.ndarray) else max(s, -LINE_S)
        return tuple(x + slope * s for x, slope in zip(value, self._slopes[field]))
