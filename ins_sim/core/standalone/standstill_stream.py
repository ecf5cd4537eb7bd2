"""Search for a standstill in samples that arrive one by one, as in a complete recording."""

import numpy as np

from ins_sim.core.postprocessing.standstill import standstill_of, StandstillSearch
from ins_sim.core.postprocessing.windows import together_at, window_length_ns, WindowMoments
from .samples import recorded

# Number of windows without a standstill after which the obstacle is reported.
SAY_EVERY = 30


class StandstillStream:
    """
    Finds the first standstill; keeps only the samples of the present interval.

    Parameters
    ----------
    limits : AlignmentSettings
    step : TypicalStep of the samples
    first_ns : stamp of the first sample of the record, from which the windows are counted
    check : function of the mean specific force (3,) of an interval that has just become long
        enough; it raises ValueError if a vehicle at rest cannot have that force

    Attributes
    ----------
    samples : the ImuSamples that are kept
    notes : sentences on obstacles; the owner removes them

    """

    def __init__(self, limits, step, first_ns, check):
        self._limits, self._step, self._first_ns = limits, step, first_ns
        self._check = check
        self.samples, self.notes = [], []
        self._base = self._count = self._windows = 0
        self._search = self._index = None

    def push(self, sample):
        """Process a sample; return the Standstill that it completes, or None."""
        if self._search is None:
            self.samples.append(sample)
            if not self._step.known:
                return None
            self._length_ns = window_length_ns(self._limits, self._step.median_ns)
            self._search = StandstillSearch(self._limits, self._length_ns)
            early, self.samples = self.samples, []
            return next(filter(None, [self._put(s) for s in early]), None)
        return self._put(sample)

    def pop(self):
        """Remove the last sample, because another one replaces it; return whether it worked."""
        if self._count < 2:
            return False
        self.samples.pop()
        self._count -= 1
        return True

    @property
    def elapsed_s(self):
        """Return how long the vehicle has been at rest, s."""
        return 0.0 if self._search is None else len(self._search.run) * self._search.length_s

    @property
    def needed_s(self):
        """Return how long it must be at rest, s."""
        return self._limits.shortest_s

    def _put(self, sample):
        index, found = (sample.t_ns - self._first_ns) // self._length_ns, None
        if self._count and index != self._index:
            found = self._close()
        self._index = index
        self.samples.append(sample)
        self._count += 1
        return found

    def _close(self):
        """End the present window; return the Standstill that it completes, or None."""
        samples, step_ns = self.samples, self._step.median_ns
        first, self._count = len(samples) - self._count, 0
        moments = WindowMoments(recorded(samples[first:]), step_ns, self._length_ns)
        window, = moments.each(moments.full & False)
        window = window._replace(first=self._base + first, last=self._base + len(samples))
        under_way = bool(self._search.run)
        run = self._search.take(window)
        self._windows += 1
        if run is not None:
            base = self._base
            run = [w._replace(first=w.first - base, last=w.last - base) for w in run]
            return standstill_of(recorded(samples), run, together_at(step_ns))
        if len(self._search.run) == self._search.needed:
            self._look()
        if under_way and self._search.moved:
            self.notes.append(f'alignment starts again: {self._search.moved}')
            self._search.moved = ''
        elif self._windows % SAY_EVERY == 0 and not self._search.run:
            self.notes.append(f'alignment: {self._search.describe()}; expected a vehicle at rest, '
                              'or other alignment.* limits')
        self._forget_before()
        return None

    def _look(self):
        """Restart the search if the mean force of the interval is impossible at rest."""
        try:
            self._check(np.mean([w.force for w in self._search.run], axis=0))
        except ValueError as error:
            self.notes.append(f'alignment: {error}; the alignment starts again')
            self._search.end()

    def _forget_before(self):
        """Forget the samples before the present interval."""
        samples = self.samples
        kept = self._search.run[0].first if self._search.run else self._base + len(samples)
        del samples[:kept - self._base]
        self._base = kept
