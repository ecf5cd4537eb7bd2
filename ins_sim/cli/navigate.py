"""Verb navigate: the strapdown over a recorded IMU, written into a folder."""

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from ins_sim import parameter_files, resources
from ins_sim.core.postprocessing.navigate import navigate
from ins_sim.io import imu
from ins_sim.report import navigation, storage
from ins_sim.settings.navigate import NAVIGATE


def run(chosen):
    """Read, navigate, write and show; return the exit code."""
    paths = [resources.parameter_file(name) for name in chosen.params_file]
    settings = parameter_files.read_nodes(paths, chosen.param, NAVIGATE)['navigate']
    storage.check_free(chosen.output, chosen.force, navigation.MARK)
    sources = imu.read_imu(chosen.recording, settings)
    console = Console()
    with Progress(TextColumn('navigating'), BarColumn(), TextColumn('{task.percentage:>3.0f} %'),
                  TimeRemainingColumn(), console=console, transient=True) as progress:
        task = progress.add_task('', total=1.0)
        result = navigate(settings, sources, lambda done: progress.update(task, completed=done))
    navigation.write(chosen.output, settings, sources.name, result, chosen.force)
    navigation.show(sources.name, result, console)
    console.print(f'written: {chosen.output}')
    return 0
