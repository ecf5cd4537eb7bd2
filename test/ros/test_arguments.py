"""Arguments of a node on the command line other than its ROS arguments."""

import pytest

from ins_sim.ros.process.arguments import answer


@pytest.mark.parametrize('name', ['strapdown', 'recorder', 'player'])
def test_help(name, capsys):
    """--help prints usage and parameters with unit and default; the exit code is 0."""
    assert answer(name, [name, '--help']) == 0
    said = capsys.readouterr().out
    assert said.startswith(f'usage: {name} [--ros-args')
    assert ('record.depth: Queue depth of each subscription [messages] (default: 10000)' in said) \
        == (name == 'recorder')


def test_help_says_what_can_be_set_later(capsys):
    """The help states that of the generator's parameters only its pace can be set at run time."""
    assert answer('motion_generator', ['motion_generator', '-h']) == 0
    said = capsys.readouterr().out
    assert said.count('can be set while the node runs') == 1
    assert '(implies lock_step) (default: 1.0; can be set while the node runs)' in said


@pytest.mark.parametrize('words, bad', [
    (['strapdown', '--bogus'], '--bogus'), (['strapdown', '--ros-args', '--', 'more'], 'more'),
    (['strapdown', 'x\x1b[2J'], r'x\x1b[2J')])
def test_what_is_no_ros_argument(words, bad, capsys):
    """An argument that is no ROS argument gives one message and exit code 2."""
    assert answer('strapdown', words) == 2
    said = capsys.readouterr().err
    assert f'strapdown: unknown argument {bad}; expected ROS arguments after --ros-args' in said
    assert said.count('\n') == 1


def test_ros_arguments_are_left_to_ros():
    """ROS arguments, with or without the program name before them, are passed on to ROS."""
    assert answer('strapdown', ['strapdown', '--ros-args', '-p', 'rate_hz:=5.0', '--']) is None
    assert answer('recorder', ['--ros-args', '-p', 'x:=1']) is None
    assert answer('recorder', []) is None


@pytest.mark.live
@pytest.mark.parametrize('words, sentence', [
    (['-p', 'use_sim_time:=3'], "parameter 'use_sim_time' to '3' of type 'INTEGER', expecting"),
    (['--bogus'], "unknown ROS argument ['--bogus']")])
def test_what_ros_refuses(words, sentence, chain):
    """Arguments that ROS refuses give one line, exit code 2 and no traceback."""
    pytest.importorskip('rclpy')
    node = chain.start('strapdown', {}, words)
    assert node.wait(60.0) == 2
    said = chain.text(node)
    assert sentence in said and said.count('\n') == 1
