"""Report of the tuned-gyro study after Sapegin, Romanov and Bugaiov (2016)."""

from dataclasses import dataclass

import numpy as np
from rich.table import Table

from ins_sim.settings.tuned_gyro import SWEEPS, TunedGyroStudySettings
from ..charts import palette
from ..charts.chart import (Chart, CIRCLE, Curve, DASHED, DOT, DOTTED, Level, Markers, Panel)
from ..page.content import Page, PageTable

METHODS = {'rk4': 'RK4', 'exact': 'matrix exponentials'}
# Part of the range of values that is left free on either side of a chart.
ROOM = 0.03


@dataclass(frozen=True)
class TunedGyroStudy:
    """
    One computed table of the study.

    Attributes
    ----------
    name : name of the parameter file
    settings : TunedGyroStudySettings
    cells : Cells of the table
    limits : rotor speeds, Hz, between which RK4 is stable (None: no limit on that side), or ()
        if they were not determined
    chart : Chart of the table
    """

    name: str
    settings: TunedGyroStudySettings
    cells: tuple
    limits: tuple
    chart: Chart


def study_title(settings):
    """Return a line with the constant conditions of TunedGyroStudySettings."""
    held = (f'rotors at {settings.rotor_speed_hz:g} Hz' if settings.sweep == 'base_rate' else
            f'base at {settings.base_rate_rad_s:g} rad/s')
    return (f'{settings.amplitude_deg:g} deg of roll, {held}, preset {settings.preset}, '
            f'{METHODS[settings.method]} at {settings.step_ms:g} ms')


def show_study(settings, cells, console):
    """Print the Cells of a table with the published values, if there are any."""
    compared = any(cell.paper_deg is not None for cell in cells)
    table = Table(title=study_title(settings))
    for head in (SWEEPS[settings.sweep], 'Poisson [deg]', 'Euler vector [deg]',
                 *(('paper [deg]', 'ours - paper') if compared else ())):
        table.add_column(head, justify='right')
    for cell in cells:
        row = [f'{cell.value:g}', f'{cell.poisson_deg:.4f}', f'{cell.euler_vector_deg:.4f}']
        if compared:
            row += [f'{cell.paper_deg:g}', f'{cell.poisson_deg - cell.paper_deg:+.4f}']
        table.add_row(*row)
    console.print(table)


def limits_sentence(settings, limits):
    """Return a sentence with the rotor speeds between which RK4 is stable (None: no limit)."""
    low, high = ('no limit' if limit is None else f'{limit:.1f}' for limit in limits)
    paper = settings.paper_limits_hz
    return (f'RK4 at {settings.step_ms:g} ms is stable from {low} to {high} Hz'
            + ('; published: {:g} to {:g} Hz'.format(*paper) if paper else ''))


def study_chart(name, settings, curve, cells, limits=()):
    """
    Return the Chart of the error of the amplitude over its cause.

    Parameters
    ----------
    name : name of the file
    settings : TunedGyroStudySettings
    curve : Cells of a dense sweep
    cells : Cells of the table; published values are drawn as points, differences in a lower panel
    limits : rotor speeds, Hz, at which the published algorithm becomes unstable
    """
    true_deg, cause = settings.amplitude_deg, SWEEPS[settings.sweep]
    values = np.array([c.value for c in curve])
    marks = [Curve(values, np.array([c.poisson_deg for c in curve]) - true_deg, 'simulated',
                   palette.BLUE)]
    printed = [c for c in cells if c.paper_deg is not None]
    panels = []
    if printed:
        paper = np.array([c.paper_deg for c in printed])
        ours = np.array([c.poisson_deg for c in printed])
        causes = np.array([c.value for c in printed])
        marks.append(Markers(causes, paper - true_deg, 'printed in the paper', palette.BLACK,
                             CIRCLE, 7.0))
        panels = [Panel((Level(y=0.0, colour=palette.BLACK),
                         Markers(causes, ours - paper, 'ours less the paper', palette.BLUE, DOT,
                                 7.0)), cause, 'difference [deg]')]
    for side, ours_hz, paper_hz in zip(('below', 'above'), limits or (None, None),
                                       settings.paper_limits_hz or (None, None)):
        if ours_hz is not None:
            marks.append(Level(x=ours_hz, label=f'RK4 is unstable {side} {ours_hz:.1f} Hz',
                               colour=palette.RED, dash=DASHED))
        if paper_hz is not None:
            marks.append(Level(x=paper_hz, label=f'in the paper {side} {paper_hz:g} Hz',
                               colour=palette.GREY, dash=DOTTED))
    lines = [mark.x for mark in marks if isinstance(mark, Level)]
    first, last = min([*values, *lines]), max([*values, *lines])
    room = ROOM * (last - first)
    top = Panel(tuple(marks), cause, 'error of the amplitude [deg]', height=2.0,
                x_range=(first - room, last + room))
    title = f'Roll of a rocking base through two tuned gyros: {study_title(settings)}'
    return Chart(name, title, (top, *panels))


def study_page(studies):
    """Return the Page of a list of TunedGyroStudy."""
    return Page(
        'Two dynamically tuned gyros on a rocking base, after Sapegin, Romanov and Bugaiov (2016)',
        ' '.join(_answer(study) for study in studies), tuple(study.chart for study in studies),
        tuple(_table(study) for study in studies),
        files={f'{study.name}.png': study.chart.title for study in studies})


def _answer(study):
    """Return a sentence about a table, and about the stability limits."""
    settings, cells = study.settings, study.cells
    worst = max(cells, key=lambda c: abs(c.poisson_deg - settings.amplitude_deg))
    what = SWEEPS[settings.sweep].partition(' [')[0]
    unit = SWEEPS[settings.sweep].partition('[')[2].rstrip(']')
    text = (f'A roll of {settings.amplitude_deg:g} deg is recovered as {worst.poisson_deg:.3f} '
            f'deg at a {what} of {worst.value:g} {unit}, the least accurate of {len(cells)} '
            'values')
    printed = [c for c in cells if c.paper_deg is not None]
    if printed:
        off = max(abs(c.poisson_deg - c.paper_deg) for c in printed)
        text += f'; the published values are reproduced within {off:.2g} deg'
    if study.limits:
        text += f'. {limits_sentence(settings, study.limits)}'
    return f'{text}.'


def _table(study):
    """Return the table of the Cells of a study."""
    heads = (SWEEPS[study.settings.sweep], 'Poisson [deg]', 'Euler vector [deg]', 'paper [deg]',
             'ours less paper [deg]')
    rows = tuple((f'{c.value:g}', f'{c.poisson_deg:.4f}', f'{c.euler_vector_deg:.4f}',
                  *(('-', '-') if c.paper_deg is None else
                    (f'{c.paper_deg:g}', f'{c.poisson_deg - c.paper_deg:+.4f}')))
                 for c in study.cells)
    return PageTable(f'Recovered amplitude: {study_title(study.settings)}', heads, rows,
                     f'Parameters: {study.name}.')
