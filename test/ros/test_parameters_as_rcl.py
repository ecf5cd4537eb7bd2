"""Parameter files read without ROS mean what rcl makes of them: names, types, values, refusals."""

import json
import subprocess
import sys

from support.parameter_table import is_assignment, table
from support.places import ROOT

from ins_sim.ros_parameters import Parameters

TYPES = {bool: 'BOOL', int: 'INTEGER', float: 'DOUBLE', str: 'STRING'}


def offline(given, node):
    """Return {name: [type, value]} as support.rcl_parameters does; a text for a refusal."""
    parameters = Parameters()
    try:
        for text in given:
            if is_assignment(text):
                name, _, value = text.partition(':=')
                section, separator, own = name.partition(':')
                parameters.add_value(section if separator else '/**', own or name, value, '-p')
            else:
                parameters.add_file(text.encode(), 'file')
        return {name: described(one.value) for name, one in parameters.of(node).items()}
    except ValueError as error:
        assert '\n' not in str(error)
        return str(error)


def described(value):
    """Return [type, value] of a value, numbers that are not whole as texts."""
    if value is None:
        return ['NOT_SET', None]
    if isinstance(value, list):
        return [TYPES[type(value[0])] + '_ARRAY', [described(v)[1] for v in value]]
    return [TYPES[type(value)], repr(value) if isinstance(value, float) else value]


def test_offline_reads_as_rcl_does(ros_domain, tmp_path):
    """
    The same of every file and assignment of the table; a refusal by one is one by the other.

    Not in the table: ``[1:30]`` and ``%YAML 1.2``, on which versions of libyaml differ, and
    hexadecimal numbers below 2.2e-308.
    """
    cases = list(table())
    asked = []
    for k, (given, node) in enumerate(cases):
        words = []
        for n, text in enumerate(given):
            path = tmp_path / f'{k}_{n}.yaml'
            if not is_assignment(text):
                path.write_bytes(text.encode())
            words += ['-p', text] if is_assignment(text) else ['--params-file', str(path)]
        asked.append((words, node))
    process = subprocess.run([sys.executable, ROOT / 'test' / 'support' / 'rcl_parameters.py'],
                             input=json.dumps(asked), capture_output=True, text=True)
    assert process.returncode == 0, process.stderr
    wrong = []
    for (given, node), live in zip(cases, json.loads(process.stdout)):
        own = offline(given, node)
        if (isinstance(own, str) != isinstance(live, str)
                or not isinstance(own, str) and own != live):
            wrong.append((given, node, live, own))
    assert len(cases) > 700 and wrong == []
