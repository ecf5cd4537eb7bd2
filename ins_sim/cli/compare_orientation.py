"""Verb compare-orientation: the orientation algorithms on one run, in one table."""

import math

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn
from rich.table import Table

from ins_sim.core.attitude.integration import KINDS
from ins_sim.io.motion import read_motion
from ins_sim.report.summary import DEG_PER_HOUR
from ins_sim.report.table import number
from ins_sim.studies.orientation import compare_orientations
from . import settings as chosen_settings


def run(chosen):
    """Compare and show; return the exit code."""
    settings = chosen_settings.read(chosen)
    console = Console()
    with Progress(TextColumn('navigating'), BarColumn(),
                  TextColumn('{task.completed:.0f} of {task.total:.0f} algorithms'),
                  console=console, transient=True) as progress:
        task = progress.add_task('', total=len(KINDS))
        results = compare_orientations(
            settings, read_motion(settings.motion_generator),
            lambda done: progress.update(task, completed=done))
    table = Table(title=chosen_settings.title(settings))
    table.add_column('figure')
    table.add_column('unit')
    for r in results:
        table.add_column(r.kind, justify='right')
    rows = [(f'mean drift {name}', 'deg/h', [r.drift[axis] * DEG_PER_HOUR for r in results])
            for axis, name in enumerate(('east', 'north', 'up'))]
    rows += [(f'max |d{name}|', 'm', [r.position[axis] for r in results])
             for axis, name in ((1, 'N'), (0, 'E'))]
    rows.append(('off the quaternion', 'deg', [math.degrees(r.apart) for r in results]))
    rows.append(('CPU of a step', 'us', [1e6 * r.step_s for r in results]))
    for name, unit, values in rows:
        table.add_row(name, unit, *map(number, values))
    console.print(table)
    return 0
