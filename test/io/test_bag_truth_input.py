"""Bags that do not hold a valid motion are refused with one message."""

import numpy as np
import pytest
from support.studies import MOTION_2

from ins_sim.bags.bag_writer import BagWriter
from ins_sim.io.motion import read_motion
from ins_sim.cli.main import main
from ins_sim.messages import topics
from support.bags.truth_bags import record, recorded

SECOND = 1_000_000_000


def two_namespaces(path):
    """Write a bag with the truth in two namespaces."""
    with BagWriter(path) as bag:
        for name in ('/left/truth/odometry', '/right/truth/odometry'):
            bag.add_topic(name, topics.ODOMETRY)


def changed(function, only=topics.TRUTH, length_s=10.0):
    """Return a function that writes a bag whose data were changed by a function."""
    return lambda path: record(path, {'motion.kind': 'sinusoids'}, length_s, only=only,
                               change=function)


def gap(window):
    for topic in topics.TRUTH:
        window[topic] = [x[np.arange(len(x)) // 50 != 9] for x in window[topic]]


def backwards(path):
    """Write 5 s of truth, then the truth from 3 s on again, as after a reset."""
    def write(window):
        with BagWriter(path) as bag:
            log_ns = np.arange(1201) * (SECOND // 100)
            for topic, block in window.items():
                t_ns, values = (np.concatenate([x[:500], x[300:]]) for x in block)
                bag.add_topic(topic.name, topic.type_name)
                bag.write_blocks({topic.name: (log_ns, topic.writer().block(t_ns, values))})

    record(path.with_name('whole'), {'motion.kind': 'sinusoids'}, 10.0, change=write)


def nothing(window):
    for topic in topics.TRUTH:
        window[topic] = [x[:0] for x in window[topic]]


def not_finite(window):
    window[topics.TRUTH_ODOMETRY][1][200, 11] = np.nan


def no_rate(window):
    window[topics.TRUTH_ODOMETRY][1][:, 10:] = 0.0


def no_quaternion(window):
    window[topics.TRUTH_ATTITUDE][1][200] = 0.0


def at_the_pole(window):
    window[topics.TRUTH_FIX][1][:, 0] += 34.2


def other_stamps(window):
    window[topics.TRUTH_FIX][0] += 1


def wrong_type(path):
    """Write a bag with an Imu topic named truth/odometry."""
    with BagWriter(path) as bag:
        bag.add_topic('truth/odometry', topics.IMU)


def wrong_fix(path):
    """Write a bag of truth whose fix is a topic of strings."""
    with BagWriter(path) as bag:
        for topic in (topics.TRUTH_ODOMETRY, topics.TRUTH_ATTITUDE):
            bag.add_topic(topic.name, topic.type_name)
        bag.add_topic('truth/fix', topics.STRING)


@pytest.mark.parametrize('write, more, sentence', [
    (changed(None, (topics.TRUTH_IMU, topics.TRUTH_FIX)), [],
     'has no nav_msgs/Odometry whose name ends in truth/odometry; it has /truth/fix, /truth/imu'),
    (two_namespaces, [], '/left/truth/odometry, /right/truth/odometry; expected '
     'motion.recording.topic to name one'),
    (two_namespaces, ['motion.recording.topic:=odometri'], "has no topic 'odometri', the value of "
     "motion.recording.topic; the nearest is '/left/truth/odometry'"),
    (wrong_type, [], 'has no nav_msgs/Odometry'),
    (wrong_type, ['motion.recording.topic:=truth/odometry'],
     'has type sensor_msgs/Imu; expected nav_msgs/Odometry'),
    (wrong_fix, [], '/truth/fix has the type std_msgs/msg/String; expected sensor_msgs/msg/'),
    (changed(nothing), [], '/truth/odometry is empty; expected messages'),
    (changed(None, length_s=5.0), [], 'holds 501 rows over 5 s; expected at least 8 rows over'),
    (changed(gap), [], 'has 1 gaps over 2.5 times the median interval'),
    (backwards, [], 'has 1 stamps that do not advance (4.990000000 s goes back to 3.000000000 s)'),
    (changed(not_finite), [], '/truth/odometry at 2.000000000 s: angular is [-0.18'),
    (changed(no_rate), [], 'the angular velocity differs by'),
    (changed(no_quaternion), [], 'at 2.000000000 s: norm of the orientation is 0.0; expected 1'),
    (changed(at_the_pole), [], 'lat_deg is 89.95'),
    (changed(other_stamps), [], 'has no stamp in common with truth/fix and truth/attitude'),
    (lambda path: path.mkdir(), [], 'is not a bag'),
])
def test_a_bag_that_is_no_motion_is_one_sentence(write, more, sentence, tmp_path, capsys):
    """A bag without a valid motion gives one message and exit code 2, and nothing is written."""
    write(tmp_path / 'bag')
    words = [word for a in ['motion.kind:=recording', f'motion.recording.path:={tmp_path}/bag',
                            'duration_s:=1.0', *more] for word in ('-p', a)]
    assert main(['simulate', *words, '-o', str(tmp_path / 'out')]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1
    assert not (tmp_path / 'out').exists()


def test_lost_samples_of_one_topic_are_a_gap(tmp_path):
    """Samples that one topic lacks are left out; a lack of 0.6 s is a gap (on_gap cut)."""
    def lose(window):
        window[topics.TRUTH_FIX] = [np.delete(x, slice(900, 960), axis=0)
                                    for x in window[topics.TRUTH_FIX]]
        window[topics.TRUTH_ATTITUDE] = [x[2:] for x in window[topics.TRUTH_ATTITUDE]]

    record(tmp_path / 'bag', MOTION_2, 30.0, change=lose)
    chosen = recorded(tmp_path / 'bag', MOTION_2, **{'motion.recording.on_gap': 'cut'})
    motion = read_motion(chosen.motion_generator)
    # The first stamp that all three topics have is 0.02 s, the last before the gap 8.99 s.
    assert motion.zero_ns == 3_020_000_000 and motion.end_s == pytest.approx(8.99 - 3.0 - 3.02)
    assert 'gaps' in motion.warnings[0]


def test_a_topic_without_a_bag_is_refused(tmp_path):
    """motion.recording.topic given for a CSV file is refused."""
    chosen = recorded(tmp_path / 'x.csv', MOTION_2, **{'motion.recording.topic': 'odom'})
    with pytest.raises(ValueError, match="motion.recording.topic is 'odom', but .* is not a bag"):
        read_motion(chosen.motion_generator)
