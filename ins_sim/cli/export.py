"""Verb export: write the description of the simulated IMU for another program."""

from . import arguments

HELP = 'write a file that describes the IMU to another program'
DESCRIPTION = ('Write the imu.yaml of Kalibr: noise densities and bias random walks of the '
               'simulated IMU, its topic and its rate.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('program', choices=('kalibr',), metavar='PROGRAM',
                        help='program that will read the file: %(choices)s')
    parser.add_argument('target', nargs='?', default='imu.yaml', metavar='FILE',
                        help='file to write (default: %(default)s)')
    arguments.add_settings(parser)
    parser.add_argument('--topic', default='/imu/data_raw', metavar='NAME',
                        help='topic of the Imu messages in the bags (default: %(default)s)')
    arguments.add_force(parser, 'FILE')


def run(chosen):
    """Write the file and print what was written; return the exit code."""
    from ins_sim.io.kalibr import export_kalibr
    from ins_sim.report.console import PlainConsole
    settings = arguments.read_settings(chosen)
    console = PlainConsole()
    for sentence in export_kalibr(chosen.target, settings.imu_sensor, chosen.topic, chosen.force):
        console.print(sentence)
    return 0
