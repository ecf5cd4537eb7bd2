"""A bag is played byte for byte, by its log times or in lock-step with the nodes."""

import re
import signal

from ins_sim import graph
from ins_sim.bags import qos as bag_qos
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.messages import topics
from support.live import Chain, Listener, warnings_of_loss
import numpy as np
import pytest
from support.nodes.talker import Talker

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

SECOND = 1_000_000_000
PARAMETERS = {'rate_hz': 100.0, 'duration_s': 5.0, 'gyro.delay_us.y': 1.0}
LOCK_STEP = {'pacing.real_time_factor': 0.0, 'pacing.required': '[strapdown, recorder]'}
OUTPUTS = [topic.name for topic in (topics.INS_ODOMETRY, topics.INS_FIX, *topics.ERRORS)]
FROM_IMU = ('truth/odometry', 'imu/data_raw')


@pytest.fixture
def chain(ros_domain, tmp_path):
    chain = Chain(ros_domain, tmp_path)
    yield chain
    chain.end()


def end(chain, *processes):
    """Interrupt processes; all must end with code 0."""
    for process in processes:
        process.send_signal(signal.SIGINT)
    for process in processes:
        assert process.wait(30.0) == 0, chain.text(process)
        assert 'Traceback' not in chain.text(process)


def contents(path):
    """Return {topic: [(log_ns, data)]} of a bag."""
    with open_bag(path) as bag:
        assert not bag.cut
        return {name: [m[1:] for m in bag.messages([name])] for name in bag.topics}


def mixed_bag(path, count=200):
    """Write a bag of a stream, of strings, and of a latched topic; 100 Hz from 50 s on."""
    pack = topics.IMU_RAW.writer().pack
    with BagWriter(path) as bag:
        bag.add_topic('imu', topics.IMU)
        bag.add_topic('words', topics.STRING, bag_qos.profile_yaml(reliability='best_effort'))
        bag.add_topic('latched', topics.STRING, bag_qos.LATCHED)
        bag.add_topic('unknown', 'other_msgs/msg/Thing', definition='int32 x\n')
        bag.add_topic('no name', topics.STRING)
        for word in (b'first\x00\x00\x00', b'second\x00\x00'):
            bag.write('latched', 50 * SECOND,
                      b'\x00\x01\x00\x00' + len(word.rstrip(b'\x00') + b'\x00').to_bytes(
                          4, 'little') + word)
        bag.write('unknown', 50 * SECOND, b'\x00\x01\x00\x00\x01\x00\x00\x00')
        for k in range(count):
            t_ns = 50 * SECOND + k * 10**7
            bag.write('imu', t_ns, pack(t_ns, (float(k), 0.0, 0.0), (0.0, 0.0, 9.8)))
            if k % 10 == 0:
                bag.write('words', t_ns, b'\x00\x01\x00\x00\x04\x00\x00\x00abc\x00')
    return path


def test_played_and_recorded_again(chain, tmp_path):
    """A bag that is played and recorded has the same bytes, order and QoS, in a namespace too."""
    path = mixed_bag(tmp_path / 'bag')
    recorder = chain.start_verb('record', 'imu', 'words', 'latched', '-o', tmp_path / 'again',
                                '--ros-args', '-r', '__ns:=/robot')
    chain.wait_text(recorder, 'waiting for')
    player = chain.start_verb('play', path, '--rate', '2', '--clock', '50', '--wait', '20',
                              '--ros-args', '-r', '__ns:=/robot')
    assert player.wait(30.0) == 0, chain.text(player)
    text = chain.text(player)
    assert '/no name is not played: Invalid topic name' in text
    assert '/unknown is not played: ' in text and 'played 222 messages on 3 topics' in text
    end(chain, recorder)
    before, after = contents(path), contents(tmp_path / 'again')
    assert after['/robot/imu'] == before['/imu']
    for name in ('words', 'latched'):
        assert [d for _, d in after['/robot/' + name]] == [d for _, d in before['/' + name]]
    with open_bag(tmp_path / 'again') as bag:
        offers = {n: bag_qos.read_profiles(c.qos)[0] for n, c in bag.topics.items()}
    assert offers['/robot/latched']['durability'] == 'transient_local'
    assert offers['/robot/words']['reliability'] == 'best_effort'


