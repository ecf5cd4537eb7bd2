"""The aided navigator on live streams: the order of arrival changes nothing."""

from hypothesis import given, settings, strategies as st
import numpy as np

from ins_sim.core.aiding.navigator import GNSS, METER
from ins_sim.core.aiding.live import AidedStream
from support.aided.streams import mixed, push, run_stream, scene

SECOND = 1_000_000_000


def test_the_stream_is_the_offline_run():
    """
    A live run equals the offline run within the rounding of the truth.

    The truth passes through the map frame: as in test_live_graph a position has 1e-9 m in its last
    digit, a few of which add up; an attitude is rounded at 1e-15.
    """
    _, offline, streams = scene()
    outputs, faults, stream = run_stream(streams, np.random.default_rng(0))
    assert not faults and [o[0] for o in outputs] == offline.states.t_ns.tolist()
    off = np.abs(np.array([o[2] for o in outputs]) - np.stack(
        [offline.errors.attitude, offline.errors.velocity, offline.errors.position],
        axis=1)).max(axis=(0, 2))
    sigma = np.array([o[3] for o in outputs])
    ratio = np.abs(sigma[:, 0] / offline.errors.position_sigma - 1.0).max()
    print(f'\nattitude {off[0]:.1e} rad, velocity {off[1]:.1e} m/s, position {off[2]:.1e} m, '
          f'sigma of the position {ratio:.1e} of it')
    assert off[2] < 8e-9 and off[1] < 1e-11 and off[0] < 1e-14 and ratio < 1e-12
    assert [(t.source, t.t_ns, t.outcome.taken) for t in stream.judged] == [
        (t.source, t.t_ns, t.outcome.taken) for t in offline.judged]
    assert sum(t.outcome.taken for t in stream.judged) == 5 + 10


@settings(max_examples=6, deadline=None)
@given(seed=st.integers(0, 2**32))
def test_any_order_gives_the_same_bits(seed):
    """IMU, truth and fixes may overtake each other arbitrarily: the solution has the same bits."""
    _, _, streams = scene()
    first, _, _ = run_stream(streams, np.random.default_rng(0))
    again, faults, _ = run_stream(streams, np.random.default_rng(seed))
    assert not faults and again == first


@settings(max_examples=4, deadline=None)
@given(seed=st.integers(0, 2**32))
def test_after_a_gap_of_the_imu_alone_any_order_gives_the_same_bits(seed):
    """
    After an IMU gap any order of arrival gives the same bits.

    Samples that wait at the gap are processed first, and earlier fixes remain known after it.
    """
    _, _, streams = scene()
    streams = {**streams, 'push_imu': [e for e in streams['push_imu']
                                       if not 5.2 < e[0] / SECOND < 5.6]}
    first, _, _ = run_stream(streams, np.random.default_rng(0))
    again, faults, stream = run_stream(streams, np.random.default_rng(seed))
    gaps = [f for f in faults if 'gap' in f]
    assert gaps == ['imu has a gap from 5.200000000 s to 5.600000000 s; expected steps of 0.01 s']
    assert again == first and not stream.waiting
    assert [o[0] for o in again] == [e[0] for e in streams['push_imu']]


def test_a_jump_back_begins_anew_whoever_jumps_first():
    """After a jump back the second run equals the first, whichever stream jumps back first."""
    _, _, streams = scene()
    expected, _, _ = run_stream(streams, np.random.default_rng(0))
    for names in ((METER, GNSS, 'push_truth', 'push_imu'),
                  ('push_truth', 'push_imu', GNSS, METER)):
        stream, faults = AidedStream(scene()[0].aided_navigator), []
        for name, event in mixed(streams, np.random.default_rng(1)):
            push(stream, name, event, faults)
        assert not faults
        outputs = []
        # The first events come in this order of streams, the others at random.
        for name in names:
            outputs += push(stream, name, streams[name][0], faults)
        rest = {name: events[1:] for name, events in streams.items()}
        for name, event in mixed(rest, np.random.default_rng(2)):
            outputs += push(stream, name, event, faults)
        assert faults == ['imu jumps back from 12.000000000 s to 0.000000000 s; expected rising '
                          'stamps']
        assert outputs == expected


def test_fixes_of_the_run_before_are_passed_over():
    """Fixes of the old run that arrive after the stamps of the samples jumped back are ignored."""
    _, _, streams = scene()
    expected, _, _ = run_stream(streams, np.random.default_rng(0))
    late = {METER: 1, GNSS: 2}
    stream, faults = AidedStream(scene()[0].aided_navigator), []
    for name, event in mixed({name: events[:len(events) - late.get(name, 0)]
                              for name, events in streams.items()}, np.random.default_rng(1)):
        push(stream, name, event, faults)
    outputs = []
    for name in ('push_imu', 'push_truth'):
        outputs += push(stream, name, streams[name][0], faults)
    for name, count in late.items():
        for event in streams[name][-count:]:
            assert push(stream, name, event, faults) == []
    rest = {name: events if name in late else events[1:] for name, events in streams.items()}
    for name, event in mixed(rest, np.random.default_rng(2)):
        outputs += push(stream, name, event, faults)
    assert [fault.split(';')[0] for fault in faults] == [
        'imu jumps back from 12.000000000 s to 0.000000000 s']
    assert outputs == expected
