"""Verb simulate: an offline run, written into a folder."""

from pathlib import Path

from rich.console import Console
from rich.progress import Progress, TextColumn, BarColumn, TimeRemainingColumn

from . import settings as chosen_settings
from ..bags.motions import make_motion
from ..core.prediction import NoPrediction, predict
from ..core.simulation import simulate
from ..report import storage, summary, table


def run(chosen):
    """Run, write and show; return the exit code."""
    settings = chosen_settings.read(chosen)
    storage.check_free(chosen.output, chosen.force)
    write_bag = _bag_writer(chosen, settings)
    title = chosen_settings.title(settings)
    console = Console()
    motion = make_motion(settings.motion_generator)
    try:
        prediction = predict(settings, motion)
    except NoPrediction as reason:
        prediction = None
        console.print(str(reason))
    with Progress(TextColumn('simulating'), BarColumn(), TextColumn('{task.percentage:>3.0f} %'),
                  TimeRemainingColumn(), console=console, transient=True) as progress:
        task = progress.add_task('', total=1.0)
        result = simulate(settings, not chosen.no_twin,
                          lambda done: progress.update(task, completed=done), motion)
    rows = summary.rows(settings, result.errors, result.twin, prediction)
    storage.write(chosen.output, settings, result, rows, prediction, title, chosen.force)
    table.show(title, rows, console)
    for line in (*summary.gaps(result.faults), *summary.parity(settings.imu_sensor, result.imu)):
        console.print(line)
    console.print(f'written: {chosen.output}')
    if write_bag is not None:
        write_bag(result, console)
    return 0


def _bag_writer(chosen, settings):
    """Return the function that writes the bag of a run, or None; ValueError before the run."""
    if chosen.bag is None:
        for name in ('topics', 'storage', 'compression'):
            if getattr(chosen, name) not in (None, 'mcap', 'none'):
                raise ValueError(f'--{name} is given without --bag; expected the folder of a bag')
        return None
    from ..bags import bag_writer, digest, simulated
    wanted = simulated.select(settings, chosen.topics)
    bag_writer.check(chosen.bag, chosen.storage, chosen.compression, chosen.force)

    def write_bag(result, console):
        counts = simulated.write(chosen.bag, settings, result, wanted, chosen.storage,
                                 chosen.compression, chosen.force)
        console.print(f'written: {chosen.bag} with {sum(counts.values())} messages on '
                      f'{len(counts)} topics')
        for file in sorted(Path(chosen.bag).glob(f'{Path(chosen.bag).name}_*')):
            console.print(f'SHA-256 of {file.name}: {digest.file_digest(file)}', soft_wrap=True)
        console.print(f'SHA-256 of the messages: {digest.payload_digest(chosen.bag)}',
                      soft_wrap=True)

    return write_bag
