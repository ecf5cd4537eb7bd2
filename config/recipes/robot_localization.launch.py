"""robot_localization on a simulated vehicle; docs/how_to/recipes/robot_localization.md."""

from pathlib import Path

from ins_sim import resources
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node

HERE = Path(__file__).resolve().parent
PARAMETERS = str(HERE / 'robot_localization.yaml')
# These EKFs place the vehicle, so our nodes place nothing, and the model holds the instruments.
ARGUMENTS = {'motion': 'racetrack', 'imu': 'imu_tactical_mems', 'aided': 'true', 'tf': 'none',
             'params_file': PARAMETERS}


def node(executable, name, **remappings):
    """Return a node of robot_localization; remappings: of its odometry and fix."""
    names = {'odometry': 'odometry/filtered', 'fix': 'gps/fix'}
    return Node(package='robot_localization', executable=executable, name=name, output='screen',
                parameters=[PARAMETERS],
                remappings=[(names[old], new) for old, new in remappings.items()])


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription([
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(str(resources.launch('simulation'))),
            launch_arguments=ARGUMENTS.items()),
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': (HERE.parent / 'view' / 'vehicle.urdf').read_text(
                 encoding='utf-8')}]),
        node('ekf_node', 'ekf_odom', odometry='odometry/local'),
        node('ekf_node', 'ekf_map', odometry='odometry/global'),
        node('navsat_transform_node', 'navsat_transform', odometry='odometry/global',
             fix='gnss/fix')])
