"""The recorder: topics of any type and quality of service."""

import signal
import time

from ins_sim.bags import qos as bag_qos
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.definitions import message_definition
from support.live import Listener
import pytest

from ins_sim.messages import topics
from support.nodes.recorder import end, send

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live
SECOND = 1_000_000_000


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_lock_step_run_is_recorded_whole(storage, ros_domain, chain, tmp_path):
    """A lock-step run is recorded completely: every message once, with stamp and bytes."""
    listener = Listener(ros_domain, topics.DATA)
    path = tmp_path / 'bag'
    recorder = chain.start_verb('record', *listener.raw, '-o', path, '--storage', storage)
    parameters = {'rate_hz': 100.0, 'duration_s': 5.0, 'pacing.real_time_factor': 0.0,
                  'pacing.required': '[strapdown, recorder, listener]'}
    started = [chain.start(n, parameters) for n in ('motion_generator', 'imu_sensor', 'strapdown')]
    try:
        listener.poll_until(lambda: started[0].poll() is not None)
        assert started[0].returncode == 0, chain.text(started[0])
        listener.poll_until(lambda: all(len(got) == 501 for got in listener.raw.values()))
    finally:
        listener.close()
    said = end(chain, recorder)
    with open_bag(path) as bag:
        assert not bag.cut and bag.storage == storage
        for topic in topics.DATA:
            messages = list(bag.messages([topic.name]))
            assert [t for _, t, _ in messages] == [10**7 * k for k in range(501)]
            assert {t: d for _, t, d in messages} == listener.raw[topic.name]
            assert said['/' + topic.name][:2] == (topic.type_name, 501)
            assert said['/' + topic.name][2].startswith('0 lost')


def test_all_topics_in_lock_step(chain, tmp_path):
    """With all topics, sample 0 is acknowledged 1 s after the last new topic: none is missed."""
    parameters = {'rate_hz': 100.0, 'duration_s': 2.0, 'pacing.real_time_factor': 0.0,
                  'pacing.required': '[strapdown, recorder]'}
    recorder = chain.start_verb('record', '--all', '-o', tmp_path / 'bag')
    started = [chain.start(n, parameters) for n in ('strapdown', 'imu_sensor', 'motion_generator')]
    assert started[-1].wait(60.0) == 0, chain.text(started[-1])
    said = end(chain, recorder)
    for topic in topics.DATA:
        assert said['/' + topic.name][1] == 201, said
    assert {'/sim/status', '/sim/ack', '/rosout', '/diagnostics'} <= set(said)
    with open_bag(tmp_path / 'bag') as bag:
        spans = bag.spans()
        # Messages without a stamp lie within the run, up to its wall time.
        assert all(0 <= s.first_ns and s.last_ns < 60 * SECOND for s in spans.values() if s.count)


def test_a_stamp_before_the_epoch(talker, chain, tmp_path):
    """A stamp below zero, due to jitter, is logged at zero, as by simulate --bag."""
    from sensor_msgs.msg import Imu
    path, writer = tmp_path / 'bag', topics.IMU_RAW.writer()
    publisher = talker.publisher(Imu, 'imu/data_raw')
    recorder = chain.start_verb('record', 'imu/data_raw', '-o', path)
    talker.wait_matched(publisher)
    send(publisher, [writer.pack(t_ns, (0.0, 0.0, 0.1), (0.0, 0.0, 9.8))
                     for t_ns in (-20_000, 10_000_000)])
    assert end(chain, recorder)['/imu/data_raw'][1] == 2
    with open_bag(path) as bag:
        found = bag.arrays('imu/data_raw')
        assert not bag.cut
    assert found['log_ns'].tolist() == [0, 10_000_000]
    assert found['stamp_ns'].tolist() == [-20_000, 10_000_000]


