"""Verb simulate: an offline run, written into a folder."""

from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from ins_sim.core.prediction.drift import NoPrediction
from ins_sim.core.prediction.predict import predict
from ins_sim.core.simulation.aided import make_instruments, simulate_aided
from ins_sim.core.simulation.inertial import simulate
from ins_sim.io.motion import read_motion
from ins_sim.report import storage, summary, table
from . import settings as chosen_settings


def run(chosen):
    """Run, write and show; return the exit code."""
    settings, aided = chosen_settings.read_simulation(chosen)
    storage.check_free(chosen.output, chosen.force)
    write_bag = _bag_writer(chosen, settings)
    title = chosen_settings.title(settings)
    console = Console()
    motion = read_motion(settings.motion_generator)
    # Made before the run, so that settings that do not fit are refused before it.
    instruments = None if aided is None else make_instruments(aided)
    try:
        prediction = predict(settings, motion)
    except NoPrediction as reason:
        prediction = None
        console.print(str(reason))
    with Progress(TextColumn('{task.description}'), BarColumn(),
                  TextColumn('{task.percentage:>3.0f} %'), TimeRemainingColumn(),
                  console=console, transient=True) as progress:
        result = simulate(settings, motion, not chosen.no_twin, _watch(progress, 'simulating'))
        flown = None if aided is None else simulate_aided(aided, instruments, motion, result,
                                                          _watch(progress, 'aiding'))
    rows = summary.summary_rows(settings, result.errors, result.twin, prediction)
    report = None if aided is None else _report(aided, flown, result)
    storage.write(chosen.output, settings, result, rows, prediction, title, chosen.force, report)
    table.show(title, rows, console)
    for line in (*summary.gaps(result.faults), *summary.parity(settings.imu_sensor, result.imu)):
        console.print(line)
    if report is not None:
        report.show(console)
    console.print(f'written: {chosen.output}')
    if write_bag is not None:
        write_bag(result, console, None if aided is None else (aided, flown))
    return 0


def _watch(progress, name):
    """Return the function that shows a fraction done under a name."""
    task = progress.add_task(name, total=1.0)
    return lambda done: progress.update(task, completed=done)


def _report(settings, flown, result):
    from ins_sim.report import aided
    rows = aided.aided_rows(settings, flown, result.states, result.errors)
    return aided.AidedReport(settings, flown, rows)


def _bag_writer(chosen, settings):
    """Return the function that writes the bag of a run, or None; ValueError before the run."""
    if chosen.bag is None:
        for name in ('topics', 'storage', 'compression'):
            if getattr(chosen, name) not in (None, 'mcap', 'none'):
                raise ValueError(f'--{name} is given without --bag; expected the folder of a bag')
        return None
    from ins_sim.bags import bag_writer, digest
    from ins_sim.io import simulated
    wanted = simulated.select(settings, chosen.topics, chosen.aided)
    bag_writer.check(chosen.bag, chosen.storage, chosen.compression, chosen.force)

    def write_bag(result, console, aided):
        counts = simulated.write(chosen.bag, settings, result, wanted, chosen.storage,
                                 chosen.compression, chosen.force, aided=aided)
        console.print(f'written: {chosen.bag} with {sum(counts.values())} messages on '
                      f'{len(counts)} topics')
        for file in sorted(Path(chosen.bag).glob(f'{Path(chosen.bag).name}_*')):
            console.print(f'SHA-256 of {file.name}: {digest.file_digest(file)}', soft_wrap=True)
        console.print(f'SHA-256 of the messages: {digest.payload_digest(chosen.bag)}',
                      soft_wrap=True)

    return write_bag
