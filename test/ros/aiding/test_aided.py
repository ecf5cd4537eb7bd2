"""The aided chain over DDS: six processes give the numbers of the offline run."""

from dataclasses import replace
import subprocess
import sys

from ins_sim.bags.bag_reader import open_bag
from ins_sim.core.aiding.reading_noise import rate_variance
from ins_sim.core.simulation.aided import make_instruments, simulate_aided
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.earth.great_circle import GreatCircleRoute
from ins_sim.core.simulation.inertial import simulate
from ins_sim.messages import topics, velocity_record
from ins_sim.messages.convert import aided_fix_one, aided_odometry_one
from support.live import Chain, Listener, warnings_of_loss
import numpy as np
import pytest
from support.stream import DT, offline_fixes, SECOND, Stream
from support.aided.streams import chosen_settings, VALUES

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

NODES = ('aided_navigator', 'velocity_meter', 'gnss', 'strapdown', 'imu_sensor',
         'motion_generator')
LIVE = {**{k: list(v) if isinstance(v, tuple) else v for k, v in VALUES.items()},
        'source': 'stream'}
HEARD = (topics.AIDED_ODOMETRY, topics.AIDED_FIX, *topics.AIDED_ERRORS, *topics.AIDED_SIGMAS,
         topics.AIDED_ORTHODROME)
REQUIRED = '[strapdown, velocity_meter, gnss, aided_navigator, listener]'


def lock_step(domain, folder, order, load=0, reset_ns=None):
    """
    Run six processes; return {topic: {stamp: doubles}}.

    reset_ns: instant at which the generator is reset to sample 0.
    """
    folder.mkdir()
    listener, chain = Listener(domain, HEARD), Chain(domain, folder)
    hogs = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(load)]
    try:
        started = {node: chain.start(node, {**LIVE, 'pacing.real_time_factor': 0.0,
                                            'pacing.required': REQUIRED}) for node in order}
        generator = started['motion_generator']
        if reset_ns is not None:
            listener.poll_until(lambda: reset_ns in listener.heard['aided/fix'])
            from std_srvs.srv import Trigger
            listener.call(Trigger, 'motion_generator/reset')
            chain.wait_text(started['aided_navigator'], 'imu jumps back from')
            for heard in listener.heard.values():
                heard.clear()
        listener.poll_until(lambda: generator.poll() is not None, 120.0)
        listener.poll_until(lambda: all(12 * SECOND in h for h in listener.heard.values()))
        texts = [chain.text(process) for process in started.values()]
        assert set(chain.end().values()) == {0}, texts
        warnings = warnings_of_loss(texts)
        assert all('jumps back' in line for line in warnings), warnings
        assert len(warnings) == (0 if reset_ns is None else 5)
    finally:
        for hog in hogs:
            hog.kill()
        chain.end()
        listener.close()
    return listener.heard


