"""Parameters set while the nodes run: node objects without DDS, asked as the services are."""

import math

from hypothesis import given, HealthCheck, settings, strategies as st
import pytest
from support.hostile.fed_nodes import FedNodes
from support.nodes.asked import ask, ask_at_once, value_of

from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND
from ins_sim.messages.run_announcement import RunAnnouncement
from ins_sim.ros.lock_step.truth_source import TruthSource
from ins_sim.settings.catalogue import build
from ins_sim.settings.motion import MotionGeneratorSettings

pytest.importorskip('rclpy')

MOTION = {'motion.kind': 'racetrack'}
FLIGHT = {'rate_hz': 100.0, 'time.epoch': 'fixed', 'time.epoch_s': 0, **MOTION}
BIAS, FORCE_BIAS = 'gyro.errors.bias_deg_h', 'accelerometer.errors.bias_ug'
LOST, FAULT = 'sampling.drop_out_probability', 'gyro.dtg.fault.'
NOISY = {'gyro.errors.angle_random_walk_deg_sqrt_h': [0.1] * 3,
         'gyro.errors.rate_random_walk_deg_h_sqrt_h': [1.0] * 3,
         'gyro.errors.turn_on_bias_sigma_deg_h': [5.0] * 3,
         'accelerometer.errors.bias_instability_ug': [30.0] * 3}
DTG = {'gyro.model': 'dtg', 'output': 'integrated'}
OURS = {'source': 'motion', **MOTION}


class Flown(FedNodes):
    """Nodes that hear the truth of a racetrack; ``heard`` has the messages of each topic."""

    def __init__(self, **nodes):
        super().__init__(nodes)
        self._source = TruthSource(build(MotionGeneratorSettings, FLIGHT))
        self._k, self.heard = 0, {}

    def __enter__(self):
        super().__enter__()
        self.bus.listen = lambda name, data: self.heard.setdefault(name, []).append(data)
        for node in self.nodes.values():
            node._announced.take(RunAnnouncement(0, 0, 100.0, 3600 * SECOND).pack())
        return self

    def fly(self, count):
        """Send so many samples."""
        for _ in range(count):
            for topic, data in zip(topics.TRUTH, self._source.messages(self._k)):
                self.bus.put(topic.name, data)
            self._k += 1
            self.clock.pass_by(0.01)
            self.bus.drive()

    def said(self, node):
        """Return what a node has said."""
        return '\n'.join(self.logs[node].kept)


def readings(parameters, at=None, change=None, count=600):
    """Return the IMU messages of a flight, amid which at sample ``at`` parameters are set."""
    with Flown(imu_sensor=parameters) as flown:
        flown.fly(count if at is None else at)
        if at is not None:
            assert ask_at_once(flown.nodes['imu_sensor'], change) == ''
            flown.fly(count - at)
        return flown.heard[topics.IMU_RAW.name], flown.said('imu_sensor')


@pytest.mark.parametrize('more, from_k', [
    ({}, 150), (NOISY, 150), ({**NOISY, **OURS}, 150), ({**DTG, **NOISY}, 150),
    ({**DTG, **NOISY, **OURS}, 256)],
    ids=['perfect', 'noise', 'own motion', 'tuned gyros', 'tuned gyros, own motion'])
def test_a_bias_counts_from_the_instant_that_is_said(more, from_k, ros_domain):
    """
    Before it, the bytes of a run with the old bias; from it on, those of one with the new bias.

    Tuned gyros that evaluate their own motion do so a block of 256 ahead, which the line says.
    """
    old, said = readings(more)
    new, _ = readings({**more, BIAS: [50.0, -50.0, 0.0]})
    got, said = readings(more, 150, {BIAS: [50.0, -50.0, 0.0]})
    assert got[:from_k] == old[:from_k] and got[from_k:] == new[from_k:]
    assert all(a != b for a, b in zip(old, new))
    assert f'{BIAS} is now [50.0, -50.0, 0.0] deg/h from t = {from_k / 100:.9f} s on' in said


