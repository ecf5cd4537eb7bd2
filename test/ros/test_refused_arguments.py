"""Arguments that rcl refuses give one message, that of the offline commands."""

import pytest

from ins_sim import resources
from ins_sim.ros.process.arguments import with_paths
from ins_sim.ros.process.refusals import sentence

RCL = RuntimeError("failed to initialize rcl: Couldn't parse\n at /src/arguments.c:415")


@pytest.mark.parametrize('words, says', [
    (['--params-file', 'motion_22'], "no config named 'motion_22'; expected one of "),
    (['--params-file', 'x/motion_33.yaml'], 'the parameter file x/motion_33.yaml does not exist'),
    (['--params-file', 'here.yaml'], 'here.yaml is not YAML: line '),
    (['-p', 'rate_hz:=[1.0, 2]'], "-p rate_hz:=[1.0, 2] has '2' in a list of numbers with a "),
    (['-r', '__ns:=?'], "failed to initialize rcl: Couldn't parse at /src/arguments")])
def test_a_refusal_of_rcl_is_one_sentence(words, says, tmp_path, monkeypatch):
    """A missing file is answered with the nearest shipped one; refusals of rcl keep their text."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'here.yaml').write_text('/**: {ros__parameters: {')
    text = sentence(RCL, ['strapdown', '--ros-args', *words])
    assert text.startswith(says) and '\n' not in text


def test_names_of_shipped_files_become_paths(tmp_path, monkeypatch):
    """
    In ROS arguments the name of a shipped file becomes its path.

    A file with that name in the working directory takes precedence.
    """
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'cruise').write_text('')
    words = ['strapdown', '--params-file', 'motion_2', '--ros-args', '--params-file', 'motion_2',
             '-p', 'x:=1', '--params-file', 'motion_22', '--params-file', 'cruise', '--',
             '--params-file', 'motion_2']
    assert with_paths(words) == [*words[:5], str(resources.config('motion_2')), *words[6:]]
    assert words[5] == 'motion_2'


def test_a_node_says_it(chain):
    """A node exits with the code of bad parameters; the name of a shipped file is accepted."""
    node = chain.start('strapdown', {}, ['--params-file', 'motion_2', '--params-file', 'motin_2'])
    assert node.wait(60.0) == 2
    assert "no config named 'motin_2'; expected one of" in chain.text(node)
