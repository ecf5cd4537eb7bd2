"""Verb simulate: an offline run, written into a folder."""

from rich.console import Console
from rich.progress import Progress, TextColumn, BarColumn, TimeRemainingColumn

from . import settings as chosen_settings
from ..core.prediction import NoPrediction, predict
from ..core.simulation import simulate
from ..report import storage, summary, table


def run(chosen):
    """Run, write and show; return the exit code."""
    settings = chosen_settings.read(chosen)
    storage.check_free(chosen.output, chosen.force)
    title = chosen_settings.title(settings)
    console = Console()
    try:
        prediction = predict(settings)
    except NoPrediction as reason:
        prediction = None
        console.print(str(reason))
    with Progress(TextColumn('simulating'), BarColumn(), TextColumn('{task.percentage:>3.0f} %'),
                  TimeRemainingColumn(), console=console, transient=True) as progress:
        task = progress.add_task('', total=1.0)
        result = simulate(settings, twin=not chosen.no_twin,
                          progress=lambda done: progress.update(task, completed=done))
    rows = summary.rows(settings, result.errors, result.twin, prediction)
    storage.write(chosen.output, settings, result, rows, prediction, title, chosen.force)
    table.show(title, rows, console)
    for line in (*summary.gaps(result.faults), *summary.parity(settings.imu_sensor, result.imu)):
        console.print(line)
    console.print(f'written: {chosen.output}')
    return 0
