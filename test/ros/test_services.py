"""Names, services, pacing and parameters of the running nodes."""

from ins_sim.messages import topics
from support.live import Chain, Listener
import pytest

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

FAST = {'rate_hz': 100.0, 'duration_s': 3.0, 'pacing.real_time_factor': 0.0}


@pytest.fixture
def chain(ros_domain, tmp_path):
    chain = Chain(ros_domain, tmp_path)
    yield chain
    chain.end()


def fails(chain, node, parameters, code, arguments=()):
    """Start a node that must end with an exit code; return its one message."""
    process = chain.start(node, parameters, arguments)
    assert process.wait(60.0) == code, chain.text(process)
    text = chain.text(process)
    assert 'Traceback' not in text
    return text


@pytest.mark.parametrize('node, parameters, sentence', [
    ('imu_sensor', {'gyro.delay_us.q': 1.0}, "the nearest known one is 'gyro.delay_us."),
    ('strapdown', {'rate_hertz': 1.0}, "the nearest known one is 'rate_hz'"),
    ('strapdown', {'rate_hz': -5.0}, 'rate_hz is -5 Hz; expected 0.01 to 20000 Hz'),
    ('imu_sensor', {'rate_hz': '.nan'}, 'rate_hz is nan; expected a finite number'),
    ('motion_generator', {'motion.kind': 'rockin'}, 'nearest: rocking'),
    ('motion_generator', {'rate_hz': 'fast'}, "rate_hz is 'fast'; expected a number"),
    ('motion_generator', {'pacing.window': 500, 'topics.depth': 100}, 'expected at most'),
    ('motion_generator', {'motion.kind': 'recording', 'motion.recording.path': '/no/such.csv'},
     '/no/such.csv'),
    ('motion_generator', {'time.epoch_s': 2147483000}, 'a ROS stamp can hold'),
    ('motion_generator', {'motion.sinusoids.angle_deg': '[1.0, 2.0]'}, '2 entries; expected 3'),
    ('strapdown', {'frames.prefix': 'uav1/'}, 'expected no slash at its ends, as in uav1'),
])
def test_a_bad_parameter_is_one_sentence_and_code_2(chain, node, parameters, sentence):
    """An invalid parameter of a node gives one message and exit code 2."""
    text = fails(chain, node, parameters, 2)
    assert sentence in text and text.count('\n') == 1


def test_a_parameter_file_that_is_none_is_code_2(chain, tmp_path):
    """An invalid parameter file gives exit code 2."""
    path = tmp_path / 'bad.yaml'
    path.write_text('/**: [1, {\n')
    fails(chain, 'strapdown', {}, 2, ['--params-file', str(path)])


def test_whole_numbers_serve_as_floats(chain, ros_domain):
    """Integers are accepted for floats; descriptors have unit, range and choices."""
    listener = Listener(ros_domain, ())
    try:
        from rcl_interfaces.srv import DescribeParameters, GetParameters
        chain.start('motion_generator', {'rate_hz': 50, 'motion.sinusoids.angle_deg': '[1, 2, 3]'})
        names = ['rate_hz', 'motion.sinusoids.angle_deg', 'motion.kind']
        values = listener.call(GetParameters, '/motion_generator/get_parameters',
                               GetParameters.Request(names=names)).values
        assert values[0].double_value == 50.0
        assert list(values[1].double_array_value) == [1.0, 2.0, 3.0]
        facts = listener.call(DescribeParameters, '/motion_generator/describe_parameters',
                              DescribeParameters.Request(names=names)).descriptors
        assert all(f.read_only for f in facts)
        assert '[Hz]' in facts[0].description and facts[0].floating_point_range[0].to_value == 2e4
        assert 'rocking' in facts[2].additional_constraints
    finally:
        listener.close()


def test_namespace_and_remapping(chain, ros_domain):
    """Nodes in a namespace with a remapped topic receive all 301 samples."""
    heard = (topics.TRUTH_IMU, topics.IMU_RAW, topics.INS_ODOMETRY)
    listener = Listener(ros_domain, heard, namespace='/ship')
    rules = ['-r', '__ns:=/ship', '-r', 'imu/data_raw:=imu/other']
    try:
        parameters = {**FAST, 'pacing.required': '[strapdown, listener]'}
        listener.close()
        other = tuple(t if t is not topics.IMU_RAW else topics.Topic(
            'imu/other', t.type_name, t.frames, t.constants, t.runs) for t in heard)
        listener = Listener(ros_domain, other, namespace='/ship')
        for node in ('imu_sensor', 'strapdown', 'motion_generator'):
            generator = chain.start(node, parameters, rules)
        listener.poll_until(lambda: generator.poll() is not None)
        assert generator.returncode == 0
        listener.poll_until(lambda: {len(s) for s in listener.heard.values()} == {301})
    finally:
        listener.close()


