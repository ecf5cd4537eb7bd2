"""The attitude filters of imu_tools on a simulated IMU; docs/how_to/recipes/imu_tools.md."""

from pathlib import Path

from ins_sim import resources
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node

PARAMETERS = str(Path(__file__).resolve().parent / 'imu_tools.yaml')
# A bench that rocks by 5 deg: filters that take the specific force for gravity need one.
ARGUMENTS = {'motion': 'motion_1', 'imu': 'imu_tactical_mems', 'rate_hz': '200.0', 'tf': 'truth'}


def attitude_filter(package, executable, name):
    """Return a filter whose orientation is on NAME/imu/data; some of its topics are absolute."""
    return Node(package=package, executable=executable, name=name, output='screen',
                parameters=[PARAMETERS],
                remappings=[('/imu/data_raw', 'imu/data_raw'), ('/imu/mag', 'imu/mag'),
                            ('imu/data', f'{name}/imu/data')])


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription([
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(str(resources.launch('simulation'))),
            launch_arguments=ARGUMENTS.items()),
        attitude_filter('imu_complementary_filter', 'complementary_filter_node',
                        'complementary_filter'),
        attitude_filter('imu_filter_madgwick', 'imu_filter_madgwick_node', 'madgwick_filter')])