def test_lock_step_is_the_offline_run(ros_domain, tmp_path):
    """
    Every topic agrees with the offline run to the rounding of Cartesian messages.

    The bounds are those of test_graph. The bits are the same with the nodes in another order on a
    busy machine, and once more when the generator is reset to sample 0 in between.
    """
    heard = lock_step(ros_domain, tmp_path / 'first', NODES)
    settings = chosen_settings({**VALUES, 'source': 'stream'})
    generator = settings.simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    offline = simulate_aided(settings, make_instruments(settings), motion,
                             simulate(settings.simulation, motion, twin=False))
    states, errors = offline.states, offline.errors
    frame = MapFrame(generator.datum, True)
    route = GreatCircleRoute.of_points(settings.aided_navigator.motion.route.points)
    expected = {topic.name: [] for topic in HEARD}
    for k, solution in enumerate(zip(states.lat.tolist(), states.lon.tolist(),
                                     states.height.tolist(), states.v_n.tolist(),
                                     states.q_nb.tolist())):
        sigmas = [s[k] for s in (errors.position_sigma, errors.velocity_sigma,
                                 errors.attitude_sigma)]
        odometry = aided_odometry_one(frame, solution, (0.0, 0.0, 0.0), sigmas,
                                      rate_variance(settings.aided_navigator))
        x, z = route.to_xz(*solution[:2], 0)
        rows = (np.concatenate(odometry), np.concatenate(aided_fix_one(solution, sigmas)),
                errors.attitude[k], errors.velocity[k], errors.position[k],
                *(3.0 * s for s in sigmas[::-1]), (x, solution[2], z))
        for topic, row in zip(HEARD, rows):
            expected[topic.name].append(row)
    most = {'aided/error/attitude': 1e-14, 'aided/error/velocity': 1e-11,
            **{t.name: 1e-12 for t in topics.AIDED_SIGMAS}}
    for name, rows in expected.items():
        got = np.array([heard[name][t] for t in states.t_ns.tolist()])
        assert len(heard[name]) == len(states)
        difference = np.abs(got - np.array(rows))
        if name == 'aided/odometry':
            # The angular rate is that measured by the gyros, converted to a rate relative to the
            # Earth.
            assert np.abs(got[:, 46:49]).max() > 1e-6
            difference[:, 46:49] = 0.0
        bound = most.get(name, 8e-9)
        print(f'{name}: {difference.max():.1e} ({bound:.0e})')
        assert difference.max() < bound
    assert [t.outcome.taken for t in offline.judged if t.source == 'velocity_meter'] == [True] * 5
    assert lock_step(ros_domain, tmp_path / 'again', NODES[::-1], load=2) == heard
    again = lock_step(ros_domain, tmp_path / 'reset', NODES, reset_ns=5 * SECOND)
    assert {name: dict(sorted(h.items())) for name, h in again.items()} == heard


ALONE = (topics.TRUTH_ODOMETRY, topics.IMU_RAW, topics.METER_RECORD)
HAND = {'window.cycles': 100, 'initial.velocity_sigma_m_s': 0.0, 'gate_probability': 0.0}


def send_both(stream, first, stop):
    """Publish readings first to stop - 1, which wait for the truth, and then the truth."""
    stamps = np.arange(first, stop) * DT
    stream.send(stamps, topics.IMU_RAW)
    stream.send(stamps)


def test_a_silent_meter_is_named_and_its_late_record_counts(ros_domain, tmp_path):
    """After 5 s without the meter the navigator continues; late records still count."""
    stream = Stream(ros_domain, tmp_path, (topics.AIDED_ERRORS[1],),
                    {'motion.kind': 'racetrack'}, ALONE)
    values = {'window.cycles': 100, 'limits.height_max_m': 2e4}
    try:
        node = stream.chain.start('aided_navigator', HAND)
        stream.begin(node)
        send_both(stream, 1, 151)
        stream.wait_ack(99 * DT)
        errors = stream.heard['aided/error/velocity']
        stream.listener.poll_until(lambda: 99 * DT in errors)
        stream.chain.wait_text(node, 'no fix of velocity_meter in 5 s; expected one for every '
                                     'window; continuing without this sensor until its fixes '
                                     'arrive again')
        stream.wait_ack(150 * DT)
        stream.listener.poll_until(lambda: 150 * DT in errors)
        stream.wait_diagnosis('continuing without velocity_meter')
        fixes = offline_fixes(stream, np.arange(0, 301) * DT, values)
        # The velocity of the record is wrong by 5 m/s, so that its use is visible.
        late = replace(fixes[0], velocity=(fixes[0].velocity[0] - 5.0, fixes[0].velocity[1]))
        stream.send_bytes(topics.METER_RECORD, velocity_record.pack_fix(late, 0))
        send_both(stream, 151, 231)
        # Now it waits for the window of 2 s.
        stream.wait_ack(199 * DT)
        stream.listener.poll_until(lambda: 199 * DT in errors)
        assert 200 * DT not in errors
        before, after = errors[150 * DT], errors[199 * DT]
        print(f'\nvelocity error {np.linalg.norm(before):.4f} m/s, with the late fix '
              f'{np.linalg.norm(after):.4f} m/s')
        assert np.linalg.norm(np.subtract(after, before)) > 1e-3
        # A record of another window is refused with a message and delays nothing.
        stream.send_bytes(topics.METER_RECORD, velocity_record.pack_fix(
            replace(fixes[1], cycles=50), 0))
        stream.chain.wait_text(node, 'averages 50 cycles in 1 s; expected 100 cycles in 1 s')
        stream.wait_ack(230 * DT, 4.0)
        stream.send_bytes(topics.METER_RECORD, b'\x00\x01\x00\x00')
        send_both(stream, 231, 241)
        stream.chain.wait_text(node, 'DiagnosticArray')
    finally:
        assert set(stream.close().values()) == {0}


