"""Our IMU and INS on a vehicle of Gazebo; docs/how_to/recipes/gazebo.md."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from ins_sim import resources
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).resolve().parent
PARAMETERS = str(HERE / 'gazebo.yaml')
# Consumers first, though any order works.
OURS = ('strapdown', 'imu_sensor', 'truth_adapter')


def actions(context):
    """Return the actions: Gazebo, the bridge, the adapter in front of our sensor and INS."""
    imu = str(resources.parameter_file(LaunchConfiguration('imu').perform(context)))
    gazebo = Path(get_package_share_directory('ros_gz_sim')) / 'launch' / 'gz_sim.launch.py'
    world = LaunchConfiguration('world').perform(context)
    return [
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(gazebo)),
                                 launch_arguments={'gz_args': f'-r {world}'}.items()),
        Node(package='ros_gz_bridge', executable='parameter_bridge', output='screen',
             parameters=[{'config_file': str(HERE / 'gazebo_bridge.yaml')}]),
        *(Node(package='ins_sim', executable=name, name=name, output='screen',
               parameters=[imu, PARAMETERS, {'use_sim_time': True}]) for name in OURS)]


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription([
        DeclareLaunchArgument('world', description='SDF file of a world with the model vehicle'),
        DeclareLaunchArgument('imu', default_value='imu_tactical_mems',
                              description='instrument errors: a shipped file, or a path'),
        OpaqueFunction(function=actions)])
