"""Parts of recorder and player without ROS: message numbers, times, the first sample."""

from ins_sim.bags.bag_writer import BagWriter
from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND, stamp_of
from ins_sim.ros.transport.gaps import Gaps
from ins_sim.ros.recording.holes import Holes
from ins_sim.ros.recording.playing import Options, PlaybackStart, Playing
from ins_sim.ros.recording.run_clock import RunClock
import pytest

PACK = topics.IMU_RAW.writer().pack


def imu(stamp_ns):
    """Return an Imu message."""
    return PACK(stamp_ns, (0.0,) * 3, (0.0,) * 3)


@pytest.mark.parametrize('numbers, publishers, lost, before', [
    ([1, 2, 3, 4], 1, 0, 0),
    ([7, 8, 9], 1, 0, 6),
    ([1, 2, 5, 6, 10], 1, 5, 0),
    ([1, 2, 1, 3, 2, 4, 3], 2, 0, 0),
    ([5, 1, 6, 2, 3, 7], 2, 0, 4),
    ([1, 1, 2, 2, 5, 3, 6], 2, 2, 0),
    # A publisher that restarts before the graph has reported it.
    ([1, 2, 3, 1, 2, 3, 4], 1, 0, 0),
    # If a topic is out of order by one, a message counted as lost that arrives stays counted.
    ([1, 3, 2, 4], 1, 1, 0)])
def test_gaps(numbers, publishers, lost, before):
    """For any interleaving of publishers, only lost messages are counted as lost."""
    gaps = Gaps()
    gaps.publishers = publishers
    for number in numbers:
        gaps.take(number)
    assert (gaps.lost, gaps.before, gaps.known) == (lost, before, True)


def test_without_numbers_losses_are_unknown():
    """Without message numbers, which some middleware lacks, losses are unknown."""
    gaps = Gaps()
    gaps.take(None)
    assert not gaps.known and gaps.lost == 0


def test_the_time_of_a_run():
    """The time of a run follows the newest stamp and runs on; only a restart turns it back."""
    clock = RunClock()
    assert clock.now(5) is None
    assert clock.hear(imu(100 * SECOND), 10) == 100 * SECOND
    assert clock.now(15) == 100 * SECOND + 5 and clock.now(5) == 100 * SECOND
    assert clock.hear(imu(100 * SECOND - 10**7), 20) == 100 * SECOND - 10**7
    assert clock.now(20) == 100 * SECOND + 10
    clock.hear(imu(0), 30)
    assert clock.now(31) == 1


@pytest.mark.parametrize('data', [b'', b'\x00\x01\x00\x00\x00', b'\x00\x00' + imu(5)[2:],
                                  imu(-SECOND)])
def test_stamps_that_no_bag_can_hold(data):
    """Messages that are too short, big-endian or before 1970 do not change the clock."""
    clock = RunClock()
    assert clock.hear(data, 1) is None and clock.now(2) is None


@pytest.fixture
def bag(tmp_path):
    """Return the path of a bag: strings, truth that begins before the readings, readings, acks."""
    path = tmp_path / 'bag'
    truth = topics.TRUTH_ODOMETRY
    with BagWriter(path) as writer:
        for name, kind in (('words', topics.STRING), (truth.name, truth.type_name),
                           ('imu/data_raw', topics.IMU), ('sim/ack', topics.HEADER)):
            writer.add_topic(name, kind)
        writer.write('words', 0, b'\x00\x01\x00\x00\x02\x00\x00\x00a\x00')
        for k in range(10):
            stamp_ns = k * SECOND
            writer.write(truth.name, stamp_ns, truth.writer().pack(
                stamp_ns, (0.0,) * 7, (0.0,) * 6))
            if k >= 2:
                writer.write('imu/data_raw', stamp_ns, imu(stamp_ns))
            writer.write('sim/ack', stamp_ns, imu(stamp_ns))
    return path


