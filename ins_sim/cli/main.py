"""The command ``ins_sim``: each verb parses, calls and prints; nothing more."""

import argparse
from importlib import import_module
import signal
import sys
import warnings

from ins_sim import __version__
from ins_sim.settings.aided_navigator import FILTERS

ROS_ARGS = '--ros-args'
NODE_VERBS = ('record', 'play')


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
    simulate.add_argument('--aided', action='store_true', help='also run velocity meter, GNSS and '
                          'aided navigator on the same readings of the IMU')
    simulate.add_argument('--bag', metavar='DIR', default=None, help='also write the topics that '
                          'the nodes would publish into a rosbag2 bag')
    _storage(simulate)
    simulate.add_argument('--topics', nargs='+', metavar='TOPIC', default=None,
                          help='topics of the bag (default: all)')

    info = verbs.add_parser('info', help='what is in a bag', description='Show storage, topics, '
                            'counts, rates and times of a bag, and whether it is whole.')
    info.add_argument('bag', metavar='BAG', help='folder of the bag, or one of its files')

    convert = verbs.add_parser('convert', help='a flight or an IMU from CSV to a bag, or back',
                               description='Write a bag of truth from a recorded flight (CSV) at '
                               'rate_hz, or of sensor_msgs/Imu from the CSV file of an IMU; or '
                               'such a CSV file, plain or gzip, from a bag.')
    convert.add_argument('source', metavar='SOURCE', help='CSV file (.csv, .csv.gz), or bag')
    convert.add_argument('target', metavar='TARGET', help='folder of the bag, or CSV file')
    _settings(convert)
    convert.add_argument('--topic', default=None, metavar='NAME', help='topic of the bag: an Imu, '
                         'or the Odometry of a truth (default: truth/odometry if there is one, '
                         'else the only Imu; to a bag: imu/data_raw)')
    _storage(convert)
    convert.add_argument('--force', action='store_true', help='replace TARGET')

    _record(verbs)
    _play(verbs)

    predict = verbs.add_parser('predict', help='predict drift and position error',
                               description='Predict the mean drift and the position error by the '
                               'linear theory, without a simulation.')
    _settings(predict)

    navigate = verbs.add_parser('navigate', help='run the strapdown over a recorded IMU',
                                description='Run the strapdown over the sensor_msgs/Imu of a '
                                'rosbag2 bag, or a CSV file of an IMU, from a self-alignment or '
                                'given values, and compare it with a reference.')
    navigate.add_argument('recording', metavar='BAG', help='rosbag2 bag (folder or file), or CSV '
                          'file with the columns t_s, gx_rps, gy_rps, gz_rps, ax_mps2, ay_mps2, '
                          'az_mps2')
    _settings(navigate)
    navigate.add_argument('-o', '--output', default='ins_sim_navigation', metavar='DIR',
                          help='folder of the solution (default: %(default)s)')
    navigate.add_argument('--force', action='store_true', help='replace the solution in DIR')

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

    filters = verbs.add_parser('compare-filters', help='all filters of the aided navigator over '
                               'the same flights', description='Fly the filters of the aided '
                               'navigator over the same flights and seeds, on all cores, and show '
                               'table and figure.')
    _settings(filters, 'route_flight and grade_mid')
    filters.add_argument('--runs', type=int, default=24, metavar='N', help='flights, each with '
                         'seeds of its own (default: %(default)s)')
    filters.add_argument('--filters', nargs='+', choices=FILTERS, default=None, metavar='NAME',
                         help=f'of {", ".join(FILTERS)} (default: all)')
    filters.add_argument('--cycles', nargs='+', type=int, default=None, metavar='N',
                         help='cycles of a fix: the first for all filters, the others for eskf as '
                         'well (default: window.cycles)')
    filters.add_argument('--jobs', type=int, default=0, metavar='N', help='processes (default: '
                         'as many as cores)')
    filters.add_argument('-o', '--output', default='ins_sim_filters', metavar='DIR',
                         help='folder of figure and numbers (default: %(default)s)')
    filters.add_argument('--force', action='store_true', help='replace what is in DIR')

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


