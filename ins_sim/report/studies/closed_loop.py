"""The study of the closed loop: its table, its limits and its figures."""

from dataclasses import dataclass
from itertools import cycle

from matplotlib import colormaps
import numpy as np
from rich import box
from rich.table import Table

from ins_sim.studies.closed_loop import QUIET_DEG
from ins_sim.studies.stability_map import MOST_K_Z
from ..plotting import new_figure, save_png


@dataclass(frozen=True)
class LoopRow:
    """
    One flight: half the range of beta, deg, and of z, m, over the last 30 %, and z at the end, m.

    frequency: rad/s, None where nothing oscillates; lateral: the same figures of the lateral
    channel alone, published: what is published of them, both by their names.
    """

    condition: str
    case: str
    k_z: float
    offset_m: float
    engage_s: float
    duration_s: float
    beta_deg: float
    frequency: float | None
    swing_m: float
    end_m: float
    lateral: dict
    published: dict


@dataclass(frozen=True)
class LimitRow:
    """Limit of k_z of a case: by the linear theory, its frequency, rad/s, and by flights."""

    case: str
    linear: float
    frequency: float
    flown: float


def loop_row(case, flight, lateral=None, condition=''):
    """Return the LoopRow of a LoopCase and its LoopFlight; lateral: that of the channel alone."""
    published = {} if case.published is None else {
        name: value for name, value in vars(case.published).items() if value is not None}
    return LoopRow(condition, case.label, case.k_z, case.offset_m, case.engage_s, case.duration_s,
                   **_figures(flight), lateral={} if lateral is None else _figures(lateral),
                   published=published)


def _figures(flight):
    quiet = flight.beta_deg < QUIET_DEG
    return {'beta_deg': flight.beta_deg, 'frequency': None if quiet else flight.frequency,
            'swing_m': flight.swing_m, 'end_m': float(flight.z[-1])}


def show_flights(title, rows, console):
    """Print the table of LoopRows: the whole chain, the lateral channel alone, and published."""
    table = Table(title=title, box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True,
                  caption='half the range of beta, deg, and of z, m, over the last 30 %; rad/s; z '
                  'at the end, m; second the same of the lateral channel alone, in brackets what '
                  f'is published (<{QUIET_DEG}: quiet)')
    if any(r.condition for r in rows):
        table.add_column('with')
    table.add_column('filter')
    for head in ('k_z', 'z0', 'engaged', 'beta', 'rad/s', 'z', 'z end'):
        table.add_column(head, justify='right')
    for r in rows:
        cells = [r.case, f'{r.k_z:g}', f'{r.offset_m:g}', f'{r.engage_s:g}',
                 *(_cell(r, name) for name in ('beta_deg', 'frequency', 'swing_m', 'end_m'))]
        table.add_row(*([r.condition] if any(q.condition for q in rows) else []), *cells)
    console.print(table)


def _cell(row, name):
    values = [getattr(row, name), *([row.lateral[name]] if row.lateral else [])]
    text = ' '.join('-' if value is None else f'{value:.3g}' for value in values)
    if name not in row.published:
        return text
    value = row.published[name]
    published = f'<{QUIET_DEG}' if name == 'beta_deg' and value == 0.0 else f'{value:g}'
    return f'{text} ({published})'


def show_limits(rows, console):
    """Print the limits of k_z by the linear theory and by flights of the whole chain."""
    table = Table(title='Limits of stability, k_z', box=box.SIMPLE_HEAD, pad_edge=False,
                  collapse_padding=True)
    table.add_column('filter')
    for head in ('linear', 'rad/s', 'flown', 'off'):
        table.add_column(head, justify='right')
    for r in rows:
        table.add_row(r.case, f'{r.linear:.4f}', f'{r.frequency:.3f}', f'{r.flown:.4f}',
                      f'{100.0 * (r.flown / r.linear - 1.0):+.2f} %')
    console.print(table)


def save_map(path, panels, curves):
    """Save the stability map: for each MapPanel its MapCurves."""
    figure = new_figure(12, 8)
    for axes, panel, found in zip(figure.subplots(2, 3, sharey=True).flat, panels, curves):
        axes.fill_between(found.gains, found.linear, MOST_K_Z, color='tab:red', alpha=0.12)
        axes.plot(found.gains, found.linear, color='black', lw=1.2, label='linear limit')
        for (start, limits), mark in zip(found.flown.items(), ('o', 'x')):
            axes.plot(found.gains, limits, mark, ms=5, mfc='none',
                      label=f'flown from z0 = {start:g} m')
        axes.set_xscale('log')
        axes.xaxis.set_major_formatter('{x:g}')
        axes.set_ylim(0.0, MOST_K_Z)
        axes.set_title(panel.label, fontsize='medium')
        axes.set_xlabel('K_v [1/s]' if panel.slides else
                        'K' if panel.kind == 'paper_corrected' else 'gain of a fix')
        axes.grid(which='both', alpha=0.3)
    figure.axes[min(2, len(panels) - 1)].legend(fontsize='small', loc='lower left')
    for row in figure.axes[::3]:
        row.set_ylabel('lateral scale error of the meter, k_z')
    figure.suptitle('Stability of the loop: unstable above (shaded)')
    save_png(figure, path)


def save_histories(path, title, names, flights):
    """Save sideslip and offset, dotted the estimated one, of LoopFlights with these names."""
    figure = new_figure(10, 8)
    top, bottom = figure.subplots(2, 1, sharex=True)
    for name, flight, colour in zip(names, flights, cycle(colormaps['tab20'].colors)):
        top.plot(flight.t_s, np.degrees(flight.beta), lw=0.9, color=colour)
        bottom.plot(flight.t_s, flight.z, lw=0.9, color=colour, label=name)
        bottom.plot(flight.t_s, flight.z_estimated, lw=0.9, ls=':', color=colour)
    top.set_ylabel('sideslip [deg]')
    bottom.set_ylabel('offset from the leg [m], dotted: estimated')
    bottom.set_xlabel('time [s]')
    for axes in (top, bottom):
        axes.grid(alpha=0.3)
    bottom.legend(fontsize='small', loc='best')
    figure.suptitle(title)
    save_png(figure, path)