@pytest.mark.parametrize('values, sentence', [
    ({'filters': 'eskf'}, "the nearest known one is 'filter'"),
    ({'filter': 'ekf'}, 'nearest: eskf'),
    ({'filter': 'paper', 'gnss_model.use': True}, 'expected a filter that processes GNSS: eskf'),
])
def test_a_bad_parameter_is_one_sentence_and_code_2(values, sentence, ros_domain, tmp_path):
    """An invalid parameter of aided_navigator gives one message and exit code 2."""
    chain = Chain(ros_domain, tmp_path)
    process = chain.start('aided_navigator', values)
    assert process.wait(60.0) == 2
    text = chain.text(process)
    assert sentence in text and text.count('\n') == 1


def test_a_recorder_keeps_all_of_a_filter_without_a_covariance(ros_domain, tmp_path):
    """
    A recorder has every topic completely, although meter, GNSS and sigmas are silent at first.

    The records are the offline fixes to the rounding of the truth; aided/fix states that its
    covariance is unknown, and aided/sigma/* is silent.
    """
    values = {**VALUES, 'duration_s': 6.0, 'filter': 'paper_corrected', 'gnss_model.use': False}
    live_values = {**LIVE, **values, 'source': 'stream', 'outages.start_s': [4.5],
                   'outages.end_s': [6.5], 'pacing.real_time_factor': 0.0,
                   'accelerometer.errors.bias_ug': [100.0, 50.0, 0.0],
                   'pacing.required': REQUIRED.replace('listener', 'recorder')}
    names = [t.name for t in (topics.TRUTH_ODOMETRY, *topics.AIDING)]
    chain = Chain(ros_domain, tmp_path)
    try:
        recorder = chain.start('recorder', {'storage.path': tmp_path / 'bag', 'record.topics':
                                            f'[{", ".join(names)}]'})
        started = [chain.start(node, live_values) for node in NODES]
        assert started[-1].wait(60.0) == 0, [chain.text(p) for p in (recorder, *started)]
        assert set(chain.end().values()) == {0}
    finally:
        chain.end()
    settings = chosen_settings({**values, 'source': 'stream'})
    generator = settings.simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    run = simulate(settings.simulation, twin=False, motion=motion)
    meter, _ = make_instruments(settings)
    meter.follow_ins(run.states.t_ns, body_velocity(run.states))
    with open_bag(tmp_path / 'bag') as bag:
        counts = {n.lstrip('/'): span.count for n, span in bag.spans().items()}
        logged, records = zip(*[(log_ns, velocity_record.read_fix(bytes(data), 0))
                                for n, log_ns, data in bag.messages()
                                if n == '/velocity_meter/record'])
        fix, aided = bag.arrays('gnss/fix'), bag.arrays('aided/fix')
    dense = [t.name for t in topics.AIDING if t not in topics.SELDOM]
    assert {name: counts[name] for name in dense} == dict.fromkeys(dense, 601)
    # GNSS fixes of 0 to 5 s, because that of 6 s is late; the same for the window of 6 s.
    assert counts['gnss/fix'] == 6 and counts['gnss/velocity'] == 5
    assert fix['status'].tolist() == [0, 0, 0, 0, 0, -1]
    assert not any(counts[t.name] for t in topics.AIDED_SIGMAS)
    assert set(aided['position_covariance_type'].tolist()) == {0}
    expected = meter.advance(motion.at(run.imu.t_ns))[:2]
    assert [r.end_ns for r in records] == [2 * SECOND, 4 * SECOND] == list(logged)
    off = np.abs(np.subtract([r.velocity for r in records], [f.velocity for f in expected])).max()
    print(f'\nrecords and offline fixes are {off:.1e} m/s apart')
    assert off < 1e-10
