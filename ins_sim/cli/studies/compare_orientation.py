"""Verb compare-orientation: compare the attitude algorithms on one run."""

import math

from .. import arguments

HELP = 'compare the attitude algorithms on one run'
DESCRIPTION = ("Navigate one offline run with the quaternion, Poisson's equation and the Euler "
               'vector, and show their errors and CPU times in one table.')


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    arguments.add_settings(parser)


def run(chosen):
    """Compare and show; return the exit code."""
    from rich.table import Table
    from ins_sim.core.attitude.integration import KINDS
    from ins_sim.io.motion import read_motion
    from ins_sim.report import summary, titles
    from ins_sim.report.console import PlainConsole
    from ins_sim.report.table import number_text
    from ins_sim.studies.orientation import compare_orientations
    from ..progress import progress_bars
    settings = arguments.read_settings(chosen)
    console = PlainConsole()
    with progress_bars(console, 'algorithms') as add_bar:
        results = compare_orientations(settings, read_motion(settings.motion_generator),
                                       add_bar('navigating', len(KINDS)))
    table = Table(title=titles.title(settings))
    table.add_column('figure')
    table.add_column('unit')
    for r in results:
        table.add_column(r.kind, justify='right')
    rows = [(f'mean drift {name}', 'deg/h',
             [r.drift[axis] * summary.DEG_PER_HOUR for r in results])
            for axis, name in enumerate(('east', 'north', 'up'))]
    rows += [(f'max |d{name}|', 'm', [r.position[axis] for r in results])
             for axis, name in ((1, 'N'), (0, 'E'))]
    rows.append(('angle from the quaternion', 'deg', [math.degrees(r.apart) for r in results]))
    rows.append(('CPU time per step', 'us', [1e6 * r.step_s for r in results]))
    for name, unit, values in rows:
        table.add_row(name, unit, *map(number_text, values))
    console.print(table)
    return 0
