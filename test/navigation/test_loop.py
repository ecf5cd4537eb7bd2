"""The loop over samples: gaps, faults, and selection of the published outputs."""

from ins_sim.core.navigation.loop import Decimation, NavigationLoop
from ins_sim.core.navigation.recorded import RecordedLoop
from ins_sim.core.streams.faults import StreamFault
import pytest

DT_NS = 10_000_000


class Steps:
    """A navigator whose output is the number of samples processed, from the second one on."""

    def __init__(self):
        self.count = 0

    def step(self, t_ns, *sample):
        """Return the count, or raise the exception given in place of a sample."""
        for fault in sample:
            raise fault
        self.count += 1
        return self.count if self.count > 1 else None

    def bridge_next(self, step_ns):
        """Count a bridged gap as a thousand samples."""
        self.count += 1000


def stamps(*indices):
    """Return samples with stamps k dt."""
    return [(k * DT_NS,) for k in indices]


def test_gap_stops():
    """A gap raises ValueError with the message of the live node."""
    loop = NavigationLoop(Steps, DT_NS, on_fault='stop')
    with pytest.raises(ValueError, match='imu has a gap from 0.020000000 s to 0.050000000 s'):
        list(loop.run(stamps(0, 1, 2, 5)))


def test_gap_starts_anew():
    """After a gap a new navigator processes the next sample, and its outputs are returned."""
    faults = []
    loop = NavigationLoop(Steps, DT_NS, on_fault='reset', faults=faults)
    assert list(loop.run(stamps(0, 1, 2, 5, 6))) == [(1, 2, True), (2, 3, True), (4, 2, True)]
    assert faults is loop.faults and len(faults) == 1 and 'imu has a gap' in faults[0]


def test_blocks_are_one_run():
    """Samples cut into any blocks give the same outputs; a gap between blocks is found too."""
    samples = stamps(0, 1, 2, 3, 7, 8, 9)
    whole = [(o, d) for _, o, d in NavigationLoop(Steps, DT_NS, 2, 'reset').run(samples)]
    for cut in range(len(samples) + 1):
        loop = NavigationLoop(Steps, DT_NS, 2, 'reset')
        parts = [*loop.run(samples[:cut]), *loop.run(samples[cut:])]
        assert [(o, d) for _, o, d in parts] == whole and len(loop.faults) == 1


def test_a_repeated_stamp_is_dropped():
    """A repeated stamp is dropped, as in a live run, without a restart."""
    loop = NavigationLoop(Steps, DT_NS, on_fault='reset')
    assert [o for _, o, _ in loop.run(stamps(0, 1, 1, 2))] == [2, 3]
    assert 'imu repeats the stamp' in loop.faults[0]


def test_jitter_is_no_gap():
    """Jitter of up to a fifth of the period in either direction is accepted; more is a gap."""
    late = DT_NS // 5
    loop = NavigationLoop(Steps, DT_NS, on_fault='reset')
    assert len(list(loop.run([(0,), (DT_NS + late,), (2 * DT_NS,), (3 * DT_NS,)]))) == 3
    list(loop.run([(4 * DT_NS + late + 1,)]))
    assert len(loop.faults) == 1


def test_decimation_counts_periods_from_the_first_output():
    """After a gap the published instants are those of a run without the gap."""
    loop = NavigationLoop(Steps, DT_NS, 3, 'reset')
    samples = stamps(0, 1, 2, 3, 4, 8, 9, 10, 11, 12, 13)
    due = [samples[k][0] // DT_NS for k, _, due in loop.run(samples) if due]
    assert due == [1, 4, 10, 13]


def test_decimation_begins_again_when_time_jumps_back():
    """The first output is published, and so is the first one after a jump to an earlier time."""
    decimation = Decimation(4, DT_NS)
    assert decimation.begins(5 * DT_NS) and decimation.due(5 * DT_NS)
    assert not decimation.begins(6 * DT_NS) and not decimation.due(6 * DT_NS)
    # Stamps with jitter count as those of the nearest period.
    assert decimation.due(9 * DT_NS - DT_NS // 3)
    assert decimation.begins(2 * DT_NS) and decimation.due(6 * DT_NS)


def test_a_fault_of_the_navigator_is_a_fault_of_the_loop():
    """After a fault that requires a restart the sample is passed to a new navigator, once."""
    loop = NavigationLoop(Steps, DT_NS, on_fault='reset')
    bad = StreamFault('diverged', restart=True)
    with pytest.raises(StreamFault, match='diverged'):
        list(loop.run([(0,), (DT_NS,), (2 * DT_NS, bad)]))
    assert loop.faults == ['diverged'] and loop.navigator.count == 0
    with pytest.raises(ValueError, match='diverged'):
        list(NavigationLoop(Steps, DT_NS, on_fault='stop').run([(0, bad)]))


def test_recorded_loop_ends_at_a_gap_or_bridges_it():
    """Steps up to the limit are accepted; a gap is reported with its length and start."""
    samples = stamps(0, 1, 3, 4, 9, 10)
    loop = RecordedLoop(Steps, float(DT_NS), 2.5 * DT_NS, bridges_ns=0)
    assert [k for k, _, _ in loop.run(samples)] == [1, 2, 3]
    assert (loop.gap, loop.bridged) == ('gap of 0.05 s from 0.040000000 s', 0)
    loop = RecordedLoop(Steps, float(DT_NS), 2.5 * DT_NS, bridges_ns=1e12)
    assert [o for _, o, _ in loop.run(samples)] == [2, 3, 4, 1005, 1006]
    assert (loop.gap, loop.bridged) == (None, 1)