def test_time_is_counted_and_shown(ros_domain, chain, tmp_path):
    """
    Messages are spread over the time in which they were recorded, and /clock with them.

    A player that does not wait would send a second of messages within milliseconds. On a busy
    machine the first ones may be late and others follow immediately; up to half of them is
    accepted here.
    """
    path = mixed_bag(tmp_path / 'bag')
    talker = Talker(ros_domain)
    try:
        from ins_sim.ros.transport.backlog import HandQueue
        queue = HandQueue(talker.node, topics.Topic('imu', topics.IMU), 1000)
        clock = HandQueue(talker.node, topics.CLOCK_TOPIC, 1000)
        player = chain.start_verb('play', path, '--start', '0.5', '--duration', '1.0', '--clock',
                                  '--topics', 'imu', '--wait', '20')
        assert player.wait(30.0) == 0, chain.text(player)
        times = []
        while (message := queue.take_with_info()) is not None:
            times.append((topics.IMU_RAW.reader().read(message[0])[0],
                          message[1]['source_timestamp']))
        stamps, sent = np.array(times).T
        late_s = (sent - sent[0] - (stamps - stamps[0])) * 1e-9
        print(f'\nlate by {np.percentile(late_s, 50):.4f} s, at most {late_s.max():.4f} s')
        assert np.array_equal(stamps, 50 * SECOND + np.arange(50, 151) * 10**7)
        assert late_s[-1] > -0.5
        ticks = []
        while (data := clock.take()) is not None:
            ticks.append(topics.CLOCK_TOPIC.reader().read(data)[0])
        assert ticks == (50 * SECOND + np.arange(50, 151) * 10**7).tolist()
    finally:
        talker.close()


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_signals(number, chain, tmp_path):
    """A signal in the middle of an endless loop ends the player with exit code 0."""
    path = mixed_bag(tmp_path / 'bag', 20)
    player = chain.start_verb('play', path, '--loop', '--wait', '0', '--topics', 'imu')
    chain.wait_text(player, 'begins again')
    player.send_signal(number)
    assert player.wait(20.0) == 0, chain.text(player)
    text = chain.text(player)
    assert 'Traceback' not in text and re.search(r'played \d+ messages on 1 topics', text)


def original(chain, tmp_path):
    """Run the chain in lock-step, record it, and return the path of the bag."""
    path = tmp_path / 'original'
    recorder = chain.start_verb('record', *FROM_IMU, 'truth/imu', *OUTPUTS, '-o', path)
    nodes = [chain.start(n, {**PARAMETERS, **LOCK_STEP})
             for n in ('motion_generator', 'imu_sensor', 'strapdown')]
    assert nodes[0].wait(60.0) == 0, chain.text(nodes[0])
    end(chain, recorder, *nodes[1:])
    return path


def test_lock_step_gives_the_original_run(chain, tmp_path):
    """
    Played in lock-step from truth or readings, the odometry has the original bytes.

    The processes are those of replay.launch.py, in a namespace.
    """
    path = original(chain, tmp_path)
    before = contents(path)
    for source, replay in graph.REPLAYS.items():
        again = tmp_path / source
        recorder = chain.start_verb('record', *OUTPUTS, '-o', again, '--ros-args', '-r',
                                    '__ns:=/left')
        started = [chain.run(p.name, graph.process_command(p, (), PARAMETERS.items(), 'left'))
                   for p in replay.processes]
        player = chain.run('player', graph.play_command(
            path, replay, ['--lock-step', 'strapdown', 'recorder'], 'left'))
        assert player.wait(60.0) == 0, chain.text(player)
        end(chain, recorder, *started)
        after = contents(again)
        for name in OUTPUTS:
            assert len(after['/left/' + name]) == 501
            assert after['/left/' + name] == before['/' + name]
        texts = [chain.text(p) for p in started]
        assert not warnings_of_loss(texts), texts


