"""The services of simulation_interfaces, built from its public definitions if necessary."""

import importlib.util
import json
import sys

import pytest
from support.live import GUARD_S
from support.nodes.built_interfaces import build_interfaces

pytest.importorskip('rclpy')

# Release 2.1, without comments: the parts that the services need.
RESULT = ('uint8 RESULT_FEATURE_UNSUPPORTED = 0\nuint8 RESULT_OK = 1\nuint8 RESULT_NOT_FOUND = 2\n'
          'uint8 RESULT_INCORRECT_STATE = 3\nuint8 RESULT_OPERATION_FAILED = 4\nuint8 result\n'
          'string error_message\n')
STATES = ('STOPPED', 'PLAYING', 'PAUSED', 'QUITTING', 'NO_WORLD', 'LOADING_WORLD')
FEATURES = {'SIMULATION_RESET': 20, 'SIMULATION_RESET_TIME': 21, 'SIMULATION_RESET_STATE': 22,
            'SIMULATION_RESET_SPAWNED': 23, 'SIMULATION_STATE_GETTING': 24,
            'SIMULATION_STATE_SETTING': 25, 'SIMULATION_STATE_PAUSE': 26,
            'STEP_SIMULATION_SINGLE': 31, 'STEP_SIMULATION_MULTIPLE': 32}
DEFINITIONS = {
    'msg/Result.msg': RESULT,
    'msg/SimulationState.msg': ''.join(f'uint8 STATE_{name} = {k}\n'
                                       for k, name in enumerate(STATES)) + 'uint8 state\n',
    'msg/SimulatorFeatures.msg': ''.join(f'uint8 {name} = {k}\n' for name, k in FEATURES.items())
    + 'uint16[] features\nstring[] spawn_formats\nstring custom_info\n',
    'srv/GetSimulatorFeatures.srv': '---\nSimulatorFeatures features\n',
    'srv/GetSimulationState.srv': '---\nSimulationState state\nResult result\n',
    'srv/SetSimulationState.srv': 'SimulationState state\n---\n'
                                  'uint8 ALREADY_IN_TARGET_STATE = 101\n'
                                  'uint8 STATE_TRANSITION_ERROR = 102\n'
                                  'uint8 INCORRECT_TRANSITION = 103\nResult result\n',
    'srv/StepSimulation.srv': 'uint64 steps 1\n---\nResult result\n',
    'srv/ResetSimulation.srv': 'uint8 SCOPE_DEFAULT = 0\nuint8 SCOPE_TIME = 1\n'
                               'uint8 SCOPE_STATE = 2\nuint8 SCOPE_SPAWNED = 4\n'
                               'uint8 SCOPE_ALL = 255\nuint8 scope\n---\nResult result\n',
}
# A client that knows only the standard: it calls the services and prints the answers.
CLIENT = """
import json, sys
import rclpy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from simulation_interfaces.srv import *
rclpy.init()
node, stamps = rclpy.create_node('somebody'), []
node.create_subscription(Imu, 'truth/imu', lambda m: stamps.append(
    m.header.stamp.sec * 10**9 + m.header.stamp.nanosec), 1000)

def call(kind, name, **fields):
    client, request = node.create_client(kind, 'motion_generator/' + name), kind.Request()
    for key, value in fields.items():
        setattr(request.state, key, value) if key == 'state' else setattr(request, key, value)
    assert client.wait_for_service(60.0)
    future = client.call_async(request)
    rclpy.spin_until_future_complete(node, future)
    return future.result()

def found(answer):
    return [answer.result.result, answer.result.error_message]

def state(value=None):
    if value is not None:
        return found(call(SetSimulationState, 'set_simulation_state', state=value))
    return call(GetSimulationState, 'get_simulation_state').state.state

def step(count):
    before, quiet = len(stamps), 0
    answer = found(call(StepSimulation, 'step_simulation', steps=count))
    while quiet < 10 or len(stamps) - before < count:
        last = len(stamps)
        rclpy.spin_once(node, timeout_sec=0.1)
        quiet = 0 if len(stamps) > last else quiet + 1
    return [*answer, len(stamps) - before]

def settle():
    # what was sent before the pause
    quiet = 0
    while quiet < 10:
        last = len(stamps)
        rclpy.spin_once(node, timeout_sec=0.1)
        quiet = 0 if len(stamps) > last else quiet + 1

out = {'features': list(call(GetSimulatorFeatures, 'get_simulator_features').features.features)}
out['playing'] = state()
out['not paused'] = found(call(StepSimulation, 'step_simulation', steps=1))
out['pause'] = [state(2), state(2), state()]
settle()
out['steps'] = [step(1), step(25), step(0)]
out['reset'] = [found(call(ResetSimulation, 'reset_simulation', scope=s)) for s in (0, 4)]
out['after reset'] = [state(), step(3), min(stamps[-3:])]
out['stop'] = [state(0), state()]
out['no world'] = state(4)
out['play'] = [state(1), state()]
out['quit'] = state(3)
print('FOUND ' + json.dumps(out), flush=True)
"""


@pytest.mark.live
@pytest.mark.slow
@pytest.mark.parametrize('executable', ['simulation', 'motion_generator'])
def test_somebody_who_knows_the_standard(executable, chain, tmp_path):
    """A standard client reads features and state, steps and resets; bad requests get a message."""
    environment = {} if importlib.util.find_spec('simulation_interfaces') else build_interfaces(
        tmp_path / 'built', 'simulation_interfaces', DEFINITIONS, 'service_msgs')
    for name, value in environment.items():
        rest = chain.environment.get(name)
        chain.environment[name] = f'{value}:{rest}' if rest else value
    process = chain.start(executable, {'rate_hz': 100.0, 'duration_s': 0.0, 'time.epoch_s': 7})
    client = chain.run('client', [sys.executable, '-c', CLIENT])
    assert client.wait(GUARD_S) == 0, chain.text(client) + chain.text(process)
    found = json.loads(chain.text(client).partition('FOUND ')[2])
    assert found['features'] == [20, 21, 22, 24, 25, 26, 31, 32]
    assert found['playing'] == 1
    assert found['not paused'] == [4, 'the simulation is running; expected paused']
    assert found['pause'] == [[1, ''], [101, 'the simulation is already in that state'], 2]
    assert found['steps'][:2] == [[1, '', 1], [1, '', 25]]
    assert found['steps'][2][0] == 4 and 'steps is 0; expected 1 to' in found['steps'][2][1]
    assert found['reset'][0] == [1, ''] and found['reset'][1][0] == 0
    assert found['after reset'] == [2, [1, '', 3], 7 * 10**9]
    assert found['stop'] == [[1, ''], 0]
    assert found['no world'][0] == 0
    assert found['play'] == [[1, ''], 1]
    assert found['quit'] == [1, '']
    assert process.wait(GUARD_S) == 0, chain.text(process)


def test_a_release_that_is_too_old_is_said_once(monkeypatch):
    """If a type is missing it is named, and the generator runs without these services."""
    from types import ModuleType
    from ins_sim.ros.lock_step import standard_services
    from support.hostile.fed_nodes import FedNodes
    for name in ('', '.msg', '.srv'):
        module = ModuleType('simulation_interfaces' + name)
        monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.setattr(standard_services, 'find_spec', lambda name: True)
    said = []
    monkeypatch.setattr('rclpy.impl.rcutils_logger.RcutilsLogger.warning',
                        lambda self, text, **more: said.append(text))
    with FedNodes({'motion_generator': {}}):
        pass
    assert len([text for text in said if 'expected release 1.2 or later' in text]) == 1
