"""Verb export: what other programs want to know of a simulated instrument."""

from . import arguments

HELP = 'a file about the instrument for another program'
DESCRIPTION = ('Write the imu.yaml of Kalibr: the noise densities and the random walks of the '
               'bias of the simulated IMU, its topic and its rate.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('program', choices=('kalibr',), metavar='PROGRAM',
                        help='the program that is to read the file: %(choices)s')
    parser.add_argument('target', nargs='?', default='imu.yaml', metavar='FILE',
                        help='file to write (default: %(default)s)')
    arguments.add_settings(parser)
    parser.add_argument('--topic', default='/imu/data_raw', metavar='NAME',
                        help='topic of the Imu in the bags (default: %(default)s)')
    arguments.add_force(parser, 'FILE')


def run(chosen):
    """Write and say what was written; return the exit code."""
    from ins_sim.io.kalibr import export_kalibr
    from ins_sim.report.console import PlainConsole
    settings = arguments.read_settings(chosen)
    console = PlainConsole()
    for sentence in export_kalibr(chosen.target, settings.imu_sensor, chosen.topic, chosen.force):
        console.print(sentence)
    return 0
