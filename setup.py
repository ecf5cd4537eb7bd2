"""Build of the ament_python package ins_sim."""

from glob import glob
import re

from setuptools import find_packages, setup

package_name = 'ins_sim'
with open(package_name + '/__init__.py', encoding='utf-8') as stream:
    version = re.search(r"^__version__ = '(.+)'$", stream.read(), re.MULTILINE).group(1)

# The chunks of MCAP.  From Python 3.14 zstd is in the standard library.
COMPRESSION = ['lz4<5', 'backports.zstd<2; python_version < "3.14"']
# Many runs on a Dask cluster of the user's.
CLUSTER = ['distributed']
DATAFRAME = ['pandas<4']
# Compiles the loops of offline runs; the numbers are the same without it.
FAST = ['numba<1']
# The World Magnetic Model of imu/mag.
MAGNETIC = ['pygeomag>=1.1,<2']
# Figures in report.html that can be zoomed.
REPORT = ['bokeh>=3.4,<4']
XARRAY = ['xarray']
# The site of docs/, built by make docs; its theme and parser are those of the ROS build farm.
DOCS = ['sphinx>=7.2,<10', 'myst-parser>=2,<6', 'sphinx-rtd-theme>=2,<4', 'codespell<3',
        'proselint<0.17']

# Why these libraries and these bounds: docs/design/libraries.md.  After a change: make lock.
setup(
    name=package_name,
    version=version,
    packages=find_packages(include=[package_name, package_name + '.*']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/config', sorted(glob('config/*.*ml'))),
        ('share/' + package_name + '/config/view', sorted(glob('config/view/*'))),
        ('share/' + package_name + '/config/recipes', sorted(glob('config/recipes/*'))),
        ('share/' + package_name + '/launch', sorted(glob('launch/*.launch.py'))),
    ],
    python_requires='>=3.10',
    package_data={package_name: ['py.typed'], package_name + '.bags': ['message_types.json']},
    install_requires=['numpy<3', 'scipy<2', 'pyyaml<7', 'matplotlib<4', 'rich<16'],
    extras_require={
        # On a machine with ROS 2 rclpy comes from the system, hence never unconditionally.
        'ros': ['ros-jazzy-rclpy[fastrtps]==7.1.6', 'ros-jazzy-common-interfaces==5.3.6'],
        'cluster': CLUSTER,
        'compression': COMPRESSION,
        'dataframe': DATAFRAME,
        'fast': FAST,
        'magnetic': MAGNETIC,
        'report': REPORT,
        'xarray': XARRAY,
        # pytest 9 cannot start beside the launch_testing plugin of Jazzy.
        'docs': DOCS,
        'test': [*DOCS, *CLUSTER, *COMPRESSION, *DATAFRAME, *FAST, *MAGNETIC, *REPORT, *XARRAY,
                 'pytest<9', 'pytest-xdist<4', 'hypothesis<7', 'flake8<8', 'mypy<3',
                 'colcon-ros>=0.5,<0.6',
                 # what results are compared with
                 'allantools', 'geographiclib<3', 'mpmath<2', 'mcap<2', 'rosbags<0.12',
                 # what reads our bags
                 'evo<2', 'foxglove-sdk<1'],
        'bench': ['python-ins<2', 'inu<3', 'rosbags<0.12'],
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
            'truth_adapter = ins_sim.ros.main:truth_adapter',
            'simulation = ins_sim.ros.main:simulation',
            'recorder = ins_sim.ros.main:recorder',
            'ins_sim = ins_sim.entry:command',
        ],
    },
)
