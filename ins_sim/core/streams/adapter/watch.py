"""Repeated judgement of the input: does the scheme chosen at the first look still fit?"""

from collections import deque

from .judgement import FEWEST, judged
from .scheme import chosen, report

# Length of a judgement, and number of consecutive doubtful ones after which the twist is rejected.
WATCH_NS, DOUBTS = 2_000_000_000, 2
# Number of knots that is sufficient at a high rate.
MOST = 1024


class Watch:
    """
    Judges the knots every two seconds, and chooses a new scheme if the present one does not fit.

    The twist of a vehicle that was at rest at the start can only be judged once it moves. A twist
    that has been rejected is not used again.

    Parameters
    ----------
    settings : TruthAdapterSettings
    name : name of the input, for messages
    dt_ns : period of the IMU, ns
    beginning : Beginning, the result of the first look

    Attributes
    ----------
    scheme : Scheme
    spread_m : float
        Noise of the positions according to the last judgement, m.
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
        """Process a knot; return a sentence if the scheme has changed, otherwise ''."""
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
