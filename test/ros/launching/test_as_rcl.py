"""The parameters of a launched node, as rclpy reads them from its arguments."""

import json
import subprocess
import sys

import pytest

from ins_sim.launching import arguments, plan

pytest.importorskip('rclpy')

CODE = '''
import json, sys
import rclpy
from rclpy.node import Node
rclpy.init(args=sys.argv)
node = Node('imu_sensor', namespace='left', allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True, enable_rosout=False,
            start_parameter_services=False)
print(json.dumps({name: getattr(one.value, 'tolist', lambda: one.value)()
                  for name, one in node._parameter_overrides.items()}))
'''


def test_wildcards_and_launch_arguments(tmp_path, monkeypatch):
    """Precedence rises from defaults, presets and files (with /**) to launch arguments."""
    monkeypatch.setattr(plan, 'find_spec', lambda name: name)
    own, last = tmp_path / 'own.yaml', tmp_path / 'last.yaml'
    own.write_text(
        '/**:\n  ros__parameters:\n    rate_hz: 50\n    tf: {source: none}\n    seed: 7\n'
        '    gyro: {errors: {angle_random_walk_deg_sqrt_h: [0.5, 0.5, 0.5]}}\n'
        '/**/imu_sensor:\n  ros__parameters: {frames: {prefix: mine}}\n')
    texts = {one.name: one.default for one in arguments.SIMULATION}
    made = plan.simulation({**texts, 'motion': 'racetrack', 'imu': 'imu_tactical_mems',
                            'params_file': str(own), 'prefix': 'uav1'}, 'left')
    last.write_text(made.overrides_text)
    words = ['--ros-args', *made.default_words]
    for path in (*made.files, last):
        words += ['--params-file', str(path)]
    ended = subprocess.run([sys.executable, '-c', CODE, *words], capture_output=True, text=True,
                           check=True)
    found = json.loads(ended.stdout.splitlines()[-1])
    assert found['rate_hz'] == 50 and found['tf.source'] == 'none' and found['seed'] == 7
    assert found['frames.prefix'] == 'uav1' and found['motion.kind'] == 'racetrack'
    assert found['gyro.errors.angle_random_walk_deg_sqrt_h'] == [0.5] * 3
    assert found['gyro.errors.turn_on_bias_sigma_deg_h'] == [7.0] * 3