def test_foreign_topics_as_they_appear(talker, chain, tmp_path):
    """
    Foreign and unknown types, best effort, latched and late topics are recorded.

    Bytes, types, definitions and offered QoS are those of the publishers.
    """
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
    from nav_msgs.msg import Goals
    from rclpy.serialization import serialize_message
    from std_msgs.msg import String
    path = tmp_path / 'bag'
    text = talker.publisher(String, 'chatter')
    weak = talker.publisher(String, 'weak', reliability='best_effort')
    latched = talker.publisher(String, 'latched', durability='transient_local', depth=1)
    latched.publish(String(data='before anyone listened'))
    recorder = chain.start_verb('record', 'chatter', 'weak', 'latched', 'late/array', 'goals',
                                'nowhere', '-o', path)
    chain.wait_text(recorder, '/late/array, /goals, /nowhere: no publisher yet')
    array = talker.publisher(DiagnosticArray, 'late/array')
    goals = talker.publisher(Goals, 'goals')
    talker.wait_matched(text, weak, latched, array, goals)
    sent = {'/chatter': [String(data=f'{k}') for k in range(50)],
            '/weak': [String(data='the same again')] * 20,
            '/late/array': [DiagnosticArray(status=[DiagnosticStatus(name=f'{k}')] * k)
                            for k in range(10)],
            '/goals': [Goals() for _ in range(3)]}
    # Only one message, because the bytes between its fields are uninitialised.
    sent = {name: [serialize_message(m) for m in messages] for name, messages in sent.items()}
    begin_ns = time.time_ns()
    for publisher, messages in zip((text, weak, array, goals), sent.values()):
        send(publisher, messages)
    end_ns = time.time_ns()
    said = end(chain, recorder)
    sent['/latched'] = [serialize_message(String(data='before anyone listened'))]
    with open_bag(path) as bag:
        assert set(bag.topics) == set(sent)
        for name, messages in sent.items():
            got = list(bag.messages([name]))
            # DDS pads the last word of a message.
            for (_, _, data), message in zip(got, messages):
                assert data[:len(message)] == message and len(data) - len(message) < 4
            assert said[name][1:] == (len(messages), '0 lost') and len(got) == len(messages)
            # Without any stamp only the time of reception is known.
            assert name == '/latched' or all(begin_ns <= t <= end_ns for _, t, _ in got)
        offers = {name: bag_qos.read_profiles(c.qos)[0] for name, c in bag.topics.items()}
        assert bag.topics['/chatter'].definition == message_definition('std_msgs/msg/String')[0]
        definition = bag.topics['/goals'].definition
        assert 'PoseStamped[] goals' in definition
        assert 'MSG: geometry_msgs/Quaternion' in definition
        assert bag.topics['/goals'].type_hash.startswith('RIHS01_')
    assert offers['/weak']['reliability'] == 'best_effort'
    assert offers['/latched']['durability'] == 'transient_local'
    assert offers['/chatter']['reliability'] == 'reliable'


def test_our_names_in_other_hands(talker, chain, tmp_path):
    """A best-effort driver on imu/data_raw is recorded; another type on it is reported."""
    from sensor_msgs.msg import Imu
    from std_msgs.msg import String
    imu = talker.publisher(Imu, 'imu/data_raw', reliability='best_effort')
    words = talker.publisher(String, 'truth/imu')
    recorder = chain.start_verb('record', 'imu/data_raw', 'truth/imu', '-o', tmp_path / 'bag')
    chain.wait_text(recorder, '/truth/imu: its type is std_msgs/msg/String; expected sensor_msgs')
    talker.wait_matched(imu)
    send(imu, [talker.imu_bytes(k * 10**7) for k in range(100)])
    send(words, [String(data='not an Imu')])
    said = end(chain, recorder)
    assert said['/imu/data_raw'][1:] == (100, '0 lost') and said['/truth/imu'][1] == 0


