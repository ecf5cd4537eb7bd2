"""Explain in one sentence why rcl refuses ROS arguments, as the offline commands do."""

import sys

from ins_sim import resources
from ins_sim.ros_parameters import Parameters
from ins_sim.settings.shown import cut
from ins_sim.yaml_text import read_bytes
from .arguments import FILE_FLAG

VALUE_FLAGS = '-p', '--param'
LONGEST = 400


def sentence(error, arguments=None):
    """
    Return one sentence about what is wrong with the arguments of a node.

    Parameters
    ----------
    error : exception of rcl; its text, which names source lines of rcl, is the fallback
    arguments : command line, by default ``sys.argv``
    """
    words = sys.argv if arguments is None else list(arguments)
    parameters = Parameters()
    for flag, text in zip(words, words[1:]):
        try:
            if flag == FILE_FLAG:
                _check_file(text, parameters)
            elif flag in VALUE_FLAGS and ':=' in text:
                name, _, value = text.partition(':=')
                parameters.add_value('/**', name, value, f'{flag} {cut(text)}')
        except (ValueError, OSError) as found:
            return str(found)
    return cut(' '.join(str(error).split()), LONGEST)


def _check_file(name, parameters):
    parameters.add_file(read_bytes(resources.parameter_file(name)), name)
