"""Commands of ROS and make in README and docs/ name existing items; they are not executed."""

import re
import shlex

from ins_sim import graph, resources
from ins_sim.launching import arguments
from ins_sim.messages import topics
from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.catalogue import flatten, is_of_ros
import pytest
from support.each import each
from support.pages import commands, page_id, PAGES, split
from support.places import ROOT

SETUP = (ROOT / 'setup.py').read_text(encoding='utf-8')
MAKEFILE = (ROOT / 'Makefile').read_text(encoding='utf-8')
EXECUTABLES = set(re.findall(r"^ +'(\w+) = ins_sim\.", SETUP, re.MULTILINE))
OURS = {topic.name.lstrip('/') for topic in (
    *topics.DATA, *topics.AIDING, *topics.BESIDE, topics.CLOCK_TOPIC, topics.RUN, topics.ACK,
    topics.STATUS, topics.TF, topics.TF_STATIC, topics.GUIDANCE_COMMAND, topics.OTHER_ODOMETRY)}
SERVICES = {'reset', 'pause', 'step', 'engage', 'fault', 'align', 'outage'}


def lines_of(page):
    """Return the commands of a page."""
    blocks, _ = split(page.read_text(encoding='utf-8'))
    return [line for block in blocks for line in commands(block)]


def is_own(name):
    """Return whether a parameter file is one that the reader writes."""
    return re.search(r'[$/<]|\.yaml$|^[A-Z]+$', name) is not None


def check_file(name):
    """Check that a parameter file is shipped, or written by the reader."""
    if not is_own(name):
        assert resources.parameter_file(name).is_file(), name


def check_parameter(node, name):
    """Check that a node has a parameter; the process of all nodes has the parameters of each."""
    nodes = ALL_NODES if node == 'simulation' else [node]
    found = any(name in flatten(ALL_NODES[one]) for one in nodes)
    assert found or is_of_ros(name), (node, name)


def check_run(executable, words):
    """Check ``ros2 run ins_sim EXECUTABLE --ros-args ...``."""
    assert executable in EXECUTABLES
    for option, word in zip(words, words[1:]):
        if option == '--params-file':
            check_file(word)
        elif option == '-p' and executable in ALL_NODES:
            name = word.partition(':=')[0]
            node, _, rest = name.rpartition(':')
            check_parameter(node or executable, rest)


def check_launch(file, words):
    """Check ``ros2 launch ins_sim FILE ARGUMENT:=VALUE ...``."""
    if file not in arguments.LAUNCH_FILES:
        assert (ROOT / 'config' / 'recipes' / file).is_file(), file
        return
    given = dict(word.split(':=', 1) for word in words if ':=' in word)
    arguments.check_names(given, arguments.LAUNCH_FILES[file])
    known = {argument.name: argument for argument in arguments.LAUNCH_FILES[file]}
    for name, value in given.items():
        if not is_own(value):
            arguments.read_values({name: value}, [known[name]])
            if name == 'params_file':
                for one in re.split(r'[,\s]+', value):
                    check_file(one)
            elif name in ('motion', 'imu'):
                presets = arguments.MOTIONS if name == 'motion' else arguments.INSTRUMENTS
                assert value in presets, value


def check(line):
    """Check one command; return whether it is a command of ROS or make."""
    words = shlex.split(line, comments=True)
    first = words[:3]
    if first == ['ros2', 'run', 'ins_sim']:
        check_run(words[3], words[4:])
    elif first == ['ros2', 'launch', 'ins_sim']:
        check_launch(words[3], words[4:])
    elif words[:1] and words[0] in EXECUTABLES - {'ins_sim'} and '--ros-args' in words:
        check_run(words[0], words[1:])
    elif first[:2] == ['ros2', 'param'] and words[3].rpartition('/')[2] in ALL_NODES:
        check_parameter(words[3].rpartition('/')[2], words[4])
    elif first[:2] == ['ros2', 'topic']:
        for name in [word for word in words[3:] if '/' in word and '/msg/' not in word]:
            assert any(f'/{name}'.endswith(f'/{own}') for own in OURS), name
    elif first == ['ros2', 'service', 'call']:
        node, service = words[3].rsplit('/', 2)[-2:]
        assert node in ALL_NODES and service in SERVICES, words[3]
    elif words[:1] == ['make']:
        for target in [word for word in words[1:] if re.fullmatch(r'[\w-]+', word)]:
            assert re.search(rf'^{target}:', MAKEFILE, re.MULTILINE), target
    else:
        return False
    return True


@each(PAGES, page_id)
def test_commands_of_ros_and_make(page):
    """Executables, launch files, arguments, parameters, files, topics and targets exist."""
    for line in lines_of(page):
        if re.match(r'(ros2|make|\w+ --ros-args)\b', line):
            check(line)


@pytest.mark.parametrize('line', [
    'ros2 run ins_sim imu_sensr', 'ros2 launch ins_sim simulation.launch.py moton:=racetrack',
    'ros2 launch ins_sim simulation.launch.py motion:=racetrak',
    'ros2 run ins_sim imu_sensor --ros-args -p gyro.delay_us.w:=1.0',
    'ros2 run ins_sim imu_sensor --ros-args --params-file delay_w_1us', 'make tset',
    'ros2 param set /imu_sensor gyro.bias 1.0', 'ros2 topic echo /imu/data_rw',
    'ros2 service call /strapdown/rest std_srvs/srv/Trigger'])
def test_a_wrong_name_is_found(line):
    """A wrong name in a command is found by the checks above."""
    with pytest.raises((AssertionError, ValueError, OSError)):
        check(line)


def test_executables_are_those_of_the_processes():
    """The executables found in setup.py contain every process of the graph."""
    processes = (*graph.PROCESSES, *graph.AIDING, graph.RECORDER, graph.ONE_PROCESS)
    assert {process.executable for process in processes} < EXECUTABLES


def test_extras_are_those_of_setup():
    """Extras that a page installs are defined in setup.py."""
    defined = set(re.findall(r"^        '(\w+)': \[?\w*", SETUP, re.MULTILINE))
    for page in PAGES:
        for extras in re.findall(r"'\.\[([\w,]+)\]'", page.read_text(encoding='utf-8')):
            assert set(extras.split(',')) <= defined, (page_id(page), extras)
