"""The loop over samples: gap rule, start anew after a fault, and decimation of the outputs."""

from ins_sim.core.streams.faults import check_interval, StreamFault


class Decimation:
    """
    Which outputs are published: every n-th sampling period, counted from the first output.

    every: n; dt_ns: sampling period.  Periods are counted by the stamps, so that a gap does not
    shift the outputs behind it.
    """

    def __init__(self, every, dt_ns):
        self._every, self._dt_ns, self._first_ns = every, dt_ns, None

    def begins(self, t_ns):
        """Return whether a run begins with the output of t_ns: the first, or time jumps back."""
        if self._first_ns is None or t_ns < self._first_ns:
            self._first_ns = t_ns
            return True
        return False

    def due(self, t_ns):
        """Return whether the output of t_ns, of a run that has begun, is published."""
        return (t_ns - self._first_ns + self._dt_ns // 2) // self._dt_ns % self._every == 0


class NavigationLoop:
    """
    Steps a navigator through samples of an IMU.

    Parameters
    ----------
    make_navigator : returns a new navigator, whose step(t_ns, ...) takes a sample and returns an
        output, or None as long as there is no solution
    dt_ns : sampling period
    output_every : as of Decimation
    on_fault : ``stop`` to raise ValueError at a fault, else the navigator starts anew
    faults : list to which a sentence is appended for every fault

    """

    def __init__(self, make_navigator, dt_ns, output_every=1, on_fault='stop', faults=None):
        self._make, self._dt_ns, self._on_fault = make_navigator, dt_ns, on_fault
        self._decimation = Decimation(output_every, dt_ns)
        self.faults = [] if faults is None else faults
        self.navigator, self._last_ns = make_navigator(), None

    def run(self, samples):
        """
        Yield (index, output, due) of each sample at which there is a solution.

        samples: tuples, each the arguments of step; due: whether the output is published. A sample
        that repeats the last stamp is dropped. Samples may come in several calls, as blocks.
        """
        for k, sample in enumerate(samples):
            t_ns = sample[0]
            try:
                if self._last_ns is not None:
                    self.check(t_ns, self._last_ns)
            except StreamFault as fault:
                if not self.recover(fault):
                    return
                if not fault.restart:
                    continue
            self._last_ns = t_ns
            output = self._take(sample)
            if output is not None:
                self._decimation.begins(t_ns)
                yield k, output, self._decimation.due(t_ns)

    def _take(self, sample):
        """Step, again after each fault; a sample at which a new navigator fails too is refused."""
        restarted = False
        while True:
            try:
                return self.step(*sample)
            except StreamFault as fault:
                if restarted and fault.restart:
                    raise
                restarted = restarted or fault.restart
                self.recover(fault)

    def check(self, t_ns, last_ns):
        """Raise StreamFault unless t_ns is the sample that follows last_ns."""
        check_interval('imu', t_ns, last_ns, self._dt_ns)

    def step(self, *sample):
        """Give a sample to the navigator; return its output."""
        return self.navigator.step(*sample)

    def recover(self, fault):
        """Make ready for the sample at a StreamFault; return whether the loop goes on."""
        if self._on_fault == 'stop':
            raise ValueError(str(fault))
        self.faults.append(str(fault))
        if fault.restart:
            self.navigator = self._make()
        return True