def test_the_first_sample_of_lock_step(bag):
    """
    Messages before the first sample are sent first, later ones and those without stamp after.

    No message is missing.
    """
    playing = Playing(bag, Options(required=('strapdown',)))
    assert playing.driver == '/imu/data_raw' and playing.left_out == ['/sim/ack']
    beginning = PlaybackStart(playing, stamp_of)
    assert beginning.stamp_ns == 2 * SECOND
    assert [(n, t // SECOND) for n, t, _ in beginning.early] == [
        ('/truth/odometry', 0), ('/truth/odometry', 1)]
    assert [(n, t // SECOND) for n, t, _ in beginning.repeated] == [
        ('/truth/odometry', 2), ('/imu/data_raw', 2)]
    assert [(n, t // SECOND) for n, t, _ in beginning.held] == [
        ('/words', 0), ('/truth/odometry', 3)]
    assert len(list(beginning.rest)) == 13
    playing.close()


@pytest.mark.parametrize('options, sentence', [
    ({'rate': 0.0}, '--rate is 0; expected more than 0, up to 1e6, or 0 with --lock-step'),
    ({'rate': float('nan')}, '--rate is nan'),
    ({'start_s': -1.0}, '--start is -1; expected 0 to 1e'),
    ({'start_s': 100.0}, '--start is 100 s; expected at most 9 s, the length of'),
    ({'clock_hz': 0.0}, '--clock is 0; expected 0.001 to 10000'),
    ({'topics': ('imu/data',)}, 'has no topic /imu/data; the nearest is /imu/data_raw'),
    ({'topics': ('words',), 'required': ('strapdown',)}, 'has no topic with stamps'),
    ({'topics': ('sim/ack',), 'required': ('strapdown',)}, 'has no message on a topic'),
    ({'required': ('strapdown',), 'window': 0}, '--window is 0; expected 1 to 2000')])
def test_options_that_are_refused(options, sentence, bag):
    """Invalid options give one message with option, value and expectation."""
    with pytest.raises(ValueError) as error:
        Playing(bag, Options(**options))
    assert sentence in str(error.value) and '\n' not in str(error.value)


def test_log_times_that_clock_cannot_say(tmp_path):
    """Log times beyond 2038 are played, but with /clock they are refused at the start."""
    path = tmp_path / 'bag'
    with BagWriter(path) as writer:
        writer.add_topic('imu', topics.IMU)
        for t_s in (5, 2**31 + 7):
            writer.write('imu', t_s * SECOND, imu(5 * SECOND))
    playing = Playing(path, Options())
    assert [t // SECOND for _, t, _ in playing.messages()] == [5, 2**31 + 7]
    playing.close()
    with pytest.raises(ValueError, match='was logged at 2147483655 s; expected less than '
                                         '2147483648 s, the end of the stamps of /clock'):
        Playing(path, Options(clock_hz=100.0))
    Playing(path, Options(clock_hz=100.0, duration_s=10.0)).close()


def test_start_and_duration(bag):
    """Start and duration count from the first message of the played topics, ends included."""
    playing = Playing(bag, Options(topics=('imu/data_raw',), start_s=1.0, duration_s=3.0))
    assert [t // SECOND for _, t, _ in playing.messages()] == [3, 4, 5, 6]
    playing.close()


def stamps_with_losses(count, lost):
    """Return the stamps, ns, of a stream at 1 kHz with some samples missing."""
    return [k * 10**6 for k in range(count) if k not in lost]


@pytest.mark.parametrize('stamps, missing, step_ns', [
    (stamps_with_losses(1000, ()), 0, 10**6),
    (stamps_with_losses(1001, range(1, 1000, 3)), 333, 10**6),
    # 42 % of the samples are lost, in runs as of overflowing queues.
    (stamps_with_losses(10000, [k + j for k in range(10, 9900, 100) for j in range(42)]), 4158,
     10**6),
    # Neither a pause nor a restart is a loss.
    ([*range(0, 10**9, 10**7), *range(10**12, 10**12 + 10**9, 10**7)], 0, 10**7),
    ([*range(0, 10**9, 10**7), *range(0, 10**9, 10**7)], 0, 10**7),
    # Stamps jitter by a tenth of the period; one of ten samples is lost.
    ([k * 10**7 + (k * 7919 % 1000 - 500) * 1000 for k in range(2000) if k % 10], 199, None)])
def test_holes(stamps, missing, step_ns):
    """Missing stamps are counted by the usual step of the stream itself."""
    holes = Holes()
    for stamp_ns in stamps:
        holes.take(stamp_ns)
    found, found_ns = holes.count()
    assert abs(found - missing) <= 2 and (step_ns is None or found_ns == step_ns)


def test_holes_of_what_is_not_steady():
    """Events, a few messages, and alternating stamps of two clocks have no usual step."""
    events, turns, few = Holes(), Holes(), Holes()
    t_ns = 0
    for k in range(1000):
        t_ns += 10**6 + (k * 104729 % 997) ** 3
        events.take(t_ns)
        turns.take(k * 10**7 + k % 2 * 17 * 10**17)
    for k in (0, 1, 2, 5):
        few.take(k * 10**6)
    assert events.count() == few.count() == (0, None) and turns.count()[0] == 0
