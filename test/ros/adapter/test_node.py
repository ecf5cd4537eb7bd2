"""The node truth_adapter with an IMU and a strapdown, without DDS."""

import struct

import pytest
from support.hostile.fed_nodes import FedNodes
from support.other_simulators import OtherSimulator, PLACE

from ins_sim.messages import topics
from ins_sim.messages.cdr import Writer

pytest.importorskip('rclpy')

ODOM = topics.OTHER_ODOMETRY.name
LOCK_STEP = {'pacing.lock_step': True, 'pacing.window': 20, 'pacing.timeout_s': 5.0}


class Graph(FedNodes):
    """truth_adapter with the given parameters, imu_sensor and strapdown."""

    def __init__(self, others=True, **parameters):
        nodes = {'imu_sensor': PLACE, 'strapdown': PLACE} if others else {}
        super().__init__({**nodes, 'truth_adapter': {**PLACE, **parameters}})

    def __enter__(self):
        super().__enter__()
        self.adapter = self.nodes['truth_adapter']
        self.acked, self.stamps = [], []
        self.bus.listen = self._hear
        # The announcement of the adapter, which the test bus does not carry.
        for node in self.nodes.values():
            node._announced.take(self.adapter._announced.run.pack())
        return self

    def _hear(self, name, data):
        stamp_ns = self.bus.newest_ns[name]
        if name == topics.TRUTH_IMU.name:
            self.stamps.append(stamp_ns)
        if name == topics.ACK.name and b'truth_adapter' in data:
            self.acked.append(stamp_ns)

    @property
    def said(self):
        """Return the log messages of the adapter."""
        return list(self.logs['truth_adapter'].kept)

    def send(self, messages, pause_s=0.02):
        """Send messages of the other simulator, and let time pass."""
        for data in messages:
            self.bus.put(ODOM, data)
            self.bus.drive()
            self.clock.pass_by(pause_s)
            self.bus.drive()


def messages_of(length_s=4.0, frames=('odom', 'base_link'), name='sinusoids'):
    """Return the messages of an exact input at 50 Hz."""
    pack = Writer(topics.ODOMETRY, *frames).pack
    return [pack(t_ns, (*r, *q), (*v, *w))
            for t_ns, r, q, v, w in OtherSimulator(name, 50.0, length_s).samples()]


def shifted(data, shift_ns):
    """Return a message with another stamp."""
    sec, nanosec = struct.unpack_from('<iI', data, 4)
    return data[:4] + struct.pack('<iI', *divmod(sec * 10**9 + nanosec + shift_ns, 10**9)
                                  ) + data[12:]


@pytest.mark.parametrize('pacing', [{}, LOCK_STEP], ids=['real time', 'lock-step'])
def test_an_imu_and_a_strapdown_follow(pacing, ros_domain):
    """Truth, readings and solutions exist for every instant; each adaptation is logged once."""
    with Graph(**pacing) as graph:
        graph.send(messages_of())
        assert graph.stamps == sorted(set(graph.stamps)) and len(graph.stamps) > 380
        assert graph.bus.newest_ns['ins/odometry'] == graph.stamps[-1] // 10**7 * 10**7
        assert graph.acked[-1] == 4 * 10**9 and not graph.bus.wrong
        assert sum('50 Hz' in line for line in graph.said) == 1
        assert sum("the world 'odom' is taken as the plane" in line for line in graph.said) == 1


def test_stamps_of_the_past_and_of_a_wall_clock_are_taken(ros_domain):
    """Stamps near 0 and stamps of 2026 are kept as the stamps of the truth."""
    shift_ns = 1_796_000_000 * 10**9
    with Graph() as graph:
        graph.send(messages_of())
        assert graph.stamps[0] < 2 * 10**9
    with Graph() as graph:
        graph.send([shifted(data, shift_ns) for data in messages_of()])
        assert graph.stamps[-1] > shift_ns and graph.bus.sent['ins/odometry'] > 150


def test_a_simulator_that_waits_is_held_by_the_consumers(ros_domain):
    """
    Without acknowledgements of strapdown one window of truth is sent.

    The input is not acknowledged.
    """
    with Graph(others=False, **LOCK_STEP) as graph:
        graph.send(messages_of())
        # The first sample is repeated until it is acknowledged.
        assert len(set(graph.stamps)) == 1 and len(graph.stamps) > 5
        held_ns = graph.acked[-1]
        assert held_ns < 2.1e9
        answer = Writer(topics.HEADER, 'strapdown').pack(graph.stamps[0])
        graph.bus.put(topics.ACK.name, answer)
        graph.send([], 0.0)
        graph.clock.pass_by(0.1)
        assert len(set(graph.stamps)) == 21 and graph.acked[-1] > held_ns


