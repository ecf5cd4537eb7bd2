"""A recorded navigation: notes and tables for a terminal, figure, numbers and arrays on disk."""

from dataclasses import asdict
import json
import math

import numpy as np
from rich.table import Table

from ins_sim import parameter_files
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.navigation.errors import position_error
from ins_sim.core.postprocessing.comparison import error_rows
from ins_sim.core.postprocessing.reference import SampledTrack
from ins_sim.core.timeseries.histories import NavStates
from ins_sim.core.timeseries.named_columns import columns
from ins_sim.io.csv_writer import write_rows
from ins_sim.settings.place import Datum
from .console import PlainConsole
from .files.packed_arrays import write_arrays
from .files.tables import write_tables
from .files.trajectories import write_trajectories
from .plotting import new_figure, save_png, thinned
from .table import number_text

MARK = 'nav.npz'
OTHERS = ('tab:orange', 'tab:purple')
COLUMNS = (('after_s', 'after [s]'), ('horizontal_m', 'horizontal [m]'),
           ('vertical_m', 'up [m]'), ('speed_m_s', 'velocity [m/s]'), ('tilt_deg', 'tilt [deg]'),
           ('heading_deg', 'heading [deg]'))


def _span(result):
    return int(result.states[0].t_ns[0]), int(result.states[-1].t_ns[-1])


def show_navigation(title, result, console=None):
    """Print the notes of a Navigation and a table of errors for each reference."""
    console = console or PlainConsole()
    for note in result.notes:
        console.print(f'* {note}')
    start_ns, end_ns = _span(result)
    length_s = sum(int(s.t_ns[-1] - s.t_ns[0]) for s in result.states) * 1e-9
    console.print(f'* navigated {length_s:.3f} s in {len(result.states)} segment(s)')
    if not result.comparisons:
        console.print('* no reference: nothing to compare with')
    for comparison in result.comparisons:
        table = Table(title=f'{title} less {comparison.name}')
        for _, head in COLUMNS:
            table.add_column(head, justify='right')
        for row in error_rows(comparison, start_ns, end_ns):
            table.add_row(*(number_text(getattr(row, name)) for name, _ in COLUMNS))
        console.print(table)


def write_navigation(work, settings, title, result, csv=False, tum=False):
    """
    Write a Navigation into a folder.

    nav.npz holds states_<field> and, for reference k, error_<k>_<kind>_t_ns and
    error_<k>_<kind> (SI); summary.json the figures, the notes and the rows of the tables. csv:
    also states.csv and error_<k>_<kind>.csv; tum: also ins.tum, in the plane tangent at the first
    position.
    """
    start_ns, end_ns = _span(result)
    states = NavStates.concatenate(result.states)
    arrays = {f'states_{name}': values for name, values in states.arrays().items()}
    arrays['segment_start_ns'] = np.array([s.t_ns[0] for s in result.states])
    if csv:
        write_tables(work, {'states': states})
    for k, comparison in enumerate(result.comparisons):
        for kind in ('position', 'velocity', 'attitude'):
            track = getattr(comparison, kind)
            if track is not None:
                arrays[f'error_{k}_{kind}_t_ns'] = track.t_ns
                arrays[f'error_{k}_{kind}'] = track.values
                if csv:
                    write_rows(work / f'error_{k}_{kind}.csv', ('t_ns', *columns(
                        kind, track.values)), [(track.t_ns, *track.values.T)])
    write_arrays(work / MARK, arrays)
    if tum:
        datum = Datum(math.degrees(states.lat[0]), math.degrees(states.lon[0]), states.height[0])
        write_trajectories(work, MapFrame(datum, True), {'ins': states})
    summary = {'recording': title, 'start_ns': start_ns, 'end_ns': end_ns,
               'figures': result.figures, 'notes': result.notes,
               'errors': {c.name: [asdict(r) for r in error_rows(c, start_ns, end_ns)]
                          for c in result.comparisons}}
    (work / 'summary.json').write_text(json.dumps(summary, indent=1) + '\n', encoding='utf-8')
    (work / 'parameters.yaml').write_text(
        parameter_files.dump_nodes({'navigate': settings}), encoding='utf-8')
    save_figure(work / 'navigation.png', title, result)


def save_figure(path, title, result):
    """Save the way and the errors over time as PNG."""
    figure = new_figure(13, 9)
    grid = figure.add_gridspec(3, 2)
    way = figure.add_subplot(grid[:, 0])
    first = result.states[0]
    start_ns, origin = int(first.t_ns[0]), (first.lat[0], first.lon[0], first.height[0])
    tracks = [('solution', SampledTrack(s.t_ns, np.stack([s.lat, s.lon, s.height], axis=-1)))
              for s in result.states]
    end_ns = _span(result)[1]
    for reference in result.references:
        track = reference.position
        if track is not None:
            inside = (track.t_ns >= start_ns) & (track.t_ns <= end_ns)
            tracks.append((reference.name, SampledTrack(track.t_ns[inside], track.values[inside])))
    for k, (name, track) in enumerate(tracks):
        place = np.array([position_error(*p, *origin) for p in thinned(track.values).tolist()])
        if len(place):
            own = k < len(result.states)
            way.plot(place[:, 0], place[:, 1], lw=1.2, label=None if own and k else name,
                     color='tab:blue' if own else OTHERS[k - len(result.states)])
    way.plot(0.0, 0.0, 'ko', ms=5, label='start')
    way.set(xlabel='east [m]', ylabel='north [m]')
    way.axis('equal')
    panels = (('position', 'position error [m]', 1.0), ('velocity', 'velocity error [m/s]', 1.0),
              ('attitude', 'attitude error [deg]', np.degrees(1.0)))
    for row, (kind, label, unit) in enumerate(panels):
        axes = figure.add_subplot(grid[row, 1])
        for comparison, style in zip(result.comparisons, ('-', '--', ':')):
            track = getattr(comparison, kind)
            if track is None:
                continue
            t_s = (thinned(track.t_ns) - start_ns) * 1e-9
            values = thinned(track.values) * unit
            axes.plot(t_s, np.hypot(values[:, 0], values[:, 1]), style, color='tab:red',
                      label=f'{"tilt" if kind == "attitude" else "horizontal"}, '
                            f'{comparison.name}')
            axes.plot(t_s, values[:, 2], style, color='tab:green',
                      label=f'{"about up" if kind == "attitude" else "up"}, {comparison.name}')
        axes.set_ylabel(label)
        axes.grid(alpha=0.3)
        if axes.lines:
            axes.legend(loc='best', fontsize='x-small')
        else:
            axes.text(0.5, 0.5, 'no reference', ha='center', va='center',
                      transform=axes.transAxes)
    axes.set_xlabel('time since the start [s]')
    way.grid(alpha=0.3)
    way.legend(loc='best', fontsize='small')
    figure.suptitle(title)
    save_png(figure, path)
