"""
The command ``ins_sim``: find the verb, parse its arguments, run it.

Only the file of the verb that is asked for is imported, so that ``ins_sim --help`` is instant. It
has a DESCRIPTION, ``add_arguments(parser)`` and ``run(chosen)``, which returns the exit code.
"""

import argparse
from importlib import import_module
import signal
import sys
import warnings

from ins_sim import __version__

ROS_ARGS = '--ros-args'
NODE_VERBS = ('record', 'play')
# The verbs in the order of the help.
VERBS = {
    'simulate': 'run offline and write the run',
    'info': 'what is in a bag',
    'convert': 'a flight or an IMU from CSV to a bag, or back',
    'record': 'record live topics into a bag',
    'play': 'publish the topics of a bag',
    'predict': 'predict drift and position error',
    'navigate': 'run the strapdown over a recorded IMU',
    'demo': 'run the three nodes over DDS and show the result',
    'dtg-study': 'the tables and figures of the tuned-gyro paper',
    'dtg-report': 'roots, bandwidth and margin of a tuned gyro',
    'compare-orientation': 'the orientation algorithms on one run',
    'compare-filters': 'all filters of the aided navigator over the same flights',
    'allan': 'Allan deviation of a record or of simulated noise',
}


def parser(verb=None):
    """Return the parser of the command, with the arguments of one verb or, by default, of all."""
    top = argparse.ArgumentParser(prog='ins_sim', description='Simulate an inertial measurement '
                                  'unit and the strapdown navigation on it.')
    top.add_argument('--version', action='version', version=f'ins_sim {__version__}')
    verbs = top.add_subparsers(dest='verb', required=True, metavar='VERB')
    for name, sentence in VERBS.items():
        entry = verbs.add_parser(name, help=sentence)
        if verb in (None, name):
            module = _module(name)
            entry.description = module.DESCRIPTION
            module.add_arguments(entry)
    return top


def _module(verb):
    return import_module(f'ins_sim.cli.{verb.replace("-", "_")}')


def main(arguments=None):
    """
    Run a verb; return the exit code: 0, 2 bad input, 1 a run that failed, 130 interrupted.

    The verbs that are nodes, record and play, have the exit codes of nodes.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    cut = words.index(ROS_ARGS) if ROS_ARGS in words else len(words)
    verb = next((word for word in words[:cut] if not word.startswith('-')), '')
    top = parser(verb)
    chosen = top.parse_args(words[:cut])
    chosen.ros_args = words[cut:]
    if chosen.ros_args and chosen.verb not in NODE_VERBS:
        top.error(f'{chosen.verb} is no node; {ROS_ARGS} serves {" and ".join(NODE_VERBS)}')
    signal.signal(signal.SIGTERM, _interrupt)
    warnings.showwarning = lambda sentence, *_: print(f'ins_sim {chosen.verb}: {sentence}',
                                                      file=sys.stderr)
    try:
        return _module(chosen.verb).run(chosen)
    except (ValueError, OSError) as error:
        print(f'ins_sim {chosen.verb}: {error}', file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f'ins_sim {chosen.verb}: interrupted; only what is named above was written',
              file=sys.stderr)
        return 130


def _interrupt(number, frame):
    """End as Ctrl-C does: verbs clean up after KeyboardInterrupt."""
    raise KeyboardInterrupt


if __name__ == '__main__':
    sys.exit(main())
