"""The command ``ins_sim``: each verb parses, calls and prints; nothing more."""

import argparse
from importlib import import_module
import signal
import sys
import warnings

from .. import __version__


def parser():
    """Return the parser of all verbs."""
    top = argparse.ArgumentParser(prog='ins_sim', description='Simulate an inertial measurement '
                                  'unit and the strapdown navigation on it.')
    top.add_argument('--version', action='version', version=f'ins_sim {__version__}')
    verbs = top.add_subparsers(dest='verb', required=True, metavar='VERB')

    simulate = verbs.add_parser('simulate', help='run offline and write the run',
                                description='Run motion, IMU and strapdown offline, with the '
                                'zero-delay twin, and write the run into a folder.')
    _settings(simulate)
    simulate.add_argument('-o', '--output', default='ins_sim_run', metavar='DIR',
                          help='folder of the run (default: %(default)s)')
    simulate.add_argument('--force', action='store_true', help='replace the run in DIR')
    simulate.add_argument('--no-twin', action='store_true', help='leave out the zero-delay twin')

    predict = verbs.add_parser('predict', help='predict drift and position error',
                               description='Predict the mean drift and the position error by the '
                               'linear theory, without a simulation.')
    _settings(predict)

    demo = verbs.add_parser('demo', help='run the three nodes over DDS and show the result',
                            description='Start the three nodes, run them in lock-step, record '
                            'their topics into a bag and compare with the prediction.')
    demo.add_argument('-o', '--output', default='ins_sim_demo', metavar='DIR',
                      help='folder of bags and figures, replaced (default: %(default)s)')
    demo.add_argument('--recording', metavar='CSV', default=None, help='recorded flight of the '
                      'second part (default: the closed-form cruise)')
    demo.add_argument('--start', type=float, default=1000.0, metavar='S', help='where in the '
                      'recording to start, s after its first row (default: %(default)s)')
    demo.add_argument('--duration', type=float, default=3600.0, metavar='S',
                      help='simulated length of each part, s (default: %(default)s)')

    dtg = verbs.add_parser('dtg-study', help='the tables and figures of the tuned-gyro paper',
                           description='Recover a rocking base through two dynamically tuned '
                           'gyros as the paper does, and compare with what it prints.')
    dtg.add_argument('--params-file', action='append', default=[], metavar='FILE',
                     help='parameter file of one table, or the name of a shipped one; may be '
                     'repeated (default: dtg_study_frequency and dtg_study_speed)')
    dtg.add_argument('-p', '--param', action='append', default=[], metavar='NAME:=VALUE',
                     help='one parameter, for every table')
    dtg.add_argument('-o', '--output', default='ins_sim_dtg_study', metavar='DIR',
                     help='folder of the figures (default: %(default)s)')

    dtg_report = verbs.add_parser('dtg-report', help='roots, bandwidth and margin of a tuned gyro',
                                  description='Show what the tuned gyros of gyro.dtg.* are good '
                                  'for: roots, time constant, bandwidth, stability margin and the '
                                  'steps that RK4 allows.')
    _settings(dtg_report)

    orientation = verbs.add_parser('compare-orientation', help='the orientation algorithms on one '
                                   'run', description='Navigate one offline run by quaternion, '
                                   'Poisson\'s equation and Euler vector, and compare them.')
    _settings(orientation)

    allan = verbs.add_parser('allan', help='Allan deviation of a record or of simulated noise',
                             description='Show Allan deviations and the noise coefficients '
                             'fitted to them: of a run of "simulate", of the Imu messages of a '
                             'bag, or, without SOURCE, of the instrument of the parameters '
                             'simulated at rest.')
    allan.add_argument('source', nargs='?', default=None, metavar='SOURCE',
                       help='folder of a run or of a rosbag2 bag')
    _settings(allan)
    allan.add_argument('--topic', default=None, metavar='NAME',
                       help='topic of the bag, where it has more than one of sensor_msgs/msg/Imu')
    allan.add_argument('--duration', type=float, default=None, metavar='S',
                       help='length of the simulated record, s (default: 10800)')
    allan.add_argument('-o', '--output', default='ins_sim_allan', metavar='DIR',
                       help='folder of the two figures (default: %(default)s)')
    allan.add_argument('--force', action='store_true', help='replace the figures in DIR')
    return top


def _settings(verb):
    verb.add_argument('--params-file', action='append', default=[], metavar='FILE',
                      help='ROS parameter file, or the name of a shipped one such as motion_2; '
                      'may be repeated, later ones win')
    verb.add_argument('-p', '--param', action='append', default=[], metavar='NAME:=VALUE',
                      help='one parameter, for every node that knows it')


def main(arguments=None):
    """Run a verb; return the exit code: 0, 2 bad input, 1 a run that failed, 130 interrupted."""
    chosen = parser().parse_args(arguments)
    signal.signal(signal.SIGTERM, _interrupt)
    warnings.showwarning = lambda sentence, *_: print(f'ins_sim {chosen.verb}: {sentence}',
                                                      file=sys.stderr)
    try:
        # the verbs import what they need: "ins_sim --help" stays instant
        verb = import_module(f'ins_sim.cli.{chosen.verb.replace("-", "_")}')
        return verb.run(chosen)
    except (ValueError, OSError) as error:
        print(f'ins_sim {chosen.verb}: {error}', file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f'ins_sim {chosen.verb}: interrupted; nothing was written', file=sys.stderr)
        return 130


def _interrupt(number, frame):
    """End as Ctrl-C does: verbs clean up after KeyboardInterrupt."""
    raise KeyboardInterrupt


if __name__ == '__main__':
    sys.exit(main())
