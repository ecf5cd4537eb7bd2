"""Verb navigate: strapdown navigation with a recorded IMU, written into a folder."""

from . import arguments

HELP = 'navigate with a recorded IMU'
DESCRIPTION = ('Run the strapdown navigation with the sensor_msgs/Imu messages of a rosbag2 bag '
               'or with the CSV file of an IMU. It starts from an alignment or from given values '
               'and is compared with a reference, if there is one.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('recording', metavar='BAG', help='rosbag2 bag (folder or file), or CSV '
                        'file with the columns t_s, gx_rps, gy_rps, gz_rps, ax_mps2, ay_mps2, '
                        'az_mps2')
    arguments.add_settings(parser)
    arguments.add_output(parser, 'ins_sim_navigation', 'folder of the solution')
    arguments.add_force(parser, 'the solution in DIR')
    arguments.add_tables(parser)


def run(chosen):
    """Read, navigate, write and show; return the exit code."""
    from ins_sim import parameter_files
    from ins_sim.core.postprocessing.navigate import navigate
    from ins_sim.io import imu
    from ins_sim.own_folders.own_folder import whole_folder
    from ins_sim.report import navigation
    from ins_sim.report.console import PlainConsole
    from ins_sim.settings.navigate import NAVIGATE
    from .progress import progress_bars
    settings = parameter_files.read_nodes(arguments.parameter_paths(chosen), chosen.param,
                                          NAVIGATE)['navigate']
    console = PlainConsole()
    with whole_folder(chosen.output, chosen.force, navigation.MARK) as work:
        sources = imu.read_imu(chosen.recording, settings)
        with progress_bars(console) as add_bar:
            result = navigate(settings, sources, add_bar('navigating'))
        navigation.write_navigation(work, settings, sources.name, result, chosen.csv,
                                    chosen.tum)
    navigation.show_navigation(sources.name, result, console)
    console.print(f'written: {chosen.output}')
    return 0
