"""What a node says on its log: each kind of sentence once, then more and more rarely, cut."""

import math
import re
import time

from ins_sim.settings.shown import cut
from ins_sim.visible_text import visible

# of a sentence, which may repeat a stranger's text
LONGEST = 400
# sentences of the same kind: after so long, then after twice as long, up to the last
FIRST_S, LAST_S = 1.0, 64.0
# kinds that are remembered, and lines of new kinds: so many at once, and so many a second
KINDS, AT_ONCE, PER_SECOND = 100, 20, 2.0
_VARIES = re.compile(r"'[^']*'|\b(nan|inf)\b|[-+.\d]+(e[-+]?\d+)?")


def short(text, longest=LONGEST):
    """Return a text cut, with what cannot be seen in it as escapes."""
    return visible(cut(text, longest))


def kind(sentence):
    """Return a sentence without numbers and quoted texts: which kind of fault it tells of."""
    return _VARIES.sub('#', sentence)


class Said:
    """
    Lets a sentence through to log(sentence), or counts it.

    However many are said, and whatever they hold, the log and the memory of it stay small.
    """

    def __init__(self, log):
        self._log = log
        self._kinds = {}
        self._left, self._left_at, self._unsaid = AT_ONCE, -math.inf, 0

    def say(self, sentence):
        """Log a sentence, unless its kind was just said; ``short`` must have cut it."""
        now, name = time.monotonic(), kind(sentence)
        due, pause_s, more = self._kinds.pop(name, (now, FIRST_S, 0))
        if now < due:
            self._kinds[name] = due, pause_s, more + 1
            return
        if now > due + LAST_S:
            pause_s = FIRST_S
        if not self._may_say(now):
            self._unsaid += 1 + more
            return
        if more:
            sentence += f' ({more} more of this kind before it)'
        if self._unsaid:
            sentence += f' ({self._unsaid} other faults were not said)'
            self._unsaid = 0
        self._kinds[name] = now + pause_s, min(2.0 * pause_s, LAST_S), 0
        while len(self._kinds) > KINDS:
            del self._kinds[next(iter(self._kinds))]
        self._log(sentence)

    def _may_say(self, now):
        self._left = min(AT_ONCE, self._left + PER_SECOND * (now - self._left_at))
        self._left_at = now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True
