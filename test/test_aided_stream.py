"""The aided navigator on streams: the order in which things come changes nothing."""

from dataclasses import replace
from functools import lru_cache
import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest

from ins_sim.core.aiding.navigator import AidedNavigator, GNSS, JudgedFix, METER
from ins_sim.core.simulation.aided_run import with_truth
from ins_sim.core.simulation.aided import make_instruments, simulate_aided
from ins_sim.settings.simulation import AidedSimulationSettings
from ins_sim.core.aiding.live import AidedStream, FixSchedule
from ins_sim.settings.catalogue import build, flatten
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.aiding.filters.base import FixOutcome, refused
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.motion.factory import make_motion
from ins_sim.settings.by_node import AIDING
from ins_sim.settings.by_node import NODES
from ins_sim.core.simulation.inertial import simulate
from ins_sim.ros.process.aiding_health import AidingHealth
from studies import settings as simulation_settings

SECOND = 1_000_000_000
VALUES = {'source': 'motion', 'motion.kind': 'route', 'duration_s': 12.0, 'window.cycles': 200,
          'window.latency_ms': 130.0, 'gnss.latency_ms': 70.0, 'gnss_model.use': True,
          'seed': 2, 'datum.latitude_deg': 55.0, 'datum.longitude_deg': 37.0,
          'outages.start_s': (4.5,), 'outages.end_s': (6.5,), 'accelerometer.errors.bias_ug':
          (100.0, 50.0, 0.0)}


def chosen_settings(values):
    """Return AidedSimulationSettings of {dotted name: value}."""
    known = {name: set(flatten(cls)) for name, cls in AIDING.items()}
    simulated = set().union(*(flatten(cls) for cls in NODES.values()))
    return AidedSimulationSettings(
        simulation_settings({k: v for k, v in values.items() if k in simulated}),
        **{name: build(cls, {k: v for k, v in values.items() if k in known[name]})
           for name, cls in AIDING.items()})


@lru_cache(maxsize=None)
def scene():
    """
    Return (AidedSimulationSettings, AidedResult offline, events by stream) of a short flight.
    """
    chosen = chosen_settings(VALUES)
    simulation = chosen.simulation
    generator = simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    run = simulate(simulation, twin=False, motion=motion)
    offline = simulate_aided(chosen, make_instruments(chosen), motion, run)
    meter, gnss = make_instruments(chosen)
    meter.follow_ins(run.states.t_ns, body_velocity(run.states))
    truth = [t for _, t in with_truth(motion, [run.imu])][0]
    frame = MapFrame(generator.datum, True)
    poses = frame.pose(truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)
    streams = {
        'push_imu': [(t, tuple(w), tuple(f)) for t, w, f in zip(
            run.imu.t_ns.tolist(), run.imu.omega.tolist(), run.imu.f.tolist())],
        'push_truth': [(t, *map(tuple, pose)) for t, pose in zip(truth.t_ns.tolist(), zip(
            *(p.tolist() for p in poses)))],
        METER: [(METER, fix) for fix in meter.fixes(truth)],
        GNSS: [(GNSS, fix) for fix in gnss.fixes(truth)]}
    return chosen, offline, streams


def push(stream, name, event, faults):
    """Push as a node does; return the outputs."""
    method = getattr(stream, name if name.startswith('push') else 'push_fix')
    for _ in range(2):
        try:
            return method(*event)
        except StreamFault as fault:
            faults.append(str(fault))
            if not fault.restart:
                return stream.match()
            stream.reset()
    raise AssertionError('twice the same fault')


def mixed(streams, rng):
    """Yield (name, event) of streams in a random order that keeps the order of each."""
    order = [name for name, events in streams.items() for _ in events]
    rng.shuffle(order)
    places = dict.fromkeys(streams, 0)
    for name in order:
        yield name, streams[name][places[name]]
        places[name] += 1


def run_stream(streams, rng):
    """Return outputs, faults and the stream after events in random order."""
    stream, outputs, faults = AidedStream(scene()[0].aided_navigator), [], []
    for name, event in mixed(streams, rng):
        outputs += push(stream, name, event, faults)
    return outputs, faults + [str(fault) for fault in stream.faults], stream


def test_the_stream_is_the_offline_run():
    """
    Solution and errors to the rounding of the truth, which passes through the map.

    As in test_live_graph: a place is 1e-9 m in a double, a few of which add up; an attitude
    rounds at 1e-15.
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
    """IMU, truth and fixes may overtake each other by any amount."""
    _, _, streams = scene()
    first, _, _ = run_stream(streams, np.random.default_rng(0))
    again, faults, _ = run_stream(streams, np.random.default_rng(seed))
    assert not faults and again == first


@settings(max_examples=4, deadline=None)
@given(seed=st.integers(0, 2**32))
def test_after_a_gap_of_the_imu_alone_any_order_gives_the_same_bits(seed):
    """What waits when the gap comes has its turn; fixes that came before are known behind it."""
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
    """The second run is the first one again, fixes of the new run coming before or after."""
    _, _, streams = scene()
    expected, _, _ = run_stream(streams, np.random.default_rng(0))
    for names in ((METER, GNSS, 'push_truth', 'push_imu'),
                  ('push_truth', 'push_imu', GNSS, METER)):
        stream, faults = AidedStream(scene()[0].aided_navigator), []
        for name, event in mixed(streams, np.random.default_rng(1)):
            push(stream, name, event, faults)
        assert not faults
        outputs = []
        # the first event of each stream in this order, then the rest at random
        for name in names:
            outputs += push(stream, name, streams[name][0], faults)
        rest = {name: events[1:] for name, events in streams.items()}
        for name, event in mixed(rest, np.random.default_rng(2)):
            outputs += push(stream, name, event, faults)
        assert faults == ['imu jumps back from 12.000000000 s to 0.000000000 s; expected rising '
                          'stamps']
        assert outputs == expected


def test_fixes_of_the_run_before_are_passed_over():
    """They come when the samples have jumped back already, and none is taken for the new run's."""
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


