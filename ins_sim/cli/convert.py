"""Verb convert: convert a recorded flight or IMU from CSV to a bag, or back."""

from . import arguments

HELP = 'convert a recorded flight or IMU from CSV to a bag, or back'
DESCRIPTION = ('Convert a recorded flight (CSV) to a bag with truth messages at rate_hz, or the '
               'CSV file of an IMU to a bag with sensor_msgs/Imu messages; or convert such a bag '
               'to a CSV file, plain or gzip.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('source', metavar='SOURCE', help='CSV file (.csv, .csv.gz), or bag')
    parser.add_argument('target', metavar='TARGET', help='folder of the bag, or CSV file')
    arguments.add_settings(parser)
    parser.add_argument('--topic', default=None, metavar='NAME', help='topic of the bag, with '
                        'Imu or truth Odometry messages (default: truth/odometry if it exists, '
                        'else the only Imu topic; when writing a bag: imu/data_raw)')
    arguments.add_storage(parser)
    arguments.add_force(parser, 'TARGET')


def run(chosen):
    """Convert and print what was written; return the exit code."""
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
