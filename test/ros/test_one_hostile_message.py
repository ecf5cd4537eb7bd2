"""One hostile message: its log message, and all nodes keep running."""

import struct

from ins_sim.messages import diagnostic_array, topics
from ins_sim.messages.cdr import SECOND
from ins_sim.messages.run_announcement import RunAnnouncement
import pytest
from support.hostile.flight import HostileFlight

pytest.importorskip('rclpy')

IMU_DOUBLES, ODOMETRY_DOUBLES = 37, 85


class Amid(HostileFlight):
    """A flight of all nodes that gives access to its last good messages."""

    def last(self, topic):
        """Return the last good message of a topic."""
        return self.hostile.last(topic.name)

    def send(self, topic, data):
        """Send one message that is not part of the flight."""
        self.fed.bus.put(topic.name, data)
        self._drive()

    def said(self, node):
        """Return the log messages of a node."""
        return '\n'.join(self.fed.logs[node].kept)


@pytest.fixture
def flight(ros_domain):
    with Amid(1) as flight:
        flight.good(600)
        yield flight


def moved(data, shift_ns):
    """Return a message with a later stamp."""
    sec, nanosec = struct.unpack_from('<iI', data, 4)
    return data[:4] + struct.pack('<iI', *divmod(sec * SECOND + nanosec + shift_ns, SECOND)
                                  ) + data[12:]


def with_double(data, count, index, value):
    """Return a message with one of its doubles replaced, one sample later."""
    spoilt = bytearray(moved(data, 10_000_000))
    struct.pack_into('<d', spoilt, len(data) - 8 * (count - index), value)
    return bytes(spoilt)


@pytest.mark.parametrize('topic, count, index, value, node, says', [
    (topics.IMU_RAW, IMU_DOUBLES, 25, 1e10, 'strapdown', 'holds the linear acceleration (1e+10'),
    (topics.IMU_RAW, IMU_DOUBLES, 25, 1e10, 'aided_navigator', 'below 1e+06 m/s^2'),
    (topics.TRUTH_ODOMETRY, ODOMETRY_DOUBLES, 43, 1e8, 'strapdown', 'holds the linear velocity'),
    (topics.TRUTH_ODOMETRY, ODOMETRY_DOUBLES, 0, 1e200, 'gnss', 'holds the position (1e+200'),
    (topics.TRUTH_ODOMETRY, ODOMETRY_DOUBLES, 43, 1e150, 'velocity_meter', 'linear velocity'),
    (topics.TRUTH_IMU, IMU_DOUBLES, 13, 1e200, 'imu_sensor', 'holds the angular velocity (1e+200'),
    (topics.INS_ODOMETRY, ODOMETRY_DOUBLES, 44, float('nan'), 'velocity_meter', 'nan')])
def test_one_finite_number_beyond_all_bounds(topic, count, index, value, node, says, flight):
    """A finite value beyond the bound is dropped with its name; the next sample is processed."""
    flight.send(topic, with_double(flight.last(topic), count, index, value))
    # Messages of a polled queue are processed with the next sample.
    flight.good(1)
    assert says in flight.said(node)
    flight.calm(20 if topic != topics.INS_ODOMETRY else 100)
    assert not flight.rescued


@pytest.mark.parametrize('data', [b'\x00\x01\x00', b'\x00\x00\x00\x00' + bytes(8),
                                  b'\x00\x07\x00\x00' + bytes(9), b''])
def test_a_malformed_answer_is_dropped(data, flight):
    """A malformed acknowledgement to the generator is dropped; one message names sim/ack."""
    flight.send(topics.ACK, data)
    assert 'sim/ack: std_msgs/msg/Header' in flight.said('motion_generator')
    flight.calm(10)


def test_instants_of_400_digits_are_no_fix(flight):
    """A fix with an instant of 25 digits makes neither the navigator nor diagnostics fail."""
    stamp_ns, frame, (status,) = diagnostic_array.read_diagnostics(
        flight.last(topics.METER_RECORD))
    for key in ('window_start_ns', 'window_end_ns', 'arrival_ns', 'cycles'):
        values = tuple((k, '9' * 400 if k == key else v) for k, v in status.values)
        flight.send(topics.METER_RECORD, diagnostic_array.pack_diagnostics(
            stamp_ns + SECOND, frame, [diagnostic_array.Status(0, status.name, '', '', values)]))
        flight.good(1)
    text = flight.said('aided_navigator')
    assert 'velocity_meter/record holds the instant 9999999999999999999999999 ns; expected' in text
    assert 'arrives at the instant 9999999999999999999999999 ns' in text
    assert flight.fed.logs['aided_navigator'].longest < 700
    flight.calm(200)


