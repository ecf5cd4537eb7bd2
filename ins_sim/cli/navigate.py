"""Verb navigate: the strapdown over a recorded IMU, written into a folder."""

from rich.console import Console

from ins_sim import parameter_files, resources
from ins_sim.core.postprocessing.navigate import navigate
from ins_sim.io import imu
from ins_sim.report import navigation, storage
from ins_sim.settings.navigate import NAVIGATE
from . import arguments
from .progress import ProgressBar

DESCRIPTION = ('Run the strapdown over the sensor_msgs/Imu of a rosbag2 bag, or a CSV file of an '
               'IMU, from a self-alignment or given values, and compare it with a reference.')


def add_arguments(parser):
    """Add the arguments of the verb."""
    parser.add_argument('recording', metavar='BAG', help='rosbag2 bag (folder or file), or CSV '
                        'file with the columns t_s, gx_rps, gy_rps, gz_rps, ax_mps2, ay_mps2, '
                        'az_mps2')
    arguments.add_settings(parser)
    parser.add_argument('-o', '--output', default='ins_sim_navigation', metavar='DIR',
                        help='folder of the solution (default: %(default)s)')
    parser.add_argument('--force', action='store_true', help='replace the solution in DIR')


def run(chosen):
    """Read, navigate, write and show; return the exit code."""
    paths = [resources.parameter_file(name) for name in chosen.params_file]
    settings = parameter_files.read_nodes(paths, chosen.param, NAVIGATE)['navigate']
    storage.check_free(chosen.output, chosen.force, navigation.MARK)
    sources = imu.read_imu(chosen.recording, settings)
    console = Console()
    with ProgressBar(console) as progress:
        result = navigate(settings, sources, progress.watch('navigating'))
    navigation.write(chosen.output, settings, sources.name, result, chosen.force)
    navigation.show(sources.name, result, console)
    console.print(f'written: {chosen.output}')
    return 0