def test_a_missing_consumer_is_named_with_code_4(chain):
    """Without the required consumers the generator names them and exits with code 4."""
    text = fails(chain, 'motion_generator', {**FAST, 'pacing.timeout_s': 1.0,
                                             'pacing.required': '[strapdown, camera]'}, 4)
    assert 'strapdown, camera' in text


def test_pause_step_reset_and_status(chain, ros_domain):
    """~/pause, ~/step and ~/reset act on the samples, and sim/status follows."""
    from std_msgs.msg import String
    from std_srvs.srv import SetBool, Trigger
    from ins_sim.ros.transport.qos import latched_profile
    listener = Listener(ros_domain, (topics.TRUTH_IMU,))
    states = []
    try:
        chain.start('motion_generator', {'rate_hz': 100.0, 'duration_s': 0.0})
        listener.node.create_subscription(String, 'sim/status',
                                          lambda m: states.append(m.data), latched_profile())
        heard = listener.heard['truth/imu']
        listener.poll_until(lambda: len(heard) > 10)
        pause = SetBool.Request(data=True)
        assert listener.call(SetBool, '/motion_generator/pause', pause).success
        listener.poll_for(0.5)
        count = len(heard)
        for _ in range(3):
            assert listener.call(Trigger, '/motion_generator/step').success
        listener.poll_until(lambda: len(heard) == count + 3)
        listener.poll_for(0.5)
        assert len(heard) == count + 3
        listener.call(Trigger, '/motion_generator/reset')
        listener.call(Trigger, '/motion_generator/step')
        listener.call(SetBool, '/motion_generator/pause', SetBool.Request(data=False))
        listener.poll_until(lambda: listener.repeats > 5 or 0 in heard and len(heard) > count + 20)
        listener.spin_until(lambda: states and states[-1] == 'running')
        assert 'paused' in states
    finally:
        listener.close()


def test_clock_and_use_sim_time(chain, ros_domain):
    """With use_sim_time the run is complete, and /clock ends 3 s after the epoch."""
    listener = Listener(ros_domain, (topics.CLOCK_TOPIC,))
    try:
        chain.start('strapdown', {**FAST, 'use_sim_time': True})
        chain.start('imu_sensor', {**FAST, 'use_sim_time': True})
        generator = chain.start('motion_generator', {
            **FAST, 'publish_clock': True, 'time.epoch_s': 1700000000, 'pacing.required':
            '[strapdown, listener]'})
        listener.poll_until(lambda: generator.poll() is not None)
        assert generator.returncode == 0
        listener.poll_until(lambda: max(listener.heard['/clock']) == 1700000003 * 10**9)
    finally:
        listener.close()


def test_an_injected_fault_is_seen(chain, ros_domain):
    """A fault injected by ~/fault appears in imu/parity and /diagnostics, and then ends."""
    from std_srvs.srv import SetBool
    dtg = {'gyro.model': 'dtg', 'output': 'integrated', 'gyro.dtg.fault.channel': 'gyro_2_z',
           'gyro.dtg.fault.bias_deg_h': 500.0, 'gyro.dtg.fault.start_s': -1.0,
           'motion.kind': 'static'}
    listener = Listener(ros_domain, (topics.IMU_PARITY,))
    seen = listener.diagnostics()
    try:
        sensor = chain.start('imu_sensor', dtg)
        chain.start('motion_generator', {**dtg, 'duration_s': 0.0})
        parities = listener.heard['imu/parity']

        def hear(condition):
            listener.spin_until(lambda: listener.poll() or (
                parities and condition(parities[max(parities)])))

        # x: parity of the reading, y: its mean over a window, z: its threshold.
        hear(lambda p: p[2] > 0.0)
        assert abs(parities[max(parities)][1]) <= parities[max(parities)][2]
        assert not [m for _, _, m in seen if 'parity' in m]
        answer = listener.call(SetBool, 'imu_sensor/fault', SetBool.Request(data=True))
        assert answer.success and answer.message == 'gyro_2_z has a fault'
        hear(lambda p: abs(p[1]) > 100.0 * p[2])
        listener.spin_until(lambda: [level for name, level, m in seen if name == '/imu_sensor'
                                     and 'a channel has a fault' in m and level == b'\x01'])
        answer = listener.call(SetBool, 'imu_sensor/fault', SetBool.Request(data=False))
        assert answer.message == 'gyro_2_z is healthy'
        hear(lambda p: abs(p[1]) <= p[2])
        chain.wait_text(sensor, 'parity of the gyro channels is')
    finally:
        listener.close()