def test_a_silent_source_is_named_and_its_late_fixes_change_the_past():
    """Without its fixes samples wait; told to go on, they go; a late fix still counts."""
    chosen, _, streams = scene()
    expected, _, on_time = run_stream(streams, np.random.default_rng(0))
    stream, outputs, faults = AidedStream(chosen.aided_navigator), [], []
    for name in (GNSS, 'push_truth', 'push_imu'):
        for event in streams[name]:
            outputs += push(stream, name, event, faults)
    # the window that ends at 2 s is there at 2.13 s
    assert stream.awaited == [METER] and outputs[-1][0] == 212 * SECOND // 100
    outputs += stream.go_on_without(METER)
    assert outputs[-1][0] == 12 * SECOND and not stream.waiting
    assert outputs[-1] != expected[-1]
    # all of them late; another sample takes them where they belong
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


def test_a_bad_fix_is_dropped_and_holds_nothing_up():
    """A window of another length is refused in a sentence; the samples go on without it."""
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
    # one that begins inside a window waits for the next whole one
    (10_000_000, 1_060_000_000, []), (10_000_000, 1_070_000_000, [GNSS]),
    (10_000_000, 4_120_000_000, [GNSS]), (10_000_000, 4_130_000_000, [METER, GNSS])])
def test_what_is_due(first_ns, t_ns, missing):
    """By period and latency of both, from the first sample on."""
    schedule = FixSchedule(scene()[0].aided_navigator, (METER, GNSS))
    assert schedule.missing(first_ns) == []
    assert schedule.missing(t_ns) == missing


def test_a_fix_from_the_future_is_refused_and_those_of_now_are_not_missed():
    """A receiver with another epoch: one sentence, and its later fixes count."""
    _, _, streams = scene()
    stream, outputs, faults = AidedStream(scene()[0].aided_navigator), [], []
    for name, event in mixed(streams, np.random.default_rng(5)):
        outputs += push(stream, name, event, faults)
        if name == GNSS and event[1].t_ns == 3 * SECOND:
            late = replace(event[1], t_ns=1000 * SECOND, arrival_ns=1000 * SECOND)
            outputs += push(stream, GNSS, (GNSS, late), faults)
    fault, = faults
    assert fault.startswith('gnss: fix at 1000.000000000 s is from the future, the newest IMU')
    assert fault.endswith('expected a fix at most 60 s ahead; it was dropped')
    expected, _, _ = run_stream(streams, np.random.default_rng(5))
    assert outputs == expected


def test_a_fix_beyond_the_gate_is_told_once_and_an_outage_is_not():
    """/diagnostics: a GNSS jump is a warning with its instant, an outage only a count."""
    stream = AidedStream(chosen_settings(VALUES).aided_navigator)
    health = AidingHealth(stream)
    gated = FixOutcome((1000.0, 0.0), 250.0, 2, False, 'its innovation is beyond the gate')
    health.count([JudgedFix(GNSS, 7 * SECOND, gated),
                  JudgedFix(GNSS, 8 * SECOND, refused('the fix is none: outage'))])
    wrong, values = health.describe()
    assert wrong == ('gnss: the fix at 7.000000000 s is not taken: its innovation is beyond the '
                     'gate')
    assert (dict(values)['gnss refused'], dict(values)['gnss none']) == (1, 1)
    assert dict(values)['last refusal'] == 'gnss: its innovation is beyond the gate'
    assert health.describe()[0] == ''


def test_a_missing_instrument_stays_wrong_until_it_delivers():
    """While the first sample waits, and while it is gone on without."""
    _, _, streams = scene()
    stream = AidedStream(scene()[0].aided_navigator)
    health = AidingHealth(stream)
    for truth in streams['push_truth'][:50]:
        stream.push_truth(*truth)
    for sample in streams['push_imu'][:50]:
        stream.push_imu(*sample)
    # a moment is in order
    assert health.describe()[0] == ''
    assert health.describe()[0] == 'waiting for a fix of gnss'
    stream.go_on_without(GNSS)
    told = 'going on without gnss; expected the fixes of all that aid'
    assert health.describe()[0] == health.describe()[0] == told
    stream.push_fix(*streams[GNSS][0])
    assert health.describe()[0] == ''


def test_other_windows_hold_nothing_up():
    """A meter with another window.cycles: refused, and none of ours is waited for."""
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
    """One sentence each, at construction."""
    with pytest.raises(ValueError, match=sentence):
        AidedNavigator(build(AIDING['aided_navigator'], values))