def test_all_topics_namespace_and_times(talker, chain, tmp_path):
    """
    With --all, hidden topics are left out; a relative name is in the recorder's namespace.

    Messages without a stamp are logged at the stamps around them.
    """
    from std_msgs.msg import String
    imu, text = talker.imu('/robot/imu'), talker.publisher(String, '/robot/words')
    hidden = talker.publisher(String, '/robot/_hidden')
    recorder = chain.start_verb('record', 'imu', '--all', '-o', tmp_path / 'bag', '--ros-args',
                                '-r', '__ns:=/robot')
    talker.wait_matched(imu, text)
    send(text, [String(data='before the first stamp')])
    send(imu, [talker.imu_bytes(k * 10**7) for k in range(500, 601)])
    send(text, [String(data='after the last one')])
    said = end(chain, recorder)
    assert hidden.get_subscription_count() == 0 and '/robot/_hidden' not in said
    with open_bag(tmp_path / 'bag') as bag:
        (_, first, _), (_, last, _) = bag.messages(['/robot/words'])
        stamps = [t for _, t, _ in bag.messages(['/robot/imu'])]
    assert stamps == [k * 10**7 for k in range(500, 601)]
    assert first == stamps[0] and 0 <= last - stamps[-1] < 5 * SECOND
    assert said['/rosout'][1] > 0


def test_received_times_and_repeats(talker, chain, tmp_path):
    """
    With log_time received the log time is that of arrival.

    Equal stamped messages are recorded once, equal strings each time.
    """
    from std_msgs.msg import String
    imu, text = talker.imu(), talker.publisher(String, 'words')
    recorder = chain.start('recorder', {'record.topics': '[imu, words]', 'storage.path':
                                        tmp_path / 'bag', 'record.log_time': 'received'})
    talker.wait_matched(imu, text)
    begin_ns = time.time_ns()
    send(imu, [talker.imu_bytes(0)] * 3 + [talker.imu_bytes(10**7)])
    send(text, [String(data='again')] * 3)
    said = end(chain, recorder)
    assert said['/imu'][1:] == (2, '0 lost, 2 repeated') and said['/words'][1:] == (3, '0 lost')
    with open_bag(tmp_path / 'bag') as bag:
        assert all(begin_ns <= t <= time.time_ns() for _, t, _ in bag.messages())


def test_losses_are_counted(talker, chain, tmp_path):
    """
    With a queue of ten that is not emptied in time, recorded plus lost equals sent.

    The stamps give the same count if twenty or more steps have the usual length.
    """
    imu = talker.imu()
    recorder = chain.start('recorder', {'record.topics': '[imu]', 'record.depth': 10,
                                        'storage.path': tmp_path / 'bag'})
    talker.wait_matched(imu)
    send(imu, [talker.imu_bytes(k * 10**6) for k in range(10)])
    recorder.send_signal(signal.SIGSTOP)
    send(imu, [talker.imu_bytes(k * 10**6) for k in range(10, 500)])
    recorder.send_signal(signal.SIGCONT)
    time.sleep(0.5)
    send(imu, [talker.imu_bytes(k * 10**6) for k in range(500, 510)])
    count, rest = end(chain, recorder)['/imu'][1:]
    print(f'\n{count} recorded, {rest}')
    lost = 510 - count
    holes = f', {lost} missing of 510 at 1000 Hz by the stamps' if count > 20 else ''
    assert rest == f'{lost} lost{holes}' and 20 <= count < 510
    with open_bag(tmp_path / 'bag') as bag:
        assert len(list(bag.messages())) == count


def test_stamps_of_two_clocks(talker, chain, tmp_path):
    """
    Of 6000 messages in a burst each is in the bag or counted as lost.

    One topic is stamped since boot, the other since 1970; a split of ten seconds of either clock
    gives one file.
    """
    boot, wall = talker.imu('boot'), talker.imu('wall')
    recorder = chain.start_verb('record', 'boot', 'wall', '-o', tmp_path / 'bag',
                                '--max-duration', '60')
    talker.wait_matched(boot, wall)
    for k in range(3000):
        boot.publish(talker.imu_bytes(k * 10**7))
        wall.publish(talker.imu_bytes(1_700_000_000 * SECOND + k * 10**7))
    said = end(chain, recorder)
    with open_bag(tmp_path / 'bag') as bag:
        files, spans = bag.files, bag.spans()
    for name in ('/boot', '/wall'):
        _, count, rest = said[name]
        assert spans[name].count == count and count + int(rest.split()[0]) == 3000, said
        assert rest.startswith('0 lost') or 'missing of 3000 at 100 Hz' in rest
    assert len(files) <= 3
