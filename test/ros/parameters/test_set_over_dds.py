"""SetParameters over DDS in the process of all nodes: real services, readings that change."""

import re

import pytest
from support.live import Chain, Listener

from ins_sim.messages import topics

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

BIAS = 'gyro.errors.bias_deg_h'


def test_parameters_of_a_running_simulation(ros_domain, tmp_path):
    """A bias is in the readings from the logged instant on; invalid values change nothing."""
    from rcl_interfaces.msg import Parameter, ParameterValue
    from rcl_interfaces.srv import DescribeParameters, GetParameters, SetParameters
    from rclpy.parameter import Parameter as Named
    chain, listener = Chain(ros_domain, tmp_path), Listener(ros_domain, (topics.IMU_RAW,))

    def ask(node, *messages):
        answer = listener.call(SetParameters, f'/{node}/set_parameters',
                               SetParameters.Request(parameters=list(messages)))
        return [result.reason for result in answer.results]

    def named(name, value):
        return Named(name, value=value).to_parameter_msg()

    try:
        process = chain.start('simulation', {
            'rate_hz': 50.0, 'duration_s': 0.0, 'time.epoch': 'fixed', 'time.epoch_s': 0,
            'motion.kind': 'static', 'gyro.errors.scale_factor_ppm': 20.0})
        heard = listener.heard[topics.IMU_RAW.name]
        listener.poll_until(lambda: len(heard) > 5)
        assert ask('imu_sensor', named(BIAS, 3600)) == ['']
        chain.wait_text(process, f'{BIAS} is now')
        t_s, = re.findall(r'is now \[3600.0, 3600.0, 3600.0\] deg/h from t = ([\d.]+) s on',
                          chain.text(process))
        since = len(heard)
        listener.poll_until(lambda: len(heard) > since + 20)
        low, high = ([omega[0] for t_ns, omega in heard.items()
                      if (t_ns >= float(t_s) * 1e9) == on] for on in (False, True))
        assert len(low) > 4 and len(high) > 4 and min(high) - max(low) > 0.01
        values = listener.call(GetParameters, '/imu_sensor/get_parameters', GetParameters.Request(
            names=[BIAS, 'gyro.errors.scale_factor_ppm'])).values
        assert [list(v.double_array_value) for v in values] == [[3600.0] * 3, [20.0] * 3]
        refused = ask('imu_sensor', named('seed', 5), named('gyro.bias', 1.0), named(BIAS, 'x'),
                      Parameter(name=BIAS, value=ParameterValue(type=99)))
        assert [reason.partition(' is ')[0] for reason in refused] == [
            'seed', "unknown parameter 'gyro.bias'; the nearest known one", BIAS,
            f'{BIAS} cannot be set: 99']
        assert ask('motion_generator', named('pacing.real_time_factor', 3)) == ['']
        facts = listener.call(DescribeParameters, '/motion_generator/describe_parameters',
                              DescribeParameters.Request(names=['pacing.real_time_factor',
                                                                'rate_hz'])).descriptors
        assert [f.read_only for f in facts] == [False, True]
        listener.poll_until(lambda: len(heard) > since + 60)
        assert process.poll() is None
    finally:
        listener.close()
        codes = chain.end()
    assert set(codes.values()) == {0} and 'Traceback' not in chain.text(process)
