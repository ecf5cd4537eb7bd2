"""Build of the ament_python package ins_sim."""

from glob import glob
import re

from setuptools import find_packages, setup

package_name = 'ins_sim'
with open(package_name + '/__init__.py', encoding='utf-8') as stream:
    version = re.search(r"^__version__ = '(.+)'$", stream.read(), re.MULTILINE).group(1)

setup(
    name=package_name,
    version=version,
    packages=find_packages(include=[package_name, package_name + '.*']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/config', sorted(glob('config/*.*ml'))),
        ('share/' + package_name + '/launch', sorted(glob('launch/*.launch.py'))),
    ],
    python_requires='>=3.10',
    install_requires=['setuptools', 'numpy', 'scipy', 'pyyaml', 'matplotlib', 'rich', 'rosbags',
                      'allantools',
                      # the chunks of MCAP; rosbags needs both as well
                      'lz4', 'backports.zstd; python_version < "3.14"'],
    extras_require={
        # On a machine with ROS 2 rclpy comes from the system, hence never unconditionally.
        'ros': ['ros-jazzy-rclpy[fastrtps]==7.1.6', 'ros-jazzy-common-interfaces==5.3.6'],
        # pytest 9 cannot start beside the launch_testing plugin of Jazzy.
        'test': ['pytest<9', 'hypothesis', 'flake8', 'colcon-ros>=0.5', 'mcap',
                 'geographiclib'],
    },
    zip_safe=False,
    maintainer='The ins_sim developers',
    maintainer_email='maintainers@users.noreply.h-seed-47ea1158.example',
    description='Simulator of inertial measurement units and of strapdown navigation',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'motion_generator = ins_sim.ros.main:motion_generator',
            'imu_sensor = ins_sim.ros.main:imu_sensor',
            'strapdown = ins_sim.ros.main:strapdown',
            'velocity_meter = ins_sim.ros.main:velocity_meter',
            'gnss = ins_sim.ros.main:gnss',
            'aided_navigator = ins_sim.ros.main:aided_navigator',
            'recorder = ins_sim.ros.main:recorder',
            'ins_sim = ins_sim.cli.main:main',
        ],
    },
)