def _record(verbs):
    record = verbs.add_parser('record', help='record live topics into a bag',
                              description='Record live topics into a rosbag2 bag, until Ctrl-C. '
                              'Behind --ros-args stand remappings and the namespace.')
    record.add_argument('topics', nargs='*', metavar='TOPIC', help='topic to record; one that is '
                        'not there yet is waited for')
    record.add_argument('--all', action='store_true', help='record every topic')
    record.add_argument('-o', '--output', default='ins_sim_bag', metavar='DIR',
                        help='folder of the bag (default: %(default)s)')
    record.add_argument('--force', action='store_true', help='replace the bag in DIR')
    record.add_argument('--storage', choices=('mcap', 'sqlite3'), default='mcap',
                        help='storage of the bag (default: %(default)s)')
    record.add_argument('--compression', choices=('none', 'lz4', 'zstd'), default='none',
                        help='compression of its chunks, of mcap (default: %(default)s)')
    record.add_argument('--max-size', type=float, default=0.0, metavar='MB',
                        help='begin another file where one is as large')
    record.add_argument('--max-duration', type=float, default=0.0, metavar='S',
                        help='begin another file where one spans as much')
    record.add_argument('--log-time', choices=('stamp', 'received'), default='stamp',
                        help='log a message at the stamp of its header, or when it came '
                        '(default: %(default)s)')


def _play(verbs):
    play = verbs.add_parser('play', help='publish the topics of a bag',
                            description='Publish the messages of a rosbag2 bag as they were '
                            'recorded. Behind --ros-args stand remappings and the namespace.')
    play.add_argument('bag', metavar='BAG', help='folder of the bag, or one of its files')
    play.add_argument('--topics', nargs='+', metavar='TOPIC', default=None,
                      help='topics to publish (default: all)')
    play.add_argument('--rate', type=float, default=None, metavar='FACTOR', help='bag time per '
                      'time; 0 = as fast as the consumers of --lock-step (default: 1, and 0 in '
                      'lock-step)')
    play.add_argument('--start', type=float, default=0.0, metavar='S', help='start this long '
                      'after the first message')
    play.add_argument('--duration', type=float, default=None, metavar='S',
                      help='play this much of the bag')
    play.add_argument('--loop', action='store_true', help='begin again at the end')
    play.add_argument('--wait', type=float, default=1.0, metavar='S', help='wait at most this '
                      'long for a reader of every topic, not in lock-step (default: %(default)s)')
    play.add_argument('--clock', nargs='?', type=float, const=100.0, default=None, metavar='HZ',
                      help='publish the time of the bag on /clock, by default 100 times a second')
    play.add_argument('--lock-step', nargs='+', default=(), metavar='NODE', help='go no further '
                      'than these nodes acknowledge, such as strapdown')
    play.add_argument('--window', type=int, default=200, metavar='N', help='unanswered samples '
                      'allowed in lock-step (default: %(default)s)')
    play.add_argument('--timeout', type=float, default=30.0, metavar='S', help='wall time without '
                      'an acknowledgement before the missing node is named (default: '
                      '%(default)s)')


def _settings(verb, default=''):
    verb.add_argument('--params-file', action='append', default=[], metavar='FILE',
                      help='ROS parameter file, or the name of a shipped one such as motion_2; '
                      'may be repeated, later ones win'
                      + (f' (default: {default})' if default else ''))
    verb.add_argument('-p', '--param', action='append', default=[], metavar='NAME:=VALUE',
                      help='one parameter, for every node that knows it')


def _storage(verb):
    verb.add_argument('--storage', choices=('mcap', 'sqlite3'), default='mcap',
                      help='storage of the bag (default: %(default)s)')
    verb.add_argument('--compression', choices=('none', 'lz4', 'zstd'), default='none',
                      help='compression of its chunks, of mcap (default: %(default)s)')


def main(arguments=None):
    """
    Run a verb; return the exit code: 0, 2 bad input, 1 a run that failed, 130 interrupted.

    The verbs that are nodes, record and play, have the exit codes of nodes.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    cut = words.index(ROS_ARGS) if ROS_ARGS in words else len(words)
    top = parser()
    chosen = top.parse_args(words[:cut])
    chosen.ros_args = words[cut:]
    if chosen.ros_args and chosen.verb not in NODE_VERBS:
        top.error(f'{chosen.verb} is no node; {ROS_ARGS} serves {" and ".join(NODE_VERBS)}')
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
        print(f'ins_sim {chosen.verb}: interrupted; only what is named above was written',
              file=sys.stderr)
        return 130


def _interrupt(number, frame):
    """End as Ctrl-C does: verbs clean up after KeyboardInterrupt."""
    raise KeyboardInterrupt


if __name__ == '__main__':
    sys.exit(main())