def test_biases_and_drop_outs_at_once_and_back(ros_domain):
    """Taken together in one line, and taken back; drop-outs are those of a run with that rate."""
    change = {BIAS: 7, FORCE_BIAS: [1.0, 2.0, 3.0], LOST: 0.5}
    perfect, _ = readings({})
    with Flown(imu_sensor={}) as flown:
        node = flown.nodes['imu_sensor']
        flown.fly(100)
        assert ask_at_once(node, change) == ''
        flown.fly(100)
        assert ask(node, {BIAS: 0.0, FORCE_BIAS: 0, LOST: 0}) == [''] * 3
        flown.fly(100)
        got, said = flown.heard[topics.IMU_RAW.name], flown.said('imu_sensor')
        assert value_of(node, BIAS) == [0.0] * 3 and node.settings.gyro.errors.bias_deg_h == (
            0.0,) * 3
    assert (f'{BIAS} is now [7.0, 7.0, 7.0] deg/h from t = 1.000000000 s on; {FORCE_BIAS} is now '
            f'[1.0, 2.0, 3.0] ug from t = 1.000000000 s on; {LOST} is now 0.5 from t') in said
    amid, _ = readings({BIAS: [7.0] * 3, FORCE_BIAS: [1.0, 2.0, 3.0], LOST: 0.5})
    lossless, _ = readings({BIAS: [7.0] * 3, FORCE_BIAS: [1.0, 2.0, 3.0]})
    kept = [data for data in lossless[100:200] if data in set(amid)]
    assert 20 < len(kept) < 80 and got == [*perfect[:100], *kept, *perfect[200:300]]


def test_a_fault_is_injected_changed_and_taken_away(ros_domain):
    """The channel, none at first, and bias by parameters; the service keeps what it forced."""
    from support.nodes.asked import service_of
    from types import SimpleNamespace
    with Flown(imu_sensor=DTG) as flown:
        node = flown.nodes['imu_sensor']
        force = service_of(node, 'fault')
        answer = force(SimpleNamespace(data=True), SimpleNamespace(success=False))
        assert not answer.success and answer.message == (
            'gyro.dtg.fault.channel is none; expected the channel that is to have the fault')
        pair = node.stage.pair.pair
        flown.fly(100)
        assert ask_at_once(node, {FAULT + 'channel': 'gyro_2_z', FAULT + 'bias_deg_h': 3600.0,
                                  FAULT + 'start_s': 1.5, FAULT + 'end_s': 2.0}) == ''
        on = []
        for _ in range(150):
            flown.fly(1)
            on.append(pair.faults is not None)
        assert on == [False] * 50 + [True] * 50 + [False] * 50
        assert force(SimpleNamespace(data=True), SimpleNamespace()).success
        assert ask(node, {FAULT + 'scale': 0}) == ['']
        flown.fly(1)
        assert pair.faults[3] == (pytest.approx(math.radians(1.0)), 0.0)
        assert ask(node, {FAULT + 'channel': 'gyro_9'})[0].startswith(
            f"{FAULT}channel is 'gyro_9'; expected one of none, gyro_1_y")
        assert ask(node, {FAULT + 'end_s': 2.5}) == ['']
        flown.fly(1)
        assert pair.faults is None
        assert ask(node, {FAULT + 'channel': 'none'}) == ['']


def test_outages_and_a_jump_of_the_receiver(ros_domain):
    """The begins may come alone: such an outage lasts until its end is set."""
    status = topics.GNSS_FIX.reader().numbers
    with Flown(gnss={'gnss.rate_hz': 10.0}) as flown:
        node = flown.nodes['gnss']
        assert value_of(node, 'outages.start_s') == []
        flown.fly(100)
        assert ask(node, {'outages.start_s': [1.45]}) == ['']
        assert value_of(node, 'outages.end_s') == [1e7]
        flown.fly(100)
        assert ask(node, {'outages.end_s': [2.0]}) == ['']
        flown.fly(50)
        assert ask(node, {'jump.offset_m': [100.0, 0.0, 0.0]}) == [
            'jump.offset_m cannot be set: jump.end_s is 0 s with jump.start_s 0 s; expected a '
            'later end']
        assert ask_at_once(node, {'jump.end_s': 1e6, 'jump.offset_m': [0.0, 0.0, 5e4]}) == ''
        flown.fly(50)
        fixes = flown.heard[topics.GNSS_FIX.name]
        lost = [k for k, data in enumerate(fixes) if status(data)[0] < 0]
        assert lost == list(range(15, 20))
        assert 'outages.start_s is now [1.45] s from t = 1.000000000 s on' in flown.said('gnss')
        assert 'outages.end_s is now [2.0] s from t = 2.000000000 s on' in flown.said('gnss')
        heights = [topics.GNSS_FIX.reader().read(data)[1][2] for data in fixes[-10:]]
        assert all(4e4 < h for h in heights[5:]) and all(h < 4e4 for h in heights[:5])
        assert ask(node, {'outages.start_s': []}) == ['']
        assert value_of(node, 'outages.end_s') == []
        assert node.settings.outages.start_s == ()


