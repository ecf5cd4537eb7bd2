"""Fixes that are late, invalid, missing or from the future: messages, and later solutions."""

from dataclasses import replace
import math

import numpy as np
import pytest

from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, JudgedFix, METER
from ins_sim.core.aiding.live import AidedStream, FixSchedule
from ins_sim.settings.catalogue import build
from ins_sim.core.aiding.filters.base import FixOutcome, refused_fix
from ins_sim.settings.by_node import AIDING
from ins_sim.ros.process.aiding_health import AidingHealth
from support.aided.streams import VALUES, chosen_settings, mixed, push, run_stream, scene

SECOND = 1_000_000_000


def test_a_silent_source_is_named_and_its_late_fixes_change_the_past():
    """Samples wait for a silent source until told to continue; its late fixes still count."""
    chosen, _, streams = scene()
    expected, _, on_time = run_stream(streams, np.random.default_rng(0))
    stream, outputs, faults = AidedStream(chosen.aided_navigator), [], []
    for name in (GNSS, 'push_truth', 'push_imu'):
        for event in streams[name]:
            outputs += push(stream, name, event, faults)
    # The fix of the window that ends at 2 s arrives at 2.13 s.
    assert stream.awaited == [METER] and outputs[-1][0] == 212 * SECOND // 100
    outputs += stream.go_on_without(METER)
    assert outputs[-1][0] == 12 * SECOND and not stream.waiting
    assert outputs[-1] != expected[-1]
    # All fixes arrive late; the next sample processes them at their own instants.
    for _, fix in streams[METER]:
        assert not stream.push_fix(METER, fix)
    t, omega, f = streams['push_imu'][-1]
    _, *pose = streams['push_truth'][-1]
    dt = SECOND // 100
    ends = []
    for other in (stream, on_time):
        other.push_truth(t + dt, *pose)
        ends += other.push_imu(t + dt, omega, f)
    print(f'\nvelocity error {math.hypot(*outputs[-1][2][1]):.4f} m/s without the meter, with it '
          f'{math.hypot(*expected[-1][2][1]):.4f} m/s, apart when late '
          f'{math.dist(ends[0][2][1], ends[1][2][1]):.1e} m/s')
    assert ends[0] == ends[1]
    assert [t.outcome.taken for t in stream.judged if t.source == METER] == [True] * 5


def test_whatever_waits_is_bounded():
    """With a source that never delivers, at most 50 readings wait, and the solution has no gap."""
    _, _, streams = scene()
    stream = AidedStream(scene()[0].aided_navigator, 50)
    outputs, faults = [], []
    for truth, imu in zip(streams['push_truth'], streams['push_imu']):
        outputs += push(stream, 'push_truth', truth, faults)
        outputs += push(stream, 'push_imu', imu, faults)
    faults += map(str, stream.faults)
    assert [t for t, *_ in outputs] == [t for t, *_ in streams['push_imu']][:len(outputs)]
    assert len(outputs) > 1150 and stream.silent == [GNSS, METER]
    assert [fault.partition(';')[0] for fault in faults] == [
        f'no fix of {source} while 50 IMU readings arrived' for source in (GNSS, METER)]


def test_a_bad_fix_is_dropped_and_holds_nothing_up():
    """A fix with another window is rejected with one message, and no sample waits for it."""
    from dataclasses import replace
    chosen, _, streams = scene()
    stream, faults = AidedStream(chosen.aided_navigator), []
    bad = [(METER, replace(fix, cycles=100)) for _, fix in streams[METER]]
    outputs = []
    for name, event in mixed({**streams, METER: bad}, np.random.default_rng(0)):
        outputs += push(stream, name, event, faults)
    assert len(outputs) == 1201 and len(faults) == 6
    assert 'averages 100 cycles in 2 s; expected 200 cycles in 2 s' in faults[0]


@pytest.mark.parametrize('first_ns, t_ns, missing', [
    (0, 0, []), (0, 69_999_999, []), (0, 70_000_000, [GNSS]), (0, 2_130_000_000, [METER, GNSS]),
    # A solution that begins inside a window waits for the next whole window.
    (10_000_000, 1_060_000_000, []), (10_000_000, 1_070_000_000, [GNSS]),
    (10_000_000, 4_120_000_000, [GNSS]), (10_000_000, 4_130_000_000, [METER, GNSS])])
