"""The command ``ins_sim``: select the verb, run it, and convert errors to exit codes."""

import argparse
import sys

from . import (convert, demo, describe, export, info, listing, navigate, play, predict, record,
               simulate)
from ins_sim import __version__
from ins_sim.core.numerics.sentences import tell_warnings
from ins_sim.entry import BAD_INPUT, command, INTERRUPTED
from ins_sim.settings import shown
from ins_sim.visible_text import visible
from .studies import (allan, budget, compare_filters, compare_orientation, delay_study, dtg_report,
                      dtg_study, estimate_delays, loop_study, monte_carlo)

ROS_ARGS = '--ros-args'
# Longest error message; longer ones are truncated.
LONGEST = 2000
# The verbs in the order of the help text.
VERBS = {'simulate': simulate, 'monte-carlo': monte_carlo, 'budget': budget, 'list': listing,
         'describe': describe, 'info': info, 'convert': convert, 'export': export,
         'record': record, 'play': play, 'predict': predict, 'navigate': navigate, 'demo': demo,
         'delay-study': delay_study, 'estimate-delays': estimate_delays, 'dtg-study': dtg_study,
         'dtg-report': dtg_report, 'compare-orientation': compare_orientation,
         'compare-filters': compare_filters, 'loop-study': loop_study, 'allan': allan}
NODE_VERBS = ('record', 'play')


def parser():
    """Return the parser of all verbs."""
    top = argparse.ArgumentParser(prog='ins_sim', description='Simulate an inertial measurement '
                                  'unit and the strapdown navigation with it.')
    top.add_argument('--version', action='version', version=f'ins_sim {__version__}')
    verbs = top.add_subparsers(dest='verb', required=True, metavar='VERB')
    for name, verb in VERBS.items():
        arguments = verbs.add_parser(name, help=verb.HELP, description=verb.DESCRIPTION)
        verb.add_arguments(arguments)
        arguments.set_defaults(parser=arguments)
    return top


def main(arguments=None):
    """
    Run a verb and return the exit code.

    It is 0 for success, 1 for a failed run, 2 for invalid input and 130 after an interruption. The
    verbs record and play are nodes and have the exit codes of nodes.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    cut = words.index(ROS_ARGS) if ROS_ARGS in words else len(words)
    for stream in (sys.stdout, sys.stderr):
        # Characters that the terminal cannot show are printed as escape codes.
        if hasattr(stream, 'reconfigure'):
            stream.reconfigure(errors='backslashreplace')
    top = parser()
    chosen, unknown = top.parse_known_args(words[:cut])
    if unknown:
        # argparse would print the usage of the command, not that of the verb.
        chosen.parser.error(f'unrecognized arguments: {" ".join(unknown)}')
    chosen.ros_args = words[cut:]
    if chosen.ros_args and chosen.verb not in NODE_VERBS:
        top.error(f'{chosen.verb} is not a node; {ROS_ARGS} is for {" and ".join(NODE_VERBS)}')
    tell_warnings(lambda sentence: _say(chosen.verb, sentence))
    try:
        return VERBS[chosen.verb].run(chosen)
    except (ValueError, OSError) as error:
        _say(chosen.verb, shown.cut(' '.join(str(error).splitlines()), LONGEST))
        return BAD_INPUT
    except MemoryError as error:
        why = f' ({shown.cut(str(error))})' if str(error) else ''
        _say(chosen.verb, f'there is not enough memory{why}; expected a smaller input')
        return BAD_INPUT
    except KeyboardInterrupt:
        _say(chosen.verb, 'interrupted; only the files reported above were written')
        return INTERRUPTED


def _say(verb, sentence):
    print(f'ins_sim {verb}: {visible(str(sentence))}', file=sys.stderr)


if __name__ == '__main__':
    command()