def test_drop_outs_of_the_velocity_meter(ros_domain):
    """From the window on that ends next."""
    own = {'attack_angle': 'none', 'window.cycles': 10, 'limits.height_max_m': 2e4}
    with Flown(velocity_meter=own) as flown:
        node = flown.nodes['velocity_meter']
        flown.fly(105)
        assert node._invalid == 0 and node._windows == 10
        assert ask(node, {'drop_outs.start_s': [0.0]}) == ['']
        assert 'drop_outs.end_s is now [10000000.0] s from t = 1.100000000 s on' in flown.said(
            'velocity_meter')
        flown.fly(100)
        assert node._invalid == node._windows - 10 == 10
        assert ask(node, {'drop_outs.start_s': []}) == ['']
        flown.fly(100)
        assert node._invalid == 10 and node._windows == 30


NONSENSE = [
    ('imu_sensor', BIAS, 'big', " is 'big'; expected 3 numbers, or one for all"),
    ('imu_sensor', BIAS, True, ' is True; expected 3 numbers, or one for all'),
    ('imu_sensor', BIAS, [1.0, 2.0], ' has 2 entries; expected 3'),
    ('imu_sensor', BIAS, [1.0, 2.0, math.nan], ' is nan; expected a finite number'),
    ('imu_sensor', BIAS, [0.0, 0.0, 1e300], ' is 1e+300 deg/h; expected -1e+09 to 1e+09 deg/h'),
    ('imu_sensor', BIAS, ['a', 'b', 'c'], "[0] is 'a'; expected a number"),
    ('imu_sensor', LOST, 'often', " is 'often'; expected a number"),
    ('imu_sensor', LOST, [0.5], ' is [0.5]; expected a number'),
    ('imu_sensor', FAULT + 'channel', 'gyro_1_y', ' cannot be set: gyro.model is ideal; expected '
     'dtg: the fault is one of a tuned gyro'),
    ('gnss', 'outages.end_s', [1.0], 'outages.start_s has 0 entries and outages.end_s 1; expected '
     'as many'),
    ('gnss', 'outages.start_s', [-1.0], ' is -1 s; expected 0 to 1e+07 s'),
    ('gnss', 'outages.start_s', 5.0, ' is 5.0; expected a list'),
    ('gnss', 'seed', 3, 'seed is read-only: it is taken at the start; settable while it runs: one '
     'of outages.start_s, outages.end_s, jump.start_s, jump.end_s, jump.offset_m'),
    ('strapdown', 'seed', 1, "unknown parameter 'seed'; the nearest known one is 'use_sim_time'"),
    ('strapdown', 'rate_hz', 1.0, 'rate_hz is read-only: it is taken at the start; settable while '
     'it runs: none of this node'),
    ('velocity_meter', 'drop_outs.start', [1.0], "unknown parameter 'drop_outs.start'; the "
     "nearest known one is 'drop_outs.start_s'"),
]


@pytest.fixture(scope='module')
def running():
    """Four nodes in flight."""
    from ins_sim.ros.process.domains import own_domain
    with own_domain(), Flown(imu_sensor={}, gnss={}, velocity_meter={}, strapdown={}) as flown:
        flown.fly(20)
        yield flown


@pytest.mark.parametrize('node, name, value, sentence', NONSENSE)
def test_nonsense_is_one_sentence(node, name, value, sentence, running):
    """By either service; the old value stays, nothing ends, and nothing is counted as a change."""
    one = running.nodes[node]
    settings, types = one.settings, {n: p.type_ for n, p in one._parameters.items()}
    sentence = name + sentence if sentence[0] in ' [' else sentence
    for reason in (*ask(one, {name: value}), ask_at_once(one, {name: value})):
        assert reason == sentence and '\n' not in reason
    assert one.settings is settings and types == {n: p.type_ for n, p in one._parameters.items()}
    if name in one._parameters:
        assert one.describe_parameter(name).type == types[name].value
    before = running.bus.sent[topics.IMU_RAW.name]
    running.fly(1)
    assert running.bus.sent[topics.IMU_RAW.name] == before + 1
    assert 'is now' not in running.said(node)


