"""The aided navigator offline: IMU readings and fixes of the instruments in blocks."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import partial
from itertools import chain

from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, METER
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.timeseries.histories import AidedErrors, NavStates, Truth
from .aided_loop import AidedBlock, AidedLoop


@dataclass(frozen=True)
class AidedResult:
    """
    One aided run: truth, solution and errors at the output instants.

    Attributes
    ----------
    truth, states, errors : Truth, NavStates and AidedErrors at these instants
    judged : a JudgedFix for every fix, in the order of arrival
    faults : a sentence for each fault
    velocity_fixes, gnss_fixes : the reports of the instruments, if ``simulate_aided`` made them
    notes : results of ``note`` at each output instant, or None
    diverged : whether a solution has diverged

    """

    truth: Truth
    states: NavStates
    errors: AidedErrors
    judged: tuple
    faults: tuple = ()
    velocity_fixes: tuple = ()
    gnss_fixes: tuple = ()
    notes: tuple = ()
    diverged: bool = False


class Reported:
    """Known fixes in the order of their instants; an instrument for ``navigate_aided``."""

    def __init__(self, fixes):
        self._fixes, self._next = fixes, 0

    def advance(self, truth):
        """Return the fixes, not yet returned, up to the last instant of a Truth record."""
        first, self._next = self._next, bisect_right(
            self._fixes, int(truth.t_ns[-1]), lo=self._next, key=lambda fix: fix.t_ns)
        return self._fixes[first:self._next]


def with_truth(motion, blocks):
    """Yield pairs of ImuSamples and the Truth at their stamps."""
    for imu in blocks:
        yield imu, motion.at(imu.t_ns)


def navigate_aided(settings, blocks, meter=None, gnss=None, note=None):
    """
    Return the AidedResult of AidedNavigatorSettings over the blocks of ``with_truth``.

    Faults are handled according to on_fault: the solution starts anew from the truth, or
    ValueError is raised.

    Parameters
    ----------
    settings : AidedNavigatorSettings
    blocks : pairs of ImuSamples and Truth
    meter, gnss : instruments: any objects with advance(Truth) -> list of fixes in the order of
        arrival; or None
    note : function of the AidedNavigator whose result is stored at each output instant

    Raises
    ------
    ValueError : also if there is no output

    """
    flown = AidedChain(settings, note)
    sources = [(source, instrument) for source, instrument in ((METER, meter), (GNSS, gnss))
               if instrument is not None]
    for imu, truth in blocks:
        flown.block(imu, truth, [(fix.arrival_ns, source, fix) for source, instrument in sources
                                 for fix in instrument.advance(truth)])
    return flown.finish()


class AidedChain:
    """
    The aided navigator of one run, which processes block after block.

    settings, note: see ``navigate_aided``; outputs: a Decimation that replaces output_every.
    """

    def __init__(self, settings, note=None, outputs=None):
        self._loop = AidedLoop(partial(AidedNavigator, settings),
                               period_ns(settings.rate_hz), settings.output_every,
                               settings.on_fault)
        self._loop.note = note
        if outputs is not None:
            self._loop.decimation = outputs
        self._parts, self._judged = [], []

    def block(self, imu, truth, fixes):
        """Step through a block; fixes: (arrival_ns, source, fix)."""
        # A fix from an earlier block may arrive after one of this block.
        self._loop.waiting = sorted([*self._loop.waiting, *fixes], key=lambda entry: entry[:2])
        block = AidedBlock(imu, truth, self._loop)
        self._judged += self._loop.run_block(block)
        found = block.records()
        if found:
            self._parts.append(found)

    def finish(self):
        """Return the AidedResult."""
        if not self._parts:
            raise ValueError('the run has no navigation output; expected duration_s longer than '
                             'initial.after_s')
        *records, notes = zip(*self._parts)
        truth, states, errors = (cls.concatenate(parts) for cls, parts in zip(
            (Truth, NavStates, AidedErrors), records))
        return AidedResult(truth, states, errors, tuple(self._judged), tuple(self._loop.faults),
                           notes=tuple(chain.from_iterable(notes)), diverged=self._loop.diverged)
