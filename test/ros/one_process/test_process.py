"""The executable simulation as a process: parameters, names, services, and exit."""

import signal

from ins_sim.messages import topics
import pytest
from support.live import Chain, GUARD_S, Listener, wait_handlers

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

NODES = ('imu_sensor', 'motion_generator', 'strapdown')
HEARD = (topics.IMU_RAW, topics.INS_ODOMETRY, *topics.ERRORS)
FILE = """/**:
  ros__parameters: {rate_hz: 100.0, duration_s: 3.0, seed: 4, gyro.delay_us.y: 1.0,
                   time.epoch_s: 0}
imu_sensor:
  ros__parameters: {gyro.errors.angle_random_walk_deg_sqrt_h: [0.1, 0.1, 0.1]}
motion_generator:
  ros__parameters: {pacing.real_time_factor: 0.0, pacing.required: [strapdown, listener]}
"""


@pytest.fixture
def chain(ros_domain, tmp_path):
    chain = Chain(ros_domain, tmp_path)
    yield chain
    chain.end()


def lock_step(chain, domain, arguments, nodes):
    """Return {topic: {stamp: bytes}} of a run of some executables, one with the generator."""
    listener = Listener(domain, HEARD)
    try:
        master = [chain.start(node, {}, arguments) for node in nodes][-1]
        listener.poll_until(lambda: master.poll() is not None)
        assert master.returncode == 0, chain.text(master)
        listener.poll_until(lambda: {len(heard) for heard in listener.heard.values()} == {301})
        assert set(chain.end().values()) == {0}
    finally:
        listener.close()
    return listener.raw


def test_the_bytes_of_three_processes_by_one_parameter_file(chain, ros_domain, tmp_path):
    """
    One parameter file with node sections gives the bytes of three processes.

    The launch file of ROS names the process, not its nodes.
    """
    path = tmp_path / 'parameters.yaml'
    path.write_text(FILE)
    arguments = ['--params-file', str(path)]
    one = lock_step(chain, ros_domain, [*arguments, '-r', '__node:=simulation'], ['simulation'])
    chain.processes.clear()
    assert one == lock_step(chain, ros_domain, arguments, ('strapdown', 'imu_sensor',
                                                           'motion_generator'))


def test_names_services_and_company(chain, ros_domain):
    """
    Nodes and services have the names of separate ones; a second imu_sensor is reported.

    Ctrl-C, even repeated, ends the process with code 0 and no traceback.
    """
    from std_srvs.srv import SetBool, Trigger
    from rcl_interfaces.srv import GetParameters
    listener = Listener(ros_domain, (topics.INS_ODOMETRY,), namespace='/ship')
    try:
        simulation = chain.start('simulation', {'rate_hz': 50.0, 'duration_s': 0.0},
                                 ['-r', '__ns:=/ship'])
        listener.poll_until(lambda: len(listener.heard['ins/odometry']) > 10)
        names = {name for name, space in listener.node.get_node_names_and_namespaces()
                 if space == '/ship'}
        assert names == {'listener', 'simulation', *NODES}
        seen = listener.diagnostics()
        listener.spin_until(lambda: {f'/ship/{node}' for node in NODES} <= {n for n, *_ in seen})
        request = GetParameters.Request(names=['rate_hz'])
        for node in NODES:
            values = listener.call(GetParameters, f'{node}/get_parameters', request).values
            assert values[0].double_value == 50.0
        assert listener.call(SetBool, 'motion_generator/pause', SetBool.Request(data=True)).success
        listener.poll_for(0.3)
        count = len(listener.heard['ins/odometry'])
        for _ in range(3):
            assert listener.call(Trigger, 'motion_generator/step').success
        listener.poll_until(lambda: len(listener.heard['ins/odometry']) == count + 3)
        assert listener.call(Trigger, 'strapdown/reset').message == 'started anew'
        listener.call(SetBool, 'motion_generator/pause', SetBool.Request(data=False))
        chain.start('imu_sensor', {'rate_hz': 50.0}, ['-r', '__ns:=/ship'])
        chain.wait_text(simulation, '/ship/imu/data_raw has 2 publishers')
        simulation.send_signal(signal.SIGINT)
        simulation.send_signal(signal.SIGINT)
        assert simulation.wait(GUARD_S) == 0
        assert 'Traceback' not in chain.text(simulation)
    finally:
        listener.close()


@pytest.mark.parametrize('parameters, code, sentence', [
    ({'rate_hz': -5.0}, 2, 'rate_hz is -5 Hz; expected 0.01 to 20000 Hz'),
    ({'aidded': True}, 2, "the nearest known one is 'aided'"),
    ({'aided': 3}, 2, 'aided is 3; expected'),
    ({'duration_s': 1.0, 'pacing.real_time_factor': 0.0, 'pacing.timeout_s': 0.5,
      'pacing.required': '[strapdown, camera]'}, 4, 'no acknowledgement on sim/ack from camera'),
])
def test_what_is_wrong_is_one_sentence(parameters, code, sentence, chain):
    """Invalid parameters give one message, exit code 2; a missing consumer exit code 4."""
    simulation = chain.start('simulation', parameters)
    assert simulation.wait(GUARD_S) == code, chain.text(simulation)
    text = chain.text(simulation)
    assert sentence in text and 'Traceback' not in text
    assert code != 2 or text.count('\n') == 1


def test_a_signal_at_any_time(chain):
    """A signal during imports, at the start or while running ends the process with code 0."""
    started = [chain.start('simulation', {'aided': True, 'rate_hz': 200.0}) for _ in range(3)]
    for process in started:
        wait_handlers(process)
    started[0].send_signal(signal.SIGTERM)
    chain.wait_text(started[1], 'receiving')
    for process in started[1:]:
        process.send_signal(signal.SIGINT)
    for process in started:
        assert process.wait(GUARD_S) == 0, chain.text(process)
        assert 'Traceback' not in chain.text(process)
