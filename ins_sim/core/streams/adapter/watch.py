"""Whether the scheme that the first look has chosen still fits."""

from collections import deque

from .judgement import FEWEST, judged
from .scheme import chosen, report

# How long a time is judged, and after how many of them in doubt the twist is given up.
WATCH_NS, DOUBTS = 2_000_000_000, 2
# Knots of a high rate that are enough.
MOST = 1024


class Watch:
    """
    Judges the knots of every two seconds, and chooses again where the scheme does not fit.

    A vehicle that stood still at the start says nothing of its twist: that is settled when it
    moves.  What has been given up is not believed again.

    settings: TruthAdapterSettings; name: of the input; dt_ns: period of the IMU; beginning: what
    the first look has found.

    Attributes
    ----------
    scheme : Scheme
    spread_m : float
        Noise of the positions, by the last judgement.
    """

    def __init__(self, settings, name, dt_ns, beginning):
        self._settings, self._name, self._dt_ns = settings, name, dt_ns
        self._steady, self.scheme = beginning.steady, beginning.scheme
        self.spread_m = beginning.judgement.spread_m
        self.restart()

    def restart(self):
        """Forget the knots."""
        self.knots = deque(maxlen=MOST)
        self._judged_ns, self._doubts = None, 0

    def push(self, knot):
        """Take a knot; return a sentence where the scheme has changed, or ''."""
        knots, t_ns = self.knots, knot.t_ns
        knots.append(knot)
        while t_ns - knots[0].t_ns > WATCH_NS:
            knots.popleft()
        if self._judged_ns is None:
            self._judged_ns = t_ns
        if t_ns - self._judged_ns < WATCH_NS or len(knots) < FEWEST:
            return ''
        self._judged_ns = t_ns
        scheme = self.scheme
        judgement = judged(knots, scheme.in_parent)
        self.spread_m = judgement.spread_m
        if self._settings.twist != 'auto':
            return ''
        if scheme.settled:
            if not scheme.by_twist:
                return ''
            self._doubts = self._doubts + 1 if judgement.why_not(surely=True) else 0
            if self._doubts < DOUBTS:
                return ''
        elif judgement.empty and not judgement.why_not():
            return ''
        frame = self._settings.twist_frame
        judgement = judged(knots, None if frame == 'auto' else frame == 'parent')
        self.scheme = chosen(self._settings, judgement, self._steady, self._dt_ns)
        self._doubts = 0
        return report(self._name, self.scheme, judgement, self._steady)
