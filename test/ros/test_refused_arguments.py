"""Arguments that rcl refuses: one sentence, in the words of the offline commands."""

import pytest

from ins_sim import resources
from ins_sim.ros.process.refusals import sentence

RCL = RuntimeError("failed to initialize rcl: Couldn't parse\n at /src/arguments.c:415")


@pytest.mark.parametrize('words, says', [
    (['--params-file', 'motion_2'], 'the parameter file motion_2 does not exist; a node takes the '
     f'path of a shipped one: --params-file {resources.config("motion_2")}'),
    (['--params-file', 'motion_22'], "no config named 'motion_22'; expected one of "),
    (['--params-file', 'x/motion_33.yaml'], 'the parameter file x/motion_33.yaml does not exist'),
    (['--params-file', 'here.yaml'], 'here.yaml is not YAML: line '),
    (['-p', 'rate_hz:=[1.0, 2]'], "-p rate_hz:=[1.0, 2] has '2' in a list of numbers with a "),
    (['-r', '__ns:=?'], "failed to initialize rcl: Couldn't parse at /src/arguments")])
def test_a_refusal_of_rcl_is_one_sentence(words, says, tmp_path, monkeypatch):
    """A missing file names the shipped one; what only rcl knows keeps its words."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'here.yaml').write_text('/**: {ros__parameters: {')
    text = sentence(RCL, ['strapdown', '--ros-args', *words])
    assert text.startswith(says) and '\n' not in text


def test_a_node_says_it(chain):
    """The exit code is that of bad parameters."""
    node = chain.start('strapdown', {}, ['--params-file', 'motion_2'])
    assert node.wait(60.0) == 2
    assert 'motion_2 does not exist; a node takes the path of a shipped one' in chain.text(node)
