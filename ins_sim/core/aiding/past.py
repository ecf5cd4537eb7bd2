"""Snapshots, samples and fixes of the recent past, for processing fixes that arrive late."""

from bisect import bisect_right, insort
from collections import deque
from itertools import takewhile
import math
from typing import Any, NamedTuple

from .segment import Samples

SNAPSHOT_NS = 1_000_000_000


class FixEntry(NamedTuple):
    """A fix and its source."""

    source: str
    fix: Any


class FlownSamples(NamedTuple):
    """Samples that were processed: those from first to stop, stop excluded."""

    samples: Samples
    first: int
    stop: int

    @property
    def end_ns(self):
        """Return the stamp of the last sample."""
        return self.samples.t_ns[self.stop - 1]

    def after(self, t_ns):
        """Return the samples after an instant."""
        return self._replace(first=bisect_right(self.samples.t_ns, t_ns, self.first, self.stop))


class Past:
    """
    Snapshots, and the samples and fixes since the first of them.

    buffer_ns: largest age of a fix; dt_ns: sampling period. A fix is processed at the next sample,
    up to one period after its own instant.
    """

    def __init__(self, buffer_ns, dt_ns):
        self._buffer_ns, self._dt_ns = buffer_ns, dt_ns
        self._snapshots, self._flown, self._fixes = deque(), deque(), []
        # Instant at which the next snapshot is due.
        self.next_ns = -math.inf

    @property
    def start_ns(self):
        """Return the instant of the first snapshot: the earliest that a fix may have."""
        return self._snapshots[0].ins.t_ns

    def add_samples(self, samples, first, stop):
        """Remember samples that were processed."""
        self._flown.append(FlownSamples(samples, first, stop))

    def add_fix(self, entry):
        """Remember a FixEntry; return whether it is the latest of all known ones."""
        insort(self._fixes, entry, key=_instant)
        return self._fixes[-1] is entry

    def knows(self, entry):
        """Return whether a fix of that source and instant has arrived before."""
        newer = takewhile(lambda other: other.fix.t_ns >= entry.fix.t_ns, reversed(self._fixes))
        return any(_instant(other) == _instant(entry) for other in newer)

    def add_snapshot(self, flight):
        """Remember a copy of a FilteredStrapdown."""
        self._snapshots.append(flight.copy())
        self.next_ns = flight.ins.t_ns + SNAPSHOT_NS

    def forget(self, t_ns):
        """Forget everything too old to be needed by a fix that arrives at t_ns."""
        oldest_ns = t_ns - self._buffer_ns
        while len(self._snapshots) > 1 and self._snapshots[1].ins.t_ns <= oldest_ns:
            self._snapshots.popleft()
        while self._flown and self._flown[0].end_ns <= self.start_ns:
            self._flown.popleft()
        while self._fixes and self._fixes[0].fix.t_ns <= self.start_ns - self._dt_ns:
            self._fixes.pop(0)

    def go_back(self, t_ns):
        """
        Forget the snapshots after an instant and go back to the last one before it.

        Return a copy of that snapshot, and the FlownSamples and FixEntries since.
        """
        while self._snapshots[-1].ins.t_ns > t_ns:
            self._snapshots.pop()
        flight, start_ns = self._snapshots[-1].copy(), self._snapshots[-1].ins.t_ns
        self.next_ns = start_ns + SNAPSHOT_NS
        flown = (run.after(start_ns) for run in self._flown if run.end_ns > start_ns)
        fixes = (e for e in self._fixes if e.fix.t_ns > start_ns - self._dt_ns)
        return flight, deque(flown), deque(fixes)


def _instant(entry):
    return entry.fix.t_ns, entry.source
