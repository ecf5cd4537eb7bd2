"""Tables, sentences and the page of the study of delays."""

import numpy as np
from rich.table import Table

from ins_sim.core.numerics.units import DEG_PER_HOUR
from ins_sim.core.prediction.drift import two_axis_resonances
from ins_sim.studies.delays.maps import delays_s, TwoAxisDrift
from ..page.content import Page, PageTable
from ..table import number_text
from . import delay_names as names
from .delay_charts import figure_charts
from .delay_data import all_runs, ARCMIN, published

ENU = ('east', 'north', 'up')
# A smaller drift is a rounding error and is shown as 0, deg/h.
ROUNDING = 1e-9
# Largest error of a run without delays if the IMU samples the motion often enough, m.
CLOSED = 0.01
TITLE = 'Delays of gyro channels: the study of Bogdanov and Fomichev (2018)'
NO_CURVES = ('The paper gives no data for its curves, so they are not drawn; '
             'the numbers that it states are in the tables.')


def study_tables(results):
    """Return the PageTables of FigureResults."""
    runs = all_runs(results)
    tables = [_drifts(runs), _positions(runs)]
    ends = [run for run in runs
            if run.settings.motion_generator.motion.kind == 'two_axis']
    if ends:
        tables.append(_ends(ends))
    tables += [_resonances(result) for result in results
               if result.figure.shows.figure == 'rates']
    tables += [_by_channel(result) for result in results
               if result.figure.shows.figure == 'flight']
    return tables


def _drifts(runs):
    rows = []
    for run in runs:
        axis = _axis(run, runs)
        drift, _ = published(run)
        rows.append((names.run_name(run.settings), ENU[axis],
                     *(_drift_text(figures.drift[axis])
                       for figures in (run.prediction, run.measured, run.twin)),
                     number_text(drift and drift[axis])))
    return PageTable('Drift of the attitude',
                     ('run', 'axis', 'predicted [deg/h]', 'measured [deg/h]',
                      'without delays [deg/h]', 'published [deg/h]'), tuple(rows),
                     'The least-squares slope of the largest component of the inertial attitude '
                     'error. The error of a detuned run oscillates; its slope applies to the part '
                     'of the oscillation within the run.')


def _drift_text(drift):
    """Return a drift (rad/s) as text in deg/h; values at the level of rounding become 0."""
    return number_text(DEG_PER_HOUR * drift if abs(drift) * DEG_PER_HOUR >= ROUNDING else 0.0)


def _axis(run, runs):
    """Return the axis of the largest drift of a run; for rocking, of all runs that rock."""
    kind = run.settings.motion_generator.motion.kind
    if kind != 'rocking':
        return int(np.argmax(np.abs(run.prediction.drift)))
    return int(np.argmax(np.max([np.abs(other.prediction.drift) for other in runs
                                 if other.settings.motion_generator.motion.kind == kind], axis=0)))


def _positions(runs):
    rows = []
    for run in runs:
        _, place = published(run)
        rows.append((names.run_name(run.settings),
                     *(_pair(figures.largest[[1, 0]])
                       for figures in (run.prediction, run.measured)),
                     f'{run.twin.largest[:2].max():.2g}', '-' if place is None else _pair(place)))
    return PageTable('Largest position error, north / east',
                     ('run', 'predicted [m]', 'measured [m]', 'without delays [m]',
                      'published [m]'), tuple(rows),
                     'Measured: the run less the same run without delays.')


def _pair(values):
    return ' / '.join(f'{value:.5g}' for value in values)


def _ends(runs):
    rows = tuple((names.run_name(run.settings), *(f'{x:.5f}' for x in ARCMIN * run.angles[-1]))
                 for run in runs)
    return PageTable('Error of motion 2 at the end, computed less true',
                     ('run', 'latitude [arcmin]', 'longitude [arcmin]'), rows)


def _resonances(result):
    settings, found = result.figure.simulation, result.map
    drift = TwoAxisDrift(settings)
    gamma = settings.motion_generator.motion.two_axis.gamma_rate_rad_s
    rows = tuple((name, number_text(rate), number_text(DEG_PER_HOUR * np.hypot(*formula[:2])),
                  number_text(DEG_PER_HOUR * abs(drift.mean(rate, gamma))))
                 for name, rate, formula in two_axis_resonances(
                     settings.motion_generator.motion, delays_s(settings)))
    note = '' if found.half_width is None else (
        f'Over {found.span_s:g} s the drift is half as high at a detuning of '
        f'{found.half_width:.4g} rad/s.')
    return PageTable(f'Resonances of {names.motion_name(settings)}',
                     ('line', "psi' [rad/s]", 'equation (19) [deg/h]',
                      f'mean over {found.span_s:g} s [deg/h]'), rows, note)


