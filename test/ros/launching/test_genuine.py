"""The launch files run by the real launch, if installed: arguments, ends, exit codes."""

import os
import subprocess
import sys

import pytest

from ins_sim import resources

pytest.importorskip('rclpy', reason='needs ROS 2')
pytest.importorskip('launch_ros', reason='needs launch and launch_ros')

CODE = '''
import sys
from launch import LaunchDescription, LaunchService
from launch.actions import (DeclareLaunchArgument, GroupAction, IncludeLaunchDescription, LogInfo,
                            TimerAction)
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import PushRosNamespace
path, after_s, *words = sys.argv[1:]
service = LaunchService(argv=['motions:=mine'])
service.include_launch_description(LaunchDescription([
    DeclareLaunchArgument('motions', default_value='mine'),
    GroupAction([PushRosNamespace('left'), IncludeLaunchDescription(
        PythonLaunchDescriptionSource(path),
        launch_arguments=[word.split(':=') for word in words])]),
    TimerAction(period=float(after_s), actions=[LogInfo(msg='the parent is still here')])]))
sys.exit(service.run())
'''


def launched(*words, after_s=0.0):
    """Include the launch file in another one; return the exit code and the output."""
    ended = subprocess.run(
        [sys.executable, '-c', CODE, str(resources.launch('simulation')), str(after_s), *words],
        capture_output=True, text=True, check=False, timeout=120.0,
        env={**os.environ, 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'})
    return ended.returncode, ended.stdout + ended.stderr


@pytest.fixture
def installed():
    """Skip the test if the executables are not in the ament index."""
    from ament_index_python.packages import get_package_prefix, PackageNotFoundError
    try:
        get_package_prefix('ins_sim')
    except (PackageNotFoundError, OSError, LookupError):
        pytest.skip('ins_sim is not built by colcon')


@pytest.mark.parametrize('word, sentence', [
    ('moton:=racetrack', "unknown launch argument 'moton'; the nearest known one is 'motion'"),
    ('motion:=racetrak', "motion is 'racetrak'; expected a path or one of aggressive, "),
    ('prefix:=uav1/', "frames.prefix is 'uav1/'; expected no slash at its ends"),
    ('rate_hz:=fast', "rate_hz is 'fast'; expected a number")])
def test_refusals(word, sentence):
    """Refused arguments give one message, exit code 1, and no process."""
    code, said = launched(word)
    assert code == 1 and sentence in said
    assert 'process started' not in said and 'Traceback' not in said


@pytest.mark.live
def test_an_included_run_ends_alone(installed, ros_domain, tmp_path):
    """With shutdown:=false the nodes end, the parent continues, and the exit code is 0."""
    short = tmp_path / 'short.yaml'
    short.write_text('/**: {ros__parameters: {duration_s: 2.0}}')
    code, said = launched('shutdown:=false', 'one_process:=true', 'real_time_factor:=0.0',
                          'rate_hz:=10', f'params_file:={short}',
                          after_s=6.0)
    assert code == 0 and 'left.motion_generator' in said
    assert said.index('process has finished cleanly') < said.index('the parent is still here')


@pytest.mark.live
def test_bad_parameters_end_all(installed, ros_domain, tmp_path):
    """For any value of shutdown, bad parameters end everything with an exit code other than 0."""
    bad = tmp_path / 'bad.yaml'
    bad.write_text('/**: {ros__parameters: {sampling.jitter_us: -5.0}}')
    code, said = launched('shutdown:=false', f'params_file:={bad}', after_s=100.0)
    assert code == 1 and 'imu_sensor ended with exit code 2' in said
    assert 'the parent is still here' not in said
