"""The announcement of a run: node objects learn the epoch before, during or never."""

from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND
from ins_sim.messages.run_announcement import RunAnnouncement
from ins_sim.settings.catalogue import build
from ins_sim.settings.motion import MotionGeneratorSettings
from ins_sim.ros.process.told import clock_needed
import pytest
from support.hostile.fed_nodes import FedNodes
from support.hostile.flight import COMMON, HostileFlight

pytest.importorskip('rclpy')

EPOCH_NS = 1735689600 * SECOND
RUN = RunAnnouncement(EPOCH_NS, 0, 100.0, 60 * SECOND)
GNSS = {**COMMON, 'gnss.rate_hz': 10.0, 'outages.start_s': [0.25], 'outages.end_s': [0.35]}


class Announced(HostileFlight):
    """A flight of all nodes; ``knows`` tells whether sim/run is known to have a publisher."""

    announced = None

    def __init__(self, **more):
        super().__init__(1, more)

    def know(self, count, others=1):
        """Set the number of known publishers of sim/run and of other topics in every node."""
        for node in self.fed.nodes.values():
            node.count_publishers = lambda name: count if name == '/sim/run' else others

    def said(self, node):
        """Return the log messages of a node."""
        return '\n'.join(self.fed.logs[node].kept)

    def newest(self, topic):
        """Return the newest stamp on a topic, or None."""
        return self.fed.bus.newest_ns.get(topic.name)


@pytest.fixture
def flight(ros_domain):
    with Announced() as flight:
        yield flight


def test_the_generator_announces_before_the_truth(ros_domain):
    """The generator announces epoch, start, rate and end before it sends anything else."""
    heard = []
    values = {**COMMON, 'time.epoch': 'fixed', 'start_s': 5.0, 'duration_s': 7.0}
    nodes = FedNodes({'motion_generator': values})
    nodes.bus.listen = lambda name, data: heard.append((name, data))
    with nodes:
        assert [name for name, _ in heard] == [topics.RUN.name]
        assert heard[0][1] == RunAnnouncement(EPOCH_NS, 5 * SECOND, 100.0, 12 * SECOND).pack()
        generator = nodes.nodes['motion_generator']
        generator._send(0)
        assert nodes.bus.newest_ns[topics.TRUTH_IMU.name] == EPOCH_NS + 5 * SECOND


def test_what_comes_before_the_announcement_waits(flight):
    """
    Messages that come before the announcement wait: none is lost, none is acknowledged.

    The first readings are processed with the announcement.
    """
    flight.know(1)
    flight.good(20)
    assert flight.newest(topics.IMU_RAW) is None and flight.newest(topics.ACK) is None
    flight.announce(RunAnnouncement(0, 0, 100.0, 60 * SECOND))
    flight.good(1)
    assert flight.fed.bus.sent[topics.IMU_RAW.name] == 21
    assert flight.newest(topics.INS_ODOMETRY) == 20 * SECOND // 100
    assert flight.newest(topics.ACK) == 20 * SECOND // 100
    assert 'no node announces' not in flight.said('strapdown')


def test_motion_time_is_that_of_the_epoch(ros_domain):
    """An outage from 0.25 to 0.35 s of motion time applies to the stamps of these instants."""
    with Announced(gnss={**GNSS}) as flight:
        flight.know(1)
        flight.announce(RunAnnouncement(-SECOND, SECOND, 100.0, 60 * SECOND))
        status = []
        reader = topics.GNSS_FIX.reader()
        flight.fed.bus.listen = lambda name, data: status.append(
            reader.numbers(data)[0]) if name == topics.GNSS_FIX.name else None
        flight.good(60)
        # Motion time is one second later than the stamps: the outage has passed.
        assert status and set(status) == {0}


def test_where_nobody_announces_motion_time_is_the_stamp(flight):
    """Without an announcement, as of a real IMU, motion time is the stamp; each node logs it."""
    flight.know(0)
    flight.good(30)
    assert flight.newest(topics.INS_ODOMETRY) == 29 * SECOND // 100
    for node in ('imu_sensor', 'strapdown', 'gnss', 'velocity_meter', 'aided_navigator'):
        assert flight.said(node).count('no node announces a run on sim/run: motion time is the '
                                       'stamp of the messages') == 1


def test_readings_may_come_before_the_generator_is_found(flight):
    """The navigators wait 5 s for the generator of a sensor that has found it, then no longer."""
    flight.know(0)
    flight.good(1)
    assert flight.newest(topics.INS_ODOMETRY) is not None
    navigator = flight.fed.nodes['strapdown']
    navigator._announced.run = navigator._announced._since = None
    flight.know(0, others=0)
    before = flight.fed.bus.sent[topics.INS_ODOMETRY.name]
    flight.good(10)
    assert flight.fed.bus.sent[topics.INS_ODOMETRY.name] == before
    flight.announce(RunAnnouncement(0, 0, 100.0, 60 * SECOND), 'strapdown')
    assert flight.fed.bus.sent[topics.INS_ODOMETRY.name] == before + 10
    navigator._announced.run = navigator._announced._since = None
    flight.good(1)
    flight.fed.clock.pass_by(5.0)
    flight.good(1)
    assert flight.fed.bus.sent[topics.INS_ODOMETRY.name] == before + 12


