"""The recipes use existing names of ins_sim and of other packages, and valid launch files."""

import importlib.util
import runpy
import sys
from types import ModuleType, SimpleNamespace
import warnings

from ins_sim import parameter_files, resources
from ins_sim.cli.main import parser
from ins_sim.messages import topics
from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.place import Frames, ROLES
import pytest
from support.places import ROOT
import yaml

RECIPES = ROOT / 'config' / 'recipes'
PAGES = ROOT / 'docs' / 'how_to' / 'recipes'
LAUNCHES = sorted(RECIPES.glob('*.launch.py'))
TOPICS = {topic.name: topic.type_name for topic in (
    *topics.DATA, *topics.AIDING, *topics.BESIDE, topics.OTHER_ODOMETRY, topics.CLOCK_TOPIC)}
FRAMES = {Frames().names()[role] for role in ROLES}

# Parameters declared by the nodes of other packages, from the sources of robot_localization 3.6
# and imu_tools 2.1. Those nodes silently ignore any other name.
INPUT = {'', '_config', '_queue_size', '_differential', '_relative'}
EKF = {'frequency', 'two_d_mode', 'publish_tf', 'map_frame', 'odom_frame', 'base_link_frame',
       'world_frame', 'sensor_timeout', 'print_diagnostics',
       *(f'{kind}{k}{end}' for kind in ('odom', 'imu', 'twist', 'pose') for k in range(3)
         for end in INPUT)}
NAVSAT = {'frequency', 'delay', 'use_local_cartesian', 'wait_for_datum', 'datum',
          'zero_altitude', 'publish_filtered_gps', 'use_odometry_yaw', 'yaw_offset',
          'magnetic_declination_radians', 'broadcast_cartesian_transform', 'transform_timeout'}
ATTITUDE = {'fixed_frame', 'publish_tf', 'reverse_tf', 'use_mag', 'constant_dt',
            'publish_debug_topics', 'orientation_stddev'}
THEIRS = {
    'ekf_odom': EKF, 'ekf_map': EKF, 'navsat_transform': NAVSAT,
    'complementary_filter': ATTITUDE | {'gain_acc', 'gain_mag', 'do_bias_estimation',
                                        'bias_alpha', 'do_adaptive_gain'},
    'madgwick_filter': ATTITUDE | {'world_frame', 'stateless', 'remove_gravity_vector', 'gain',
                                   'zeta', 'yaw_offset', 'declination', 'mag_bias_x'}}
EXECUTABLES = {
    'robot_localization': {'ekf_node', 'navsat_transform_node'},
    'imu_complementary_filter': {'complementary_filter_node'},
    'imu_filter_madgwick': {'imu_filter_madgwick_node'},
    'robot_state_publisher': {'robot_state_publisher'}, 'ros_gz_bridge': {'parameter_bridge'},
    'ins_sim': {'truth_adapter', 'imu_sensor', 'strapdown'}}
# Message types of the inputs of robot_localization, by their names.
KINDS = {'odom': topics.ODOMETRY, 'imu': topics.IMU, 'twist': topics.TWIST}


def sections(path):
    """Return {node: parameters} of a parameter file."""
    return {name.rpartition('/')[2]: section['ros__parameters']
            for name, section in yaml.safe_load(path.read_text()).items()}


@pytest.mark.parametrize('name, foreign', [
    ('robot_localization', ['ekf_odom', 'ekf_map', 'navsat_transform']), ('gazebo', [])])
def test_parameters_of_ours(name, foreign):
    """Our nodes read their sections, and report that the other sections belong to other nodes."""
    path = RECIPES / f'{name}.yaml'
    ours = {node: ALL_NODES[node] for node in sections(path) if node not in foreign}
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter('always')
        assert set(parameter_files.read_nodes([path], (), ours, ALL_NODES)) == set(ours)
    assert [str(one.message).rpartition(': ')[2] for one in said] == (
        [', '.join(f'/**/{node}' for node in foreign)] if foreign else [])


def test_parameters_of_others():
    """The parameters of other packages' nodes are names that these nodes declare."""
    seen = set()
    for path in (RECIPES / 'robot_localization.yaml', RECIPES / 'imu_tools.yaml'):
        for node, parameters in sections(path).items():
            if node in THEIRS:
                seen.add(node)
                assert set(parameters) <= THEIRS[node], node
    assert seen == set(THEIRS)


