"""Report of the navigation on a recording: terminal output, figures, page and arrays."""

from dataclasses import asdict
import json
import math

import numpy as np
from rich.table import Table

from ins_sim import parameter_files
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.postprocessing.comparison import error_rows
from ins_sim.core.timeseries.histories import NavStates
from ins_sim.core.timeseries.named_columns import columns
from ins_sim.io.csv_writer import write_rows
from ins_sim.settings.place import Datum
from .charts.png import save_chart
from .charts.scales import amount, LENGTHS, TIMES
from .console import PlainConsole
from .files.packed_arrays import write_arrays
from .files.tables import write_tables
from .files.trajectories import write_trajectories
from .navigation_charts import navigation_charts, navigation_tracks
from .page.content import Page, PageTable
from .page.html import write_page
from .runs.kml import FILE, write_tracks
from .runs.page import requested
from .table import number_text

MARK = 'nav.npz'
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

    nav.npz contains states_<field> and, for reference k, error_<k>_<kind>_t_ns and
    error_<k>_<kind> (SI units); summary.json contains the results, the notes and the rows of the
    tables. With ``csv`` also states.csv and error_<k>_<kind>.csv are written; with ``tum`` also
    ins.tum, in the plane tangent at the first position.
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
    charts = navigation_charts(title, result, settings.gap_factor)
    for chart in charts:
        save_chart(work, chart)
    write_tracks(work, title, navigation_tracks(result))
    write_page(work, _page(title, settings, result, charts, requested(work)))


def _page(title, settings, result, charts, files):
    """Return the Page of a navigation; ``files`` are those written on request."""
    start_ns, end_ns = _span(result)
    tables = tuple(
        PageTable(f'Solution less {c.name}', tuple(head for _, head in COLUMNS),
                  tuple(tuple('-' if value is None else value
                              for value in (getattr(row, name) for name, _ in COLUMNS))
                        for row in error_rows(c, start_ns, end_ns)))
        for c in result.comparisons)
    return Page(f'Navigation on the recording {title}', _answer(result), charts, tables,
                tuple(result.notes), settings,
                files={MARK: 'the solution and its errors (numpy.load)',
                       'summary.json': 'figures, notes and errors',
                       'parameters.yaml': 'every setting; with it navigate repeats the run',
                       **{f'{chart.name}.png': chart.title for chart in charts},
                       FILE: 'the track for map programs', **files})


def _answer(result):
    """Return a sentence about the error at the end of a Navigation."""
    start_ns, end_ns = _span(result)
    length = amount(TIMES, (end_ns - start_ns) * 1e-9)
    if not result.comparisons:
        return (f'The strapdown navigated for {length}. There is no reference to compare it '
                'with.')
    sentences = []
    for comparison in result.comparisons:
        end = error_rows(comparison, start_ns, end_ns)[-1]
        words = []
        if end.horizontal_m is not None:
            words.append(f'{amount(LENGTHS, end.horizontal_m)} horizontally')
        if end.speed_m_s is not None:
            words.append(f'{end.speed_m_s:.3g} m/s in horizontal velocity')
        if end.heading_deg is not None:
            words.append(f'{abs(end.heading_deg):.3g} deg in heading')
        sentences.append(
            f'After {length} the solution differs by {", ".join(words)} from {comparison.name}.'
            if words else f'{comparison.name} ends before the solution does.')
    return ' '.join(sentences)