def test_what_is_due(first_ns, t_ns, missing):
    """Due fixes follow from period and latency of both sources, from the first sample on."""
    schedule = FixSchedule(scene()[0].aided_navigator, (METER, GNSS))
    assert schedule.missing(first_ns) == []
    assert schedule.missing(t_ns) == missing


def test_a_fix_from_the_future_is_refused_and_those_of_now_are_not_missed():
    """A fix 997 s ahead is rejected with one message; the valid fixes of the receiver are used."""
    _, _, streams = scene()
    stream, outputs, faults = AidedStream(scene()[0].aided_navigator), [], []
    for name, event in mixed(streams, np.random.default_rng(5)):
        outputs += push(stream, name, event, faults)
        if name == GNSS and event[1].t_ns == 3 * SECOND:
            late = replace(event[1], t_ns=1000 * SECOND, arrival_ns=1000 * SECOND)
            outputs += push(stream, GNSS, (GNSS, late), faults)
    fault, = faults
    assert fault.startswith('gnss: fix at 1000.000000000 s is from the future: the newest IMU')
    assert fault.endswith('expected a fix at most 60 s ahead; it was dropped')
    expected, _, _ = run_stream(streams, np.random.default_rng(5))
    assert outputs == expected


def test_a_fix_beyond_the_gate_is_told_once_and_an_outage_is_not():
    """A gated GNSS fix is reported once in /diagnostics; an outage is only counted."""
    stream = AidedStream(chosen_settings(VALUES).aided_navigator)
    health = AidingHealth(stream)
    gated = FixOutcome((1000.0, 0.0), 250.0, 2, False, 'its innovation is beyond the gate')
    health.count([JudgedFix(GNSS, 7 * SECOND, gated),
                  JudgedFix(GNSS, 8 * SECOND, refused_fix('invalid fix: outage'))])
    wrong, values = health.describe()
    assert wrong == ('gnss: the fix at 7.000000000 s was rejected: its innovation is beyond the '
                     'gate')
    assert (dict(values)['gnss refused'], dict(values)['gnss none']) == (1, 1)
    assert dict(values)['last refusal'] == 'gnss: its innovation is beyond the gate'
    assert health.describe()[0] == ''


def test_a_missing_instrument_stays_wrong_until_it_delivers():
    """A missing sensor is reported while samples wait for it, and then until it delivers."""
    _, _, streams = scene()
    stream = AidedStream(scene()[0].aided_navigator)
    health = AidingHealth(stream)
    for truth in streams['push_truth'][:50]:
        stream.push_truth(*truth)
    for sample in streams['push_imu'][:50]:
        stream.push_imu(*sample)
    # A short wait is normal.
    assert health.describe()[0] == ''
    assert health.describe()[0] == 'waiting for a fix of gnss'
    stream.go_on_without(GNSS)
    told = 'continuing without gnss; expected fixes of every aiding sensor'
    assert health.describe()[0] == health.describe()[0] == told
    stream.push_fix(*streams[GNSS][0])
    assert health.describe()[0] == ''


def test_other_windows_hold_nothing_up():
    """Fixes with another window.cycles are rejected, and no sample waits for further ones."""
    _, _, streams = scene()
    stream, faults = AidedStream(scene()[0].aided_navigator), []
    wrong = [replace(fix, cycles=100, start_ns=fix.end_ns - SECOND) for _, fix in streams[METER]]
    push(stream, METER, (METER, wrong[0]), faults)
    assert 'averages 100 cycles in 1 s; expected 200 cycles in 2 s' in faults[0]
    outputs = []
    for name in ('push_truth', GNSS, 'push_imu'):
        for event in streams[name]:
            outputs += push(stream, name, event, faults)
    assert len(outputs) == len(streams['push_imu']) and len(faults) == 1


@pytest.mark.parametrize('values, sentence', [
    ({'filter': 'paper', 'gain': 1.5}, 'gain is 1.5 with filter paper; expected at most 1'),
    ({'gnss.latency_ms': 20000.0}, 'gnss.latency_ms is 20000 ms; expected at most buffer_s, 10 s'),
    ({'window.latency_ms': 10001.0}, 'window.latency_ms is 10001 ms; expected at most buffer_s')])
def test_settings_that_cannot_aid_are_refused(values, sentence):
    """The navigator refuses invalid combinations of settings with one message each."""
    with pytest.raises(ValueError, match=sentence):
        AidedNavigator(build(AIDING['aided_navigator'], values))