def test_two_strays_a_day_apart_make_nobody_compute_for_minutes(flight):
    """Truth at 1 000 000 s and 1 020 000 s gives two messages, and no readings in between."""
    for stamp_s in (1_000_000, 1_020_000):
        data = flight.last(topics.TRUTH_IMU)
        flight.send(topics.TRUTH_IMU, data[:4] + struct.pack('<iI', stamp_s, 0) + data[12:])
    assert flight.most_sent < 1000
    assert 'truth has a gap from' in flight.said('imu_sensor')
    assert 'expected 1e-05 to 10 s, 1000 periods of rate_hz at most' in flight.said('imu_sensor')
    flight.calm(100)


def test_one_solution_that_is_ahead_disables_nothing(flight):
    """One ins/odometry a second ahead invalidates only the window in which it lies."""
    flight.send(topics.INS_ODOMETRY, moved(flight.last(topics.INS_ODOMETRY), SECOND))
    flight.good(150)
    valid = flight.fed.bus.sent[topics.METER_VELOCITY.name]
    flight.good(200)
    assert flight.fed.bus.sent[topics.METER_VELOCITY.name] == valid + 4


def test_a_second_strapdown_disables_nothing(flight):
    """If every solution comes twice, one of them late, the windows still have their angle."""
    valid = flight.fed.bus.sent[topics.METER_VELOCITY.name]
    for _ in range(300):
        late = flight.last(topics.INS_ODOMETRY)
        flight.good(1)
        flight.send(topics.INS_ODOMETRY, late)
    assert flight.fed.bus.sent[topics.METER_VELOCITY.name] >= valid + 5


def test_another_epoch_is_named_and_kills_nobody(ros_domain):
    """If two generators have different epochs, the stray truth is reported and no node ends."""
    with Amid(1) as flight:
        flight.good(1)
        other = RunAnnouncement(1000 * SECOND, 0, 100.0, 60 * SECOND)
        for node in ('imu_sensor', 'gnss'):
            flight.fed.nodes[node]._announced.take(other.pack())
        flight.good(300)
        for node in ('imu_sensor', 'gnss'):
            assert 'sim/run announces a run with the epoch 1000.000000000 s after 0.000000000 ' \
                   's; expected one generator' in flight.said(node)
            assert 'a message has the stamp 0.010000000 s, 999.990000000 s before the epoch of ' \
                   'the run announced on sim/run, 1000.000000000 s' in flight.said(node)
            assert flight.fed.logs[node].lines < 10
        assert not flight.rescued


@pytest.mark.parametrize('node', ['imu_sensor', 'strapdown', 'velocity_meter', 'gnss',
                                  'aided_navigator'])
def test_reset_brings_a_node_back(node, flight):
    """Whichever stream has jumped, after ~/reset the node follows the good one."""
    from std_srvs.srv import Trigger
    for topic in (topics.TRUTH_IMU, topics.TRUTH_ODOMETRY, topics.INS_ODOMETRY, topics.IMU_RAW,
                  topics.GNSS_FIX, topics.GNSS_VELOCITY, topics.METER_RECORD):
        for shift_ns in (SECOND, 2 * SECOND, 3 * SECOND):
            flight.send(topic, moved(flight.last(topic), shift_ns))
    for name in flight.fed.nodes if node == 'aided_navigator' else (node,):
        if hasattr(flight.fed.nodes[name], 'stage'):
            response = flight.fed.nodes[name]._on_reset(Trigger.Request(), Trigger.Response())
            assert response.success
    before = flight.fed.bus.sent.copy()
    flight.good(150)
    sent = {'imu_sensor': topics.IMU_RAW, 'strapdown': topics.INS_ODOMETRY, 'gnss':
            topics.GNSS_FIX, 'velocity_meter': topics.METER_VELOCITY,
            'aided_navigator': topics.AIDED_ODOMETRY}[node].name
    assert flight.fed.bus.sent[sent] > before[sent]


def test_what_nobody_foresaw_is_a_fault(flight):
    """An unexpected exception in a stage is reported once, and the node starts anew."""
    strapdown, calls = flight.fed.nodes['strapdown'], []

    def fails(*sample):
        calls.append(sample)
        raise OverflowError('math range error')

    advance, strapdown.stage.advance = strapdown.stage.advance, fails
    flight.good(5)
    strapdown.stage.advance = advance
    assert len(calls) == 5
    text, = [s for s in flight.fed.logs['strapdown'].kept if 'OverflowError' in s]
    assert text.startswith('OverflowError (math range error) at line ')
    assert 'of test_one_hostile_message.py; the current computation is discarded' in text
    flight.calm(20)
