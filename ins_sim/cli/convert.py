"""Verb convert: a recorded flight or IMU between CSV and bag."""

from . import arguments

HELP = 'a flight or an IMU from CSV to a bag, or back'
DESCRIPTION = ('Write a bag of truth from a recorded flight (CSV) at rate_hz, or of '
               'sensor_msgs/Imu from the CSV file of an IMU; or such a CSV file, plain or gzip, '
               'from a bag.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('source', metavar='SOURCE', help='CSV file (.csv, .csv.gz), or bag')
    parser.add_argument('target', metavar='TARGET', help='folder of the bag, or CSV file')
    arguments.add_settings(parser)
    parser.add_argument('--topic', default=None, metavar='NAME', help='topic of the bag: an Imu, '
                        'or the Odometry of a truth (default: truth/odometry if there is one, '
                        'else the only Imu; to a bag: imu/data_raw)')
    arguments.add_storage(parser)
    arguments.add_force(parser, 'TARGET')


def run(chosen):
    """Convert and say what was written; return the exit code."""
    from ins_sim.report.console import PlainConsole
    from ins_sim.io.convert import convert_recording
    from ins_sim import parameter_files
    from ins_sim.settings.by_node import ALL_NODES, NODES
    from ins_sim.settings.recorded_imu import CONVERT
    settings = parameter_files.read_nodes(
        arguments.parameter_paths(chosen), chosen.param,
        {'motion_generator': NODES['motion_generator'], **CONVERT}, {**ALL_NODES, **CONVERT})
    written = convert_recording(chosen.source, chosen.target, settings['motion_generator'],
                                chosen.topic, chosen.storage, chosen.compression, chosen.force,
                                settings['convert'])
    PlainConsole().print(f'written: {written}')
    return 0