def test_of_several_at_once_one_bad_one_refuses_all(running):
    """And of several in turn the good ones are taken."""
    node = running.nodes['imu_sensor']
    assert ask_at_once(node, {BIAS: 5.0, FORCE_BIAS: 'x'}).startswith(f"{FORCE_BIAS} is 'x'")
    assert value_of(node, BIAS) == [0.0] * 3
    assert [bool(r) for r in ask(node, {BIAS: 5.0, FORCE_BIAS: 'x', 'rate_hz': 5.0})] == [
        False, True, True]
    assert value_of(node, BIAS) == [5.0] * 3
    assert ask(node, {BIAS: 0.0}) == ['']
    assert 'Traceback' not in running.said('imu_sensor')


def test_messages_that_no_tool_sends(running):
    """A type that ROS has not, a deletion, an empty request, parameters of ROS itself."""
    from rcl_interfaces.msg import Parameter, ParameterValue
    node = running.nodes['imu_sensor']
    strange = Parameter(name=BIAS, value=ParameterValue(type=42))
    assert ask(node, {BIAS: strange}) == [
        f'{BIAS} cannot be set: 42 is not a valid Parameter.Type']
    assert ask_at_once(node, {BIAS: strange, LOST: 0.0}).startswith(f'{BIAS}, {LOST} cannot be')
    for name in (BIAS, LOST):
        gone = Parameter(name=name, value=ParameterValue(type=0))
        assert ask(node, {name: gone}) == [f'{name} cannot be deleted; expected a value']
    assert ask(node, {}) == [] and ask_at_once(node, {}) == ''
    assert ask(node, {'use_sim_time': 3}) == [
        "use_sim_time cannot be set: Wrong parameter type, expected 'Type.BOOL' got "
        "'Type.INTEGER'"]
    assert ask(node, {'': 3})[0].startswith("unknown parameter ''")


NUMBERS = st.floats(width=64) | st.sampled_from([0.0, 0.5, 1.0, 1e7])
VALUES = (st.booleans() | st.integers(-2 ** 63, 2 ** 63 - 1) | NUMBERS
          | st.text(st.characters(codec='ascii'), max_size=80)
          | st.lists(NUMBERS, max_size=4) | st.lists(st.integers(0, 9), min_size=3, max_size=3)
          | st.lists(st.booleans(), max_size=3) | st.lists(st.text(max_size=3), max_size=3))


@given(data=st.data())
@settings(max_examples=150, deadline=None,
          suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_whatever_is_asked_is_taken_or_refused_in_a_sentence(data, running):
    """Any value of any parameter; what is taken is what is declared, and the nodes go on."""
    name = data.draw(st.sampled_from(sorted(running.nodes)))
    node = running.nodes[name]
    names = st.sampled_from([*type(node.settings).SETTABLE, 'rate_hz', 'nothing'])
    asked = data.draw(st.dictionaries(names, VALUES, max_size=3))
    types = {key: node.get_parameter(key).type_ for key in asked if node.has_parameter(key)}
    reason = ask_at_once(node, asked)
    assert '\n' not in reason and len(reason) <= 430 and 'please report' not in running.said(name)
    assert types == {key: node.get_parameter(key).type_ for key in types}
    running.fly(1)
    assert not node.monitor.faults and not running.bus.wrong


def test_changes_are_counted_on_diagnostics(running):
    """One for each request that changed something."""
    node = running.nodes['imu_sensor']

    def count():
        sent = []
        node.monitor._publisher = type('Publisher', (), {'publish': staticmethod(sent.append)})
        node.monitor.publish()
        return int(next(v.value for v in sent[0].status[0].values if v.key == 'parameter changes'))

    before = count()
    ask(node, {BIAS: 1.0})
    ask_at_once(node, {BIAS: 0.0, LOST: 0.0})
    ask(node, {BIAS: 'nonsense'})
    assert count() == before + 2
