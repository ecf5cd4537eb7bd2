"""Write the report of a run next to its data: figures, track and page."""

import math

import numpy as np

from ins_sim.jobs.fingerprint import array_digest
from .. import coverage
from ..charts.png import save_chart
from ..charts.scales import distance
from ..guided import guided_lines
from ..page.content import Page, PageTable
from ..page.html import REPORT, write_page
from ..summary import DEG_PER_HOUR, gap_lines, parity_lines, withheld_lines
from ..table import COLUMNS
from ..titles import length_words
from .error_charts import delay_chart, error_chart
from .kml import FILE, write_tracks
from .track import run_tracks, track_chart

# Descriptions of the files of a run.
FILES = {'run.npz': 'all arrays', 'summary.json': 'the table of this page',
         'parameters.yaml': 'every parameter; with it simulate repeats the run',
         'manifest.yaml': 'on which machines the numbers are the same to the last bit',
         'errors.png': 'the errors of the strapdown',
         'delays.png': 'the errors less those of the zero-delay twin',
         'aided.png': 'the aided solution', 'track.png': 'the track from above',
         FILE: 'the track for map programs', 'bag': 'the topics of the nodes'}
# Descriptions of the files that are written on request, by extension.
KINDS = {'.csv': 'a table with named columns', '.tum': 'a trajectory for evo'}
OBJECT = 'the motion was given as an object, which the settings do not describe'


def run_notes(settings, run, prediction, steered=None):
    """
    Return sentences on omissions, faults and assumptions of a run.

    Parameters
    ----------
    settings : SimulationSettings
    run : SimulationResult
    prediction : Prediction or None
    steered : GuidedResult of a guided motion, or None
    """
    lines = coverage.coverage_lines(settings, prediction)
    if prediction is not None and not np.any(prediction.largest) and (
            coverage.comparable(settings, prediction) is None):
        # All errors are those of the instruments, and the table has no predicted column.
        lines = []
    return [*lines, *guided_lines(steered), *gap_lines(run.faults), *withheld_lines(settings),
            *parity_lines(settings.imu_sensor, run.imu)]


def write_report(work, settings, run, rows, prediction, title, aided=None, notes=(),
                 own_motion=False):
    """
    Write the figures as PNG, the track as KML if the vehicle moves, and report.html.

    Parameters
    ----------
    work : folder (pathlib.Path) with the other files of the run
    rows : SummaryRows of the strapdown
    aided : ``aided.AidedReport`` or None
    notes : result of ``run_notes``

    The other parameters are those of ``storage.write_run``.
    """
    charts = [error_chart(title, run.errors, coverage.comparable(settings, prediction))]
    if run.twin is not None and coverage.instrument_errors(settings):
        # Without instrument errors the prediction of the run is that of the effect of the delays.
        charts.append(delay_chart(title, run.errors, run.twin,
                                  coverage.comparable_with_twin(settings, prediction)))
    tables = [_table(rows)]
    answer = _answer(run.errors)
    if aided is not None:
        # Imported lazily: the statistics of SciPy take as long to import as a short run.
        from .aided_page import report_answer, report_chart, report_notes, report_table
        answer = report_answer(aided)
        charts.insert(0, report_chart(title, aided))
        tables.insert(0, report_table(aided))
        notes = [*notes, *report_notes(aided)]
    tracks = run_tracks(run, aided and aided.flown)
    if tracks:
        charts.append(track_chart(title, tracks))
        write_tracks(work, title, tracks)
    for chart in charts:
        save_chart(work, chart)
    found = {path.name for path in work.iterdir()} - {REPORT}
    files = {name: what for name, what in FILES.items() if name in found}
    write_page(work, Page(
        title, answer, tuple(charts), tuple(tables),
        tuple([*notes, OBJECT] if own_motion else notes),
        aided.settings if aided else settings, {'the errors': array_digest(run.errors.arrays())},
        {**files, **requested(work)}))


def requested(work):
    """Return {name: description} of the files in a folder that were written on request."""
    return {path.name: KINDS[path.suffix] for path in sorted(work.iterdir())
            if path.suffix in KINDS}


def write_error_report(work, settings, errors, rows, prediction, title):
    """
    Write errors.png and report.html of a run if only its errors are known.

    ``work`` is a folder (pathlib.Path), ``errors`` are NavErrors; for the other parameters see
    ``write_report``.
    """
    chart = error_chart(title, errors, coverage.comparable(settings, prediction))
    save_chart(work, chart)
    found = {path.name for path in work.iterdir()}
    write_page(work, Page(
        title, _answer(errors), (chart,), (_table(rows),),
        tuple(coverage.coverage_lines(settings, prediction)), settings,
        {'the errors': array_digest(errors.arrays())},
        {name: what for name, what in FILES.items() if name in found}))


def _table(rows):
    """Return the PageTable of SummaryRows, without the columns that are empty."""
    columns = [c for c in COLUMNS if any(getattr(row, c[0]) is not None for row in rows)]
    return PageTable('Errors of the strapdown', ('figure', 'unit', *(head for _, head in columns)),
                     tuple((row.name, row.unit, *(getattr(row, name) for name, _ in columns))
                           for row in rows))


def _answer(errors):
    """Return the position error and the largest drift at the end, in a sentence."""
    last = len(errors) - 1
    east, north, up = errors.position[last].tolist()
    length = length_words((int(errors.t_ns[last]) - int(errors.t_ns[0])) * 1e-9)
    drift = errors.drift[last] * DEG_PER_HOUR
    axis = int(np.abs(drift).argmax())
    vertical = f' and {distance(abs(up))} {"above" if up > 0.0 else "below"} it' if up else ''
    return (f'After {length} the solution is {distance(math.hypot(east, north))} from the truth '
            f'horizontally ({distance(abs(north))} {"north" if north >= 0.0 else "south"}, '
            f'{distance(abs(east))} {"east" if east >= 0.0 else "west"}){vertical}; the mean '
            f'drift is largest about {("east", "north", "up")[axis]}, {drift[axis]:.3g} deg/h.')
