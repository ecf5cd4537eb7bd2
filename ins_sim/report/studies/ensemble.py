"""Report of an ensemble: sentences, tables, page, arrays, parameters and manifest."""

from dataclasses import dataclass
import json
import math
from shlex import quote

import numpy as np
from rich.table import Table

from ins_sim import parameter_files
from ins_sim.core.ensemble.result import EnsembleResult
from ins_sim.settings.simulation import AidedSimulationSettings
from ins_sim.studies.aided_ensembles import AidedEnsembleResult
from ins_sim.studies.ensemble_errors import (COLUMNS, ensemble_digest, ensemble_errors,
                                             EnsembleErrors, PERCENTS, worst_run)
from .. import titles
from ..charts.png import save_chart
from ..files.packed_arrays import write_arrays
from ..manifest import manifest
from ..page.content import Page, PageTable
from ..page.html import write_page
from ..storage import MANIFEST, PARAMETERS
from .aided_ensembles import (consistency_answer, consistency_chart, consistency_notes,
                              consistency_table)
from .ensemble_charts import AXES, ensemble_charts

ARRAYS, SUMMARY = 'ensemble.npz', 'summary.json'
ARCSEC = math.degrees(1.0) * 3600.0
# Unit in which a quantity is shown, and one unit in SI.
TOLD = {'attitude': ('arcsec', ARCSEC), 'velocity': ('m/s', 1.0), 'position': ('m', 1.0)}
# Maximum number of instants in a table, and of runs in a sentence.
MOST_ROWS, MOST_NAMED = 7, 10


@dataclass(frozen=True, eq=False)
class EnsembleReport:
    """
    Content of the report of an ensemble.

    Attributes
    ----------
    title : what was simulated, in words
    settings : SimulationSettings of the first run, or AidedSimulationSettings
    result, errors : EnsembleResult and EnsembleErrors
    worst : number and horizontal error (m) of the run with the largest error at the end, or None
    digest : digest of the result, independent of how the runs were distributed
    aided : AidedEnsembleResult of aided runs, or None
    """

    title: str
    settings: object
    result: EnsembleResult
    errors: EnsembleErrors
    worst: tuple | None
    digest: str
    aided: AidedEnsembleResult | None = None

    @property
    def simulation(self):
        """Return the SimulationSettings."""
        return self.settings if self.aided is None else self.settings.simulation


def ensemble_report(title, settings, found):
    """Return the EnsembleReport of an EnsembleResult or an AidedEnsembleResult."""
    aided = found if isinstance(found, AidedEnsembleResult) else None
    result = found if aided is None else aided.errors
    return EnsembleReport(title, settings, result, ensemble_errors(result), worst_run(result),
                          ensemble_digest(found), aided)


def ensemble_title(settings, runs):
    """Return the title of the simulation, with filter and number of runs."""
    aided = isinstance(settings, AidedSimulationSettings)
    simulation = settings.simulation if aided else settings
    filter_ = f', filter {settings.aided_navigator.filter}' if aided else ''
    return f'{titles.title(simulation)}{filter_}, {runs} run{"s" * (runs != 1)}'


def flight_command(report, parameters=PARAMETERS):
    """Return the command that simulates the worst run alone, with the same bits."""
    number, aided = report.worst[0], '' if report.aided is None else ' --aided'
    return (f'ins_sim simulate{aided} --params-file {quote(parameters)} -p run:={number} '
            f'-o run_{number}')


def notes(report):
    """Return sentences on excluded and on restarted runs."""
    result, said = report.result, []
    if result.diverged:
        words, why = 'diverged and are excluded from then on', ''
        if report.aided is not None:
            number, reason = report.aided.refused[0]
            words = 'were refused or diverged and are excluded'
            why = f'; run {number}: {reason}'
        said.append(f'{len(result.diverged)} of {len(result.runs)} runs {words}: '
                    f'{_named(result.diverged)}{why}')
    if result.restarted:
        total = sum(count for _, count in result.restarted)
        said.append(f'the solution was restarted from the truth {total} times, after gaps, in '
                    f'{len(result.restarted)} of {len(result.runs)} runs')
    if len(result.runs) - len(result.diverged) < 2:
        said.append('sigma and CEP need two runs or more')
    if report.aided is not None:
        said += consistency_notes(report.aided, report.settings.aided_navigator.filter)
    return tuple(said)


def _named(runs):
    more = f' and {len(runs) - MOST_NAMED} more' if len(runs) > MOST_NAMED else ''
    return ', '.join(map(str, runs[:MOST_NAMED])) + more


def answer(report):
    """Return the result in a few sentences."""
    errors = report.errors
    if report.worst is None:
        refused = '' if report.aided is None else 'were refused or '
        return f'All {len(report.result.runs)} runs {refused}diverged.'
    number, metres = report.worst
    rms = errors.horizontal_rms['position'][-1]
    said = f'After {errors.t_ns[-1] * 1e-9:g} s the horizontal position error is {rms:.4g} m rms'
    if np.isfinite(errors.cep[50][-1]):
        said += f', CEP50 {errors.cep[50][-1]:.4g} m, CEP95 {errors.cep[95][-1]:.4g} m'
    said += f' over {errors.count[-1]} runs. The worst is run {number} with {metres:.4g} m.'
    if report.aided is None:
        return said
    return f'{said} {consistency_answer(report.aided.consistency)}'


