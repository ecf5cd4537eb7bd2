"""The loop over samples: check for gaps, restart after a fault, decimate the outputs."""

import numpy as np

from ins_sim.core.streams.faults import check_interval, is_regular, StreamFault


class Decimation:
    """
    Selects the published outputs: every n-th sampling period, counted from the first output.

    Periods are counted by the stamps, so that a gap does not shift the outputs after it.

    Parameters
    ----------
    every : n, number of sampling periods from one published output to the next
    dt_ns : sampling period, ns

    Attributes
    ----------
    first_ns : instant of the first output, ns, or None before it

    """

    def __init__(self, every, dt_ns):
        self._every, self._dt_ns, self.first_ns = every, dt_ns, None

    def begins(self, t_ns):
        """Return whether the output of t_ns begins a run: it is the first, or time jumped back."""
        if self.first_ns is None or t_ns < self.first_ns:
            self.first_ns = t_ns
            return True
        return False

    def due(self, t_ns):
        """Return whether the output of t_ns, in a run that has begun, is published."""
        return (t_ns - self.first_ns + self._dt_ns // 2) // self._dt_ns % self._every == 0

    def due_rows(self, t_ns):
        """Return the index of the published rows among outputs: a slice or an integer array."""
        return slice(None) if self._every == 1 else np.flatnonzero(self.due(t_ns))


class WantedInstants(Decimation):
    """
    Selects the published outputs: the first one at or after each of the given instants.

    wanted_ns (m,): the instants, ascending; dt_ns: sampling period.  An instant whose sample is
    lost has no output.
    """

    def __init__(self, wanted_ns, dt_ns):
        super().__init__(1, dt_ns)
        self._wanted_ns = wanted_ns

    def due(self, t_ns):
        """Return whether the output of t_ns is published."""
        return (np.searchsorted(self._wanted_ns, t_ns, side='right')
                > np.searchsorted(self._wanted_ns, t_ns - self._dt_ns, side='right'))

    def numbers(self, t_ns):
        """Return, for published outputs at t_ns (n,), the index of the instant of each."""
        return np.searchsorted(self._wanted_ns, t_ns - self._dt_ns, side='right')


class NavigationLoop:
    """
    Steps a navigator through the samples of an IMU.

    Parameters
    ----------
    make_navigator : function that returns a new navigator, whose step(t_ns, ...) processes a
        sample and returns an output, or None as long as there is no solution
    dt_ns : sampling period
    output_every : decimation of the outputs, see Decimation
    on_fault : ``stop`` to raise ValueError at a fault; otherwise the navigator starts anew
    faults : list to which a sentence is appended for every fault

    """

    def __init__(self, make_navigator, dt_ns, output_every=1, on_fault='stop', faults=None):
        self._make, self.dt_ns, self._on_fault = make_navigator, dt_ns, on_fault
        self.decimation = Decimation(output_every, dt_ns)
        self.faults = [] if faults is None else faults
        self.navigator, self._last_ns = make_navigator(), None

    def run(self, samples):
        """
        Yield (index, output, due) for each sample at which there is a solution.

        samples: tuples of the arguments of ``step``; due: whether the output is published. A
        sample that repeats the last stamp is dropped. Several calls continue one run, so that
        samples may come in blocks.
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
                self.decimation.begins(t_ns)
                yield k, output, self.decimation.due(t_ns)

    def run_block(self, t_ns, *columns):
        """
        Yield (first, output, due) for each stretch without a fault; the same bits as ``run``.

        The navigator's ``advance`` processes a whole stretch and returns its outputs; they belong
        to the last samples of the stretch if the solution began within it.

        Parameters
        ----------
        t_ns : (n,) stamps, ns
        columns : the other arguments of ``advance``, each with n rows

        Yields
        ------
        first : index of the first output among the n samples
        output : what ``advance`` returned
        due : rows of the output that are published, see ``Decimation.due_rows``; they are counted
            from first

        """
        regular = np.ones(len(t_ns), dtype=bool)
        regular[1:] = is_regular(np.diff(t_ns), self.dt_ns)
        if self._last_ns is not None and len(t_ns):
            regular[0] = is_regular(t_ns[0] - self._last_ns, self.dt_ns)
        start = 0
        for stop in (*np.flatnonzero(~regular).tolist(), len(t_ns)):
            if stop > start:
                part = slice(start, stop)
                output = self.navigator.advance(t_ns[part], *(c[part] for c in columns))
                self._last_ns = int(t_ns[stop - 1])
                if len(output[0]):
                    stamps = output[0].t_ns
                    self.decimation.begins(int(stamps[0]))
                    yield stop - len(stamps), output, self.decimation.due_rows(stamps)
            start = stop
            if stop < len(t_ns) and not self._passes(int(t_ns[stop])):
                start = stop + 1

    def _passes(self, t_ns):
        """Handle the fault of a sample; return whether a new navigator processes the sample."""
        try:
            self.check(t_ns, self._last_ns)
        except StreamFault as fault:
            self.recover(fault)
            return fault.restart
        return True

    def _take(self, sample):
        """Step; retry with a new navigator after a fault; drop the sample if that fails too."""
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
        """Raise StreamFault unless t_ns is the next sample after last_ns."""
        check_interval('imu', t_ns, last_ns, self.dt_ns)

    def step(self, *sample):
        """Pass a sample to the navigator; return its output."""
        return self.navigator.step(*sample)

    def recover(self, fault):
        """Prepare for the sample at a StreamFault; return whether the loop continues."""
        if self._on_fault == 'stop':
            raise ValueError(str(fault))
        self.faults.append(str(fault))
        if fault.restart:
            self.navigator = self._make()
        return True
