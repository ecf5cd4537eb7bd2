"""Limit the log of a node: repeated messages of one kind at growing intervals, long ones cut."""

import math
import re
import time

from ins_sim.settings.shown import cut
from ins_sim.visible_text import visible

# Maximum length of a message, which may quote text received from elsewhere.
LONGEST = 400
# Messages of one kind are logged again after FIRST_S, then after twice as long each time, up to
# LAST_S.
FIRST_S, LAST_S = 1.0, 64.0
# Number of kinds remembered; limits of lines of new kinds: a burst, and a rate per second.
KINDS, AT_ONCE, PER_SECOND = 100, 20, 2.0
_VARIES = re.compile(r"'[^']*'|\b(nan|inf)\b|[-+.\d]+(e[-+]?\d+)?")


def short(text, longest=LONGEST):
    """Return a text cut to a length, with invisible characters escaped."""
    return visible(cut(text, longest))


def kind(sentence):
    """Return the kind of a message: the sentence without numbers and quoted text."""
    return _VARIES.sub('#', sentence)


class Said:
    """
    Passes a message on to log(sentence), or counts it.

    Log and memory stay small, whatever the number and content of the messages.
    """

    def __init__(self, log):
        self._log = log
        self._kinds = {}
        self._left, self._left_at, self._unsaid = AT_ONCE, -math.inf, 0

    def say(self, sentence):
        """Log a sentence unless its kind was logged recently; pass it through ``short`` first."""
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
            sentence += f' ({self._unsaid} other faults were not logged)'
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