def test_a_consumer_that_never_answers_is_named(ros_domain):
    """After pacing.timeout_s one message names the silent consumer, and the node ends."""
    with Graph(others=False, **LOCK_STEP) as graph:
        graph.send(messages_of())
        for _ in range(60):
            graph.clock.pass_by(0.1)
        assert graph.adapter.stop.code == 4
        assert any('no acknowledgement on sim/ack from strapdown' in line for line in graph.said)


def test_a_simulator_that_begins_again_is_followed_in_lock_step(ros_domain):
    """
    When the stamps jump back all nodes start anew after all acknowledgements.

    No sample is lost.
    """
    with Graph(**LOCK_STEP) as graph:
        graph.send(messages_of())
        count, first = len(graph.stamps), graph.stamps[0]
        graph.send(messages_of())
        again = graph.stamps[count:]
        assert again == sorted(set(again)) and again[0] <= first and again[-1] == graph.stamps[
            count - 1]
        assert graph.bus.newest_ns['ins/odometry'] == again[-1] // 10**7 * 10**7
        assert sum('jumps back' in line for line in graph.said) == 1


def test_one_that_does_not_wait_is_told(ros_domain):
    """In lock-step an input that does not wait is reported and restarted; memory is bounded."""
    with Graph(others=False, **LOCK_STEP, **{'topics.depth': 100}) as graph:
        graph.send(messages_of(8.0))
        assert len(graph.adapter._release) <= 102
        assert any('must wait for the acknowledgements of truth_adapter' in line
                   for line in graph.said)


@pytest.mark.parametrize('frames, said', [
    (('odom_ned', 'base_link'), "has the frame 'odom_ned'; expected a world with z up"),
    (('world', 'base_link_frd'), "has the frame 'base_link_frd'")])
def test_a_frame_that_is_not_enu_is_refused(frames, said, ros_domain):
    """A world with z down gives no truth, and one message."""
    with Graph(others=False) as graph:
        graph.send(messages_of(frames=frames))
        assert not graph.stamps and any(said in line for line in graph.said)


def test_two_vehicles_on_one_topic_are_told_apart(ros_domain):
    """Messages with other frames than the first ones are dropped with a message."""
    mixed = [data for pair in zip(messages_of(), messages_of(frames=('odom', 'other')))
             for data in pair]
    with Graph() as graph:
        graph.send(mixed)
        assert len(graph.stamps) > 380
        assert any("has the frames 'odom' and 'other'; expected 'odom' and 'base_link'" in line
                   for line in graph.said)


def test_damaged_messages_are_said_and_passed_over(ros_domain):
    """Bytes that are not Odometry, and implausible values, are reported and end no node."""
    messages = messages_of(8.0)
    messages[150] = messages[150][:200]
    messages[250] = messages[250][:-8] + struct.pack('<d', float('nan'))
    huge = bytearray(messages[300])
    struct.pack_into('<d', huge, len(huge) - 85 * 8, 1e300)
    messages[300] = bytes(huge)
    with Graph() as graph:
        graph.send(messages)
        assert graph.adapter.stop.code is None and not graph.bus.wrong
        assert graph.stamps[-1] > 7.9e9
        assert any('ends too early' in line for line in graph.said)
        assert any('holds the position (1e+300' in line for line in graph.said)


def test_an_odometry_that_stops_is_missed(ros_domain):
    """A silent input is reported, and truth continues when it returns."""
    with Graph() as graph:
        messages = messages_of(8.0)
        graph.send(messages[:200])
        for _ in range(5):
            graph.clock.pass_by(1.0)
        assert any('no message on odom for' in line for line in graph.said)
        graph.send(messages[200:])
        assert graph.stamps[-1] > 7.9e9 and graph.stamps == sorted(set(graph.stamps))


def test_reset_judges_anew(ros_domain):
    """The service ~/reset forgets the properties of the input."""
    from types import SimpleNamespace
    with Graph() as graph:
        messages = messages_of(8.0)
        graph.send(messages[:200])
        assert graph.adapter._on_reset(None, SimpleNamespace()).success
        assert graph.adapter.stage.state == 'being judged'
        graph.send(messages[200:])
        assert graph.adapter.stage.state == 'twist believed, in the child frame'


@pytest.mark.parametrize('values, said', [
    ({'truth_rate_hz': 150.0}, 'truth_rate_hz is 150 Hz; expected at least twice rate_hz, 200 Hz'),
    ({'twist': 'yes'}, "twist is 'yes'; expected one of auto, use, ignore"),
    ({'pacing.window': 2000, 'topics.depth': 100}, 'expected at most topics.depth, 100'),
    ({'pacing.lock_step': True, 'pacing.required': []}, 'pacing.required is empty')])
def test_parameters_that_do_not_go_together_are_refused(values, said, ros_domain):
    """Contradicting parameters give one message with key, value and expectation."""
    with pytest.raises(ValueError, match=said.replace('(', '[(]')):
        with Graph(others=False, **values):
            pass