def test_a_publisher_that_says_nothing_is_waited_for_so_long(flight):
    """
    A publisher of sim/run that is silent is waited for 30 s; the first samples are kept.

    One message is logged.
    """
    flight.know(1)
    flight.good(2)
    flight.fed.clock.pass_by(30.0)
    flight.good(1)
    assert flight.fed.bus.sent[topics.IMU_RAW.name] == 3
    assert 'no message on sim/run in 30 s, though it has a publisher; expected the announcement ' \
        'of the run' in flight.said('imu_sensor')


def test_more_than_the_queue_holds_is_counted(ros_domain):
    """Of 12 messages that wait for sim/run with a depth of 5 the 7 lost ones are counted."""
    with Announced(imu_sensor={**COMMON, 'topics.depth': 5}) as flight:
        flight.know(1)
        flight.good(12)
        flight.announce(RunAnnouncement(0, 0, 100.0, 60 * SECOND))
        assert '7 messages were dropped, because more than topics.depth waited for sim/run' in \
            flight.said('imu_sensor')
        flight.good(3)
        assert flight.newest(topics.IMU_RAW) == 14 * SECOND // 100


def test_another_generator_starts_all_anew(flight):
    """The epoch of another generator gives one message; a repeated announcement gives none."""
    flight.announce(RunAnnouncement(0, 0, 100.0, 60 * SECOND))
    flight.good(50)
    flight.announce(RunAnnouncement(0, 0, 100.0, 90 * SECOND))
    assert 'announces' not in flight.said('imu_sensor')
    flight.good(1)
    assert flight.newest(topics.INS_ODOMETRY) == 50 * SECOND // 100
    flight.announce(RUN, 'imu_sensor')
    assert 'sim/run announces a run with the epoch 1735689600.000000000 s after 0.000000000 s; ' \
        'expected one generator: restarting with the new epoch' in flight.said('imu_sensor')
    assert flight.fed.nodes['imu_sensor'].epoch_ns == EPOCH_NS


@pytest.mark.parametrize('run, sentence', [
    (RUN, 'a message has the stamp 0.000000000 s, 1735689600.000000000 s before the epoch of the '
     'run announced on sim/run, 1735689600.000000000 s; expected a stamp within that run, from '
     'one generator; the message was dropped'),
    (RunAnnouncement(-100 * SECOND, 100 * SECOND, 100.0, 100 * SECOND), 'a message has the stamp '
     '10.010000000 s, 0.010000000 s after the end of the run')], ids=('before', 'after'))
def test_stamps_of_no_announced_run_are_named(run, sentence, flight):
    """
    For stamps of no announced run the nodes that need the epoch log one message each.

    The strapdown navigates nevertheless.
    """
    flight.announce(run)
    if run is not RUN:
        flight.good(1001)
        assert 'stamp' not in flight.said('gnss')
    flight.good(10)
    for node in ('imu_sensor', 'gnss', 'velocity_meter'):
        assert sentence in flight.said(node), flight.said(node)
        assert flight.fed.logs[node].lines < 10
    assert not flight.rescued


def test_what_is_no_announcement_is_dropped(flight):
    """A malformed sim/run is dropped with a message, and the node continues."""
    flight.fed.nodes['gnss']._announced.take(b'\x00\x01\x00\x00')
    assert 'DiagnosticArray of 4 bytes' in flight.said('gnss')
    flight.good(5)
    assert not flight.rescued


@pytest.mark.parametrize('values, says', [
    ({}, ''), ({'pacing.lock_step': True}, 'with lock-step the stamps do not follow the wall '
               'clock: other nodes need use_sim_time: true and /clock, which publish_clock: true '
               'publishes'),
    ({'pacing.real_time_factor': 10.0, 'publish_clock': True}, 'with a real_time_factor of 10 the '
     'stamps do not follow the wall clock: other nodes need use_sim_time: true and /clock')])
def test_the_generator_says_who_needs_the_clock(values, says):
    """If stamps differ from the wall clock, the generator states who needs /clock."""
    said = clock_needed(build(MotionGeneratorSettings, values))
    assert (says in said) if says else not said
    assert ('which publish_clock' in said) == ('lock-step' in said)


def test_two_clocks_are_named(ros_domain):
    """The generator reports a second publisher of /clock."""
    with FedNodes({'motion_generator': {**COMMON, 'publish_clock': True}}) as nodes:
        generator = nodes.nodes['motion_generator']
        generator.count_publishers = lambda name: 2 if name == '/clock' else 1
        generator.get_publishers_info_by_topic = lambda name: []
        generator.monitor.publish()
        assert '/clock has 2 publishers' in '\n'.join(nodes.logs['motion_generator'].kept)
