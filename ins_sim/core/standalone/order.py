"""The order of live samples: which are used, dropped or replaced, judged by their stamps."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics.instants import seconds
from .samples import ImuSample, JUMP, TypicalStep

# Number of samples kept while the mounting is not known.
MOST_EARLY = 2000
# Repeats of a stamp before they are reported; in lock-step the first sample is repeated until it
# is answered.
MOST_REPEATS = 1000

NEXT, REPLACE, HOLD, RELEASE, DROP, RESTART = range(6)


class SampleOrder:
    """
    Decides by its stamp what happens to a sample, so that as few as possible are dropped.

    The decisions are:

    - NEXT: the sample follows the last one.
    - REPLACE: it replaces the last one, whose stamp was the same or too late.
    - HOLD: it is far ahead; the next sample shows whether time has leapt or this stamp is wrong.
    - RELEASE: time has leapt; use the held sample and then this one.
    - DROP: drop it.
    - RESTART: time has jumped back for good.
    """

    def __init__(self):
        self._last_ns = self._before_ns = self._held_ns = None
        self._older, self._repeats = [], 0

    def judge(self, t_ns, gap_ns):
        """Return the decision for a stamp; gap_ns: longest step that does not count as a gap."""
        last_ns = self._last_ns
        if last_ns is None:
            self._last_ns = t_ns
            return NEXT
        if self._held_ns is not None and t_ns > last_ns:
            return self._after_held(t_ns, gap_ns)
        if t_ns > last_ns:
            self._older = []
            if t_ns - last_ns > gap_ns:
                self._held_ns = t_ns
                return HOLD
            return self._follows(t_ns)
        if self._before_ns is not None and t_ns > self._before_ns:
            self._last_ns = t_ns
            return REPLACE
        if t_ns == last_ns:
            return DROP
        self._older = [*self._older, t_ns] if self._older and t_ns > self._older[-1] else [t_ns]
        return RESTART if len(self._older) >= JUMP else DROP

    def _follows(self, t_ns):
        self._before_ns, self._last_ns = self._last_ns, t_ns
        return NEXT

    def _after_held(self, t_ns, gap_ns):
        held_ns, self._held_ns = self._held_ns, None
        if t_ns > held_ns:
            self._before_ns, self._last_ns = held_ns, t_ns
            return RELEASE
        # The stamp of the held sample was too late; that sample is not used.
        if t_ns - self._last_ns > gap_ns:
            self._held_ns = t_ns
            return HOLD
        return self._follows(t_ns)

    def describe(self, t_ns):
        """Return the message for the sample just dropped, or ''."""
        if t_ns == self._last_ns:
            self._repeats += 1
            return '' if self._repeats < MOST_REPEATS else (
                f'imu repeats the stamp {seconds(t_ns)} again and again; expected a later '
                'header.stamp with every reading')
        return (f'imu goes back from {seconds(self._last_ns)} to {seconds(t_ns)}; expected rising '
                'stamps; the sample was dropped')


class OrderedSamples:
    """
    Rotates the readings of a live IMU to the vehicle axes and puts them in order.

    Parameters
    ----------
    gaps : GapSettings
    mounting : LiveMounting

    Attributes
    ----------
    step : TypicalStep
    frame_id : name of the frame of the IMU, which the owner sets
    faults : sentences on what was dropped; the owner removes them
    dropped : number of dropped samples
    """

    def __init__(self, gaps, mounting):
        self._gaps, self._mounting = gaps, mounting
        self.frame_id, self.faults, self.dropped = '', [], 0
        self.restart()

    def restart(self):
        """Forget all samples."""
        self.step, self._order = TypicalStep(), SampleOrder()
        self._held, self._early, self._last_ns = None, [], None

    @property
    def gap_ns(self):
        """Return the longest step that does not count as a gap, ns."""
        return self._gaps.factor * self.step.median_ns if self.step.known else math.inf

    def push(self, t_ns, omega, f, tag):
        """
        Process a reading in the axes of the sensor.

        Returns [(kind, ImuSample)] with kind NEXT, HOLD for a sample after a gap, REPLACE for one
        that replaces an earlier one, or RESTART for the first after a jump back.
        """
        if not all(map(math.isfinite, (*omega, *f))):
            self._drop(f'imu at {seconds(t_ns)} holds NaN or infinity; expected finite readings; '
                       'the sample was dropped')
            return []
        q_bs = self._mounting.find(self.frame_id, t_ns)
        if q_bs is None:
            self._early.append(ImuSample(t_ns, omega, f, tag))
            del self._early[:-MOST_EARLY]
            return []
        early, self._early, found = self._early, [], []
        for sample in (*early, ImuSample(t_ns, omega, f, tag)):
            found += self._judged(sample._replace(omega=quaternion.rotate(q_bs, sample.omega),
                                                  f=quaternion.rotate(q_bs, sample.f)))
        return found

    def _drop(self, sentence):
        self.dropped += 1
        self.faults.append(sentence)

    def _judged(self, sample):
        t_ns = sample.t_ns
        fate = self._order.judge(t_ns, self.gap_ns)
        if fate == NEXT:
            return [(NEXT, self._passed(sample))]
        if fate == HOLD:
            self._held = sample
        elif fate == RELEASE:
            held, self._held = self._held, None
            return [(HOLD, self._passed(held)), (NEXT, self._passed(sample))]
        elif fate == REPLACE:
            self._drop(f'imu repeats the stamp {seconds(t_ns)}; expected a later one; the sample '
                       'before was dropped' if t_ns == self._last_ns else
                       f'imu goes back to {seconds(t_ns)} after a stamp that was ahead of its '
                       'time; the sample before was dropped')
            self._last_ns = t_ns
            return [(REPLACE, sample)]
        elif fate == RESTART:
            self.faults.append(f'imu has jumped back to {seconds(t_ns)}; expected rising stamps: '
                               'starting anew')
            self.restart()
            self._order.judge(t_ns, math.inf)
            return [(RESTART, self._passed(sample))]
        elif sentence := self._order.describe(t_ns):
            self._drop(sentence)
        return []

    def _passed(self, sample):
        if self._last_ns is not None:
            self.step.take(sample.t_ns - self._last_ns)
        self._last_ns = sample.t_ns
        return sample
