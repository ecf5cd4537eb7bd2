"""Invalid requests to running nodes give one message each; no node ends or changes."""

import math

from hypothesis import given, HealthCheck, settings, strategies as st
import pytest
from support.nodes.asked import ask, ask_at_once, value_of
from support.nodes.on_racetrack import Flown

from ins_sim.messages import topics

pytest.importorskip('rclpy')

BIAS, FORCE_BIAS = 'gyro.errors.bias_deg_h', 'accelerometer.errors.bias_ug'
LOST, FAULT = 'sampling.drop_out_probability', 'gyro.dtg.fault.'
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
     'dtg: gyro.dtg.fault applies to tuned gyros only'),
    ('gnss', 'outages.end_s', [1.0], 'outages.start_s has 0 entries and outages.end_s 1; expected '
     'equal numbers'),
    ('gnss', 'outages.start_s', [-1.0], ' is -1 s; expected 0 to 1e+07 s'),
    ('gnss', 'outages.start_s', 5.0, ' is 5.0; expected a list'),
    ('gnss', 'seed', 3, 'seed is read-only, because it is read at the start; can be set while the '
     'node runs: one of outages.start_s, outages.end_s, jump.start_s, jump.end_s, jump.offset_m'),
    ('strapdown', 'seed', 1, "unknown parameter 'seed'; the nearest known one is 'use_sim_time'"),
    ('strapdown', 'rate_hz', 1.0, 'rate_hz is read-only, because it is read at the start; can be '
     'set while the node runs: no parameter of this node'),
    ('velocity_meter', 'drop_outs.start', [1.0], "unknown parameter 'drop_outs.start'; the "
     "nearest known one is 'drop_outs.start_s'"),
]


@pytest.fixture(scope='module')
def running():
    """Yield four running nodes."""
    from ins_sim.ros.process.domains import own_domain
    with own_domain(), Flown(imu_sensor={}, gnss={}, velocity_meter={}, strapdown={}) as flown:
        flown.fly(20)
        yield flown


@pytest.mark.parametrize('node, name, value, sentence', NONSENSE)
def test_nonsense_is_one_sentence(node, name, value, sentence, running):
    """Either service refuses an invalid value: the old one stays, and no change is counted."""
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
    """In an atomic request one invalid value refuses all; otherwise the valid ones are set."""
    node = running.nodes['imu_sensor']
    assert ask_at_once(node, {BIAS: 5.0, FORCE_BIAS: 'x'}).startswith(f"{FORCE_BIAS} is 'x'")
    assert value_of(node, BIAS) == [0.0] * 3
    assert [bool(r) for r in ask(node, {BIAS: 5.0, FORCE_BIAS: 'x', 'rate_hz': 5.0})] == [
        False, True, True]
    assert value_of(node, BIAS) == [5.0] * 3
    assert ask(node, {BIAS: 0.0}) == ['']
    assert 'Traceback' not in running.said('imu_sensor')


def test_messages_that_no_tool_sends(running):
    """Unknown types, deletions, empty requests and wrong types of ROS parameters are refused."""
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
    """Any value of any parameter is accepted with its declared type or refused; nodes run on."""
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
    """A request that changes parameters counts once in /diagnostics."""
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