def test_loops_are_seen_as_jumps_back(ros_domain, chain, tmp_path):
    """In lock-step each round of a loop is a run: the strapdown reports the jump and restarts."""
    path = original(chain, tmp_path)
    listener = Listener(ros_domain, (topics.INS_ODOMETRY,))
    strapdown = chain.start('strapdown', PARAMETERS)
    player = chain.start_verb('play', path, '--lock-step', 'strapdown', '--topics', *FROM_IMU,
                              '--loop')
    try:
        listener.poll_until(lambda: listener.repeats > 600)
        end(chain, player)
        end(chain, strapdown)
    finally:
        listener.close()
    text = chain.text(strapdown)
    assert 'jumps back from 5.000000000 s to 0.000000000 s' in text
    names = ('position', 'orientation', 'pose_covariance', 'linear', 'angular',
             'twist_covariance')
    with open_bag(path) as bag:
        table = bag.arrays('ins/odometry', names)
    heard = listener.heard['ins/odometry']
    assert sorted(heard) == table['stamp_ns'].tolist()
    # Every stamp was processed at least twice, the last time as in the original run.
    expected = np.concatenate([table[n] for n in names], axis=1)
    assert np.array_equal([heard[t] for t in sorted(heard)], expected)


def test_on_fault_stop_ends_the_loop(chain, tmp_path):
    """A strapdown that stops at a fault exits with 3; the player names it and exits with 4."""
    path = original(chain, tmp_path)
    strapdown = chain.start('strapdown', {**PARAMETERS, 'on_fault': 'stop'})
    player = chain.start_verb('play', path, '--lock-step', 'strapdown', '--topics', *FROM_IMU,
                              '--loop', '--timeout', '2')
    assert strapdown.wait(60.0) == 3, chain.text(strapdown)
    assert player.wait(30.0) == 4, chain.text(player)
    assert 'no acknowledgement on sim/ack from strapdown for 2 s; expected the consumers of ' \
        '--lock-step to run' in chain.text(player)


def test_what_is_refused(chain, tmp_path):
    """Invalid arguments of play give one message and exit code 2."""
    path = mixed_bag(tmp_path / 'bag', 5)
    for words, sentence in (
            ((tmp_path / 'none',), 'none does not exist; expected a bag'),
            ((path, '--topics', 'imuu'), 'has no topic /imuu; the nearest is /imu'),
            ((path, '--topics', 'unknown'), "/unknown cannot be played: No module named 'other"),
            ((path, '--rate', '0'), '--rate is 0; expected more than 0')):
        player = chain.start_verb('play', *words)
        assert player.wait(20.0) == 2, chain.text(player)
        assert sentence in chain.text(player) and 'Traceback' not in chain.text(player)


def test_a_long_silence_is_said_with_the_way_out(chain, tmp_path):
    """If nothing was logged for years the player reports the wait and proposes --start."""
    path, pack = tmp_path / 'bag', topics.IMU_RAW.writer().pack
    with BagWriter(path) as bag:
        bag.add_topic('imu', topics.IMU)
        for k in range(20):
            log_ns = (k >= 5) * 1_700_000_000 * SECOND + k * 10**7
            bag.write('imu', log_ns, pack(log_ns, (0.0,) * 3, (0.0, 0.0, 9.8)))
    player = chain.start_verb('play', path, '--wait', '0')
    chain.wait_text(player, 'the bag has no message for 1700000000.010 s from 0.040 s on: waiting '
                            '1700000000 s (--start 1700000000.050 begins after the gap')
    end(chain, player)
    player = chain.start_verb('play', path, '--wait', '0', '--start', '1700000000.050')
    assert player.wait(30.0) == 0
    assert 'played 15 messages' in chain.text(player) and 'nothing was' not in chain.text(player)