def test_inputs_of_robot_localization():
    """
    The inputs of robot_localization are our topics with the right types, vectors and frames.

    The vectors that select states have fifteen elements; the frames are those of ins_sim.
    """
    given = sections(RECIPES / 'robot_localization.yaml')
    for node in ('ekf_odom', 'ekf_map'):
        parameters = given[node]
        for name, value in parameters.items():
            kind = name.rstrip('0123456789')
            if kind in KINDS and value != 'odometry/gps':
                assert TOPICS[value] == KINDS[kind], name
            if name.endswith('_config'):
                assert len(value) == 15 and set(value) <= {True, False}
            if name.endswith('_frame'):
                assert value in FRAMES
    for node in ('complementary_filter', 'madgwick_filter'):
        assert sections(RECIPES / 'imu_tools.yaml')[node]['fixed_frame'] in FRAMES
    # The origin of map, where navsat_transform must have it too.
    settings = parameter_files.read([resources.config('racetrack')])
    datum = settings.motion_generator.datum
    assert given['navsat_transform']['datum'] == [datum.latitude_deg, datum.longitude_deg, 0.0]
    assert datum.height_m == 0.0


def test_the_bridge_of_gazebo():
    """The Gazebo bridge publishes topics that our nodes read, with the same types."""
    for entry in yaml.safe_load((RECIPES / 'gazebo_bridge.yaml').read_text()):
        assert TOPICS[entry['ros_topic_name']] == entry['ros_type_name']
        assert entry['gz_type_name'] == 'gz.msgs.' + entry['ros_type_name'].rpartition('/')[2]
        assert entry['direction'] == 'GZ_TO_ROS'
    datums = [section['datum'] for section in sections(RECIPES / 'gazebo.yaml').values()]
    assert len(datums) == 3 and all(datum == datums[0] for datum in datums)


class Call(SimpleNamespace):
    """Arguments with which a constructor of launch was called."""


def stand_in(name):
    """Return a constructor that stores its arguments."""
    return lambda *words, **named: Call(what=name, words=words, **named)


MODULES = {
    'launch': ['LaunchDescription'],
    'launch.actions': ['DeclareLaunchArgument', 'IncludeLaunchDescription', 'OpaqueFunction'],
    'launch.launch_description_sources': ['PythonLaunchDescriptionSource'],
    'launch.substitutions': ['LaunchConfiguration'], 'launch_ros': [],
    'launch_ros.actions': ['Node'], 'ament_index_python': [], 'ament_index_python.packages': []}
VALUES = {'imu': 'imu_tactical_mems', 'world': 'world.sdf'}


@pytest.fixture
def described(monkeypatch):
    """Return a function that gives the actions of a launch file, made by stand-ins."""
    for module, names in MODULES.items():
        stub = ModuleType(module)
        for name in names:
            setattr(stub, name, stand_in(name))
        monkeypatch.setitem(sys.modules, module, stub)
    sys.modules['launch.substitutions'].LaunchConfiguration = lambda name: SimpleNamespace(
        perform=lambda context: VALUES[name])
    sys.modules['ament_index_python.packages'].get_package_share_directory = (
        lambda package: f'/share/{package}')

    def actions(path):
        found = runpy.run_path(str(path))['generate_launch_description']().words[0]
        for action in [a for a in found if a.what == 'OpaqueFunction']:
            found += action.function(None)
        return found

    return actions


@pytest.mark.parametrize('path', LAUNCHES, ids=lambda path: path.name)
def test_launch_files(path, described):
    """Executables of launch files exist in the packages; parameter files name the nodes."""
    found = described(path)
    nodes = [action for action in found if action.what == 'Node']
    assert len(nodes) >= 2
    for node in nodes:
        assert node.executable in EXECUTABLES[node.package]
        for given in node.parameters:
            if isinstance(given, str) and str(RECIPES) in given:
                assert node.name in sections(RECIPES / given)
        for _, new in getattr(node, 'remappings', ()):
            assert new in TOPICS or new.startswith(('odometry/', node.name)), new
    for include in [action for action in found if action.what == 'IncludeLaunchDescription']:
        given = dict(include.launch_arguments)
        if 'gz_args' not in given:
            for name in (given['motion'], given['imu']):
                assert resources.parameter_file(name).is_file()


@pytest.mark.skipif(not importlib.util.find_spec('launch_ros'), reason='no launch_ros')
@pytest.mark.parametrize('path', [path for path in LAUNCHES if path.stem != 'gazebo.launch'],
                         ids=lambda path: path.name)
def test_genuine_launch_reads_them(path):
    """The real classes of launch accept the descriptions; Gazebo's needs its own package."""
    from launch import LaunchDescription
    made = runpy.run_path(str(path))['generate_launch_description']()
    assert isinstance(made, LaunchDescription) and len(made.entities) >= 3


@pytest.mark.parametrize('page', sorted(PAGES.glob('*.md')), ids=lambda page: page.name)
def test_pages(page):
    """The files and commands that a page names exist."""
    text = page.read_text()
    for path in RECIPES.iterdir():
        if path.name.startswith(page.stem):
            assert path.name in text
    for line in text.replace('\\\n', ' ').splitlines():
        words = line.split('#')[0].split()
        if words[:1] == ['ins_sim']:
            assert parser().parse_args(words[1:]).verb == words[1]