def tables(report):
    """Return the PageTables: errors at the end by axis, position over time, consistency."""
    errors, heads = report.errors, ('mean', 'sigma', 'rms', *(f'{p} %' for p in PERCENTS))
    rows = []
    for name in COLUMNS:
        unit, factor = TOLD[name]
        for k, axis in enumerate(AXES):
            values = (errors.mean[name][-1, k], errors.sigma[name][-1, k],
                      errors.rms[name][-1, k], *errors.percentiles[name][:, -1, k])
            rows.append((f'{name} {axis}', unit, *_cells(factor * np.array(values))))
        values = (errors.horizontal_rms[name][-1],
                  *errors.horizontal_percentiles[name][:, -1])
        rows.append((f'{name} horizontal', unit, '-', '-', *_cells(factor * np.array(values))))
    end = PageTable(f'errors at {errors.t_ns[-1] * 1e-9:g} s', ('error', 'unit', *heads),
                    tuple(rows), 'percentiles: this part of the runs lies below the value')
    chosen = np.unique(np.linspace(0, len(errors.t_ns) - 1, MOST_ROWS).round().astype(int))
    against = PageTable(
        'horizontal position error against time',
        ('time [s]', 'runs', 'sigma east [m]', 'sigma north [m]', 'rms [m]', 'CEP50 [m]',
         'CEP95 [m]', '95 % [m]'),
        tuple((f'{errors.t_ns[k] * 1e-9:g}', str(errors.count[k]),
               *_cells([*errors.sigma['position'][k, :2], errors.horizontal_rms['position'][k],
                        errors.cep[50][k], errors.cep[95][k],
                        errors.horizontal_percentiles['position'][-1, k]])) for k in chosen),
        'CEP: radius around the true position, from mean and covariance; 95 %: radius that '
        'contains this part of the runs')
    filter_ = None if report.aided is None else consistency_table(report.aided.consistency)
    return (end, against) if filter_ is None else (end, against, filter_)


def _cells(values):
    return ['-' if not np.isfinite(value) else float(value) for value in values]


def show(report, console):
    """Print tables, answer and notes."""
    for one in tables(report):
        table = Table(title=f'{report.title}: {one.title}', caption=one.note)
        for k, head in enumerate(one.heads):
            table.add_column(head, justify='left' if k == 0 else 'right')
        for row in one.rows:
            table.add_row(*(cell if isinstance(cell, str) else f'{cell + 0.0:.4g}'
                            for cell in row))
        console.print(table)
    for line in (answer(report), *notes(report)):
        console.print(line)


def report_arrays(report):
    """Return {name: array} of ensemble.npz: statistics, and the end of every run."""
    errors, result = report.errors, report.result
    arrays = {'t_ns': errors.t_ns, 'count': errors.count, 'percents': np.array(PERCENTS)}
    for name in COLUMNS:
        arrays.update({
            f'{name}_mean': errors.mean[name], f'{name}_sigma': errors.sigma[name],
            f'{name}_rms': errors.rms[name], f'{name}_percentiles': errors.percentiles[name],
            f'{name}_horizontal_rms': errors.horizontal_rms[name],
            f'{name}_horizontal_percentiles': errors.horizontal_percentiles[name]})
    arrays.update({f'position_cep{percent}': radius for percent, radius in errors.cep.items()})
    final, ends = result.final, result.final_errors
    if report.aided is not None:
        arrays.update(report.aided.consistency.arrays())
    return {**arrays, 'covariance': result.statistics.covariance,
            'runs': np.arange(result.runs.start, result.runs.stop),
            'diverged': np.array(result.diverged, dtype=np.int64),
            'final_lat': final[:, 0], 'final_lon': final[:, 1], 'final_height': final[:, 2],
            'final_v_n': final[:, 3:6], 'final_q_nb': final[:, 6:10],
            **{f'final_{name}_error': ends[:, part] for name, part in COLUMNS.items()}}


def write_ensemble(folder, report):
    """Write an EnsembleReport into a folder: arrays, summary, parameters, manifest, figures."""
    charts = ensemble_charts(report.title, report.errors, report.result, report.worst)
    dump, aided = parameter_files.dump, None
    if report.aided is not None:
        dump, aided = parameter_files.dump_aided, report.settings
        filter_ = consistency_chart(report.errors.t_ns, report.aided.consistency)
        charts += () if filter_ is None else (filter_,)
    write_arrays(folder / ARRAYS, report_arrays(report))
    (folder / PARAMETERS).write_text(dump(report.settings), encoding='utf-8')
    (folder / MANIFEST).write_text(manifest(report.simulation, aided), encoding='utf-8')
    for chart in charts:
        save_chart(folder, chart)
    told = notes(report)
    if report.worst is not None:
        told += (f'command that simulates the worst run alone: {flight_command(report)}',)
    write_page(folder, Page(
        report.title, answer(report), charts, tables(report), told, report.settings,
        {'statistics, and errors of all runs at the end': report.digest},
        {ARRAYS: 'statistics by instant, and solution and errors of every run at the end',
         SUMMARY: 'the tables as JSON', PARAMETERS: 'every parameter',
         MANIFEST: 'noise and bits'}))
    (folder / SUMMARY).write_text(json.dumps(_summary(report), indent=1) + '\n',
                                  encoding='utf-8')


def _summary(report):
    result = report.result
    return {'title': report.title, 'runs': len(result.runs), 'first_run': result.runs.start,
            'diverged': list(result.diverged), 'restarted': [list(p) for p in result.restarted],
            'worst_run': report.worst and report.worst[0],
            'worst_horizontal_m': report.worst and report.worst[1], 'digest': report.digest,
            'tables': [{'title': table.title, 'heads': table.heads,
                        'rows': [[None if cell == '-' else cell for cell in row]
                                 for row in table.rows]} for table in tables(report)]}