def _by_channel(result):
    run, = result.runs
    sensitivity, ways = run.sensitivity, ((1, 'north'), (0, 'east'))
    rows = [(f'{way} error at the end', 'm/us', *_numbers(sensitivity.position[-1, k]))
            for k, way in ways]
    rows += [(f'largest {way} error', 'm/us', *_numbers(sensitivity.largest[k]))
             for k, way in ways]
    rows += [(f'drift {name}', 'deg/h/us', *_numbers(DEG_PER_HOUR * sensitivity.drift[k]))
             for k, name in enumerate(ENU)]
    return PageTable(f'One microsecond of delay of one gyro: {names.motion_name(run.settings)}',
                     ('figure', 'unit', 'x', 'y', 'z'), tuple(rows),
                     'Multiply each column by the delay of its gyro and add the three: this gives '
                     'error and drift for any three delays. The sum of the largest errors is an '
                     'upper bound.')


def _numbers(per_s):
    return (f'{1e-6 * value:.4g}' for value in per_s)


def answer(results):
    """Return the result in a few sentences."""
    runs = all_runs(results)
    bench = [run for run in runs if run.settings.motion_generator.motion.kind == 'two_axis']
    flights = [run for result in results if result.figure.shows.figure == 'flight'
               for run in result.runs]
    said = []
    if bench:
        worst, best = (pick(bench, key=_far) for pick in (max, min))
        said.append(f'On {names.run_name(worst.settings)}, {names.late_gyros(worst.settings)}, '
                    f'the attitude drifts by {_drift(worst):.3g} deg/h and the position error '
                    f'reaches {_far(worst):.4g} m in {_hours(worst)}')
        if best is not worst:
            said[-1] += (f'; with {names.short_run_name(best.settings)} it reaches '
                         f'{_far(best):.3g} m')
    if flights:
        worst = max(flights, key=_far)
        said.append(f'Of {len(flights)} flights the {names.motion_name(worst.settings)} has the '
                    f'largest position error, {_far(worst):.3g} m in {_hours(worst)} with '
                    f'{names.late_gyros(worst.settings)}')
    if not said:
        worst = max(runs, key=_drift)
        said.append(f'The largest drift is {_drift(worst):.4g} deg/h, with '
                    f'{names.run_name(worst.settings)}, {names.late_gyros(worst.settings)}')
    return '. '.join(said) + '.'


def _far(run):
    return float(np.hypot(*run.apart[:, :2].T).max())


def _drift(run):
    return float(DEG_PER_HOUR * np.linalg.norm(run.measured.drift))


def _hours(run):
    length_s = run.settings.motion_generator.duration_s
    return 'an hour' if length_s == 3600.0 else f'{length_s:g} s'


def study_notes(results):
    """Return the sentences on what was assumed."""
    notes = [note for result in results for note in result.figure.notes]
    notes += [f'{names.run_name(run.settings)}: without delays the position error is '
              f'{run.twin.largest[:2].max():.3g} m, because its motion changes faster than the '
              'IMU samples it; expected a higher rate_hz, or motion.recording.smoothing_s.'
              for run in all_runs(results) if run.twin.largest[:2].max() > CLOSED]
    if any(result.figure.shows.figure == 'errors' for result in results):
        notes.append(NO_CURVES)
    if any(result.map is not None for result in results):
        notes.append('The maps neglect the rotation of the Earth, which changes the largest '
                     'drift by a relative 1e-4.')
    return notes


def study_charts(results):
    """Return the Charts of FigureResults."""
    return [chart for result in results for chart in figure_charts(result)]


def study_page(results, charts, tables, files):
    """Return the Page; ``files`` describes the files next to it, {name: content}."""
    return Page(TITLE, answer(results), tuple(charts), tuple(tables), tuple(study_notes(results)),
                files=files)


def show_study(results, tables, console):
    """Print tables, answer and notes."""
    for table in tables:
        shown = Table(title=table.title)
        for k, head in enumerate(table.heads):
            left = k == 0 or head in ('axis', 'unit')
            shown.add_column(head, justify='left' if left else 'right')
        for row in table.rows:
            shown.add_row(*row)
        console.print(shown)
    for line in (answer(results), *study_notes(results)):
        console.print(line)
