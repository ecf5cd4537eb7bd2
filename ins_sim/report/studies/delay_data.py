"""Numbers of the study of delays: columns of each figure, and values for summary files."""

import numpy as np

from ins_sim.core.numerics.units import DEG_PER_HOUR
from .. import summary
from . import delay_names as names

ARCMIN = 60.0 * np.degrees(1.0)


def figure_tables(result):
    """Return {name of a table: {name of a column: (n,) array}} of a FigureResult."""
    return _TABLES[result.figure.shows.figure](result)


def _errors(result):
    columns = {'t_s': result.runs[0].t_s}
    for run in result.runs:
        rate = f'psi_rate_{names.psi_rate(run.settings):g}'
        for kind, angles in (('', run.angles), ('predicted_', run.predicted_angles)):
            columns[f'{rate}_{kind}latitude_arcmin'] = ARCMIN * angles[:, 0]
            columns[f'{rate}_{kind}longitude_arcmin'] = ARCMIN * angles[:, 1]
    return {result.figure.name: columns}


def _flight(result):
    run, = result.runs
    columns = {'t_s': run.t_s, 'latitude_deg': np.degrees(run.track[:, 0]),
               'longitude_deg': np.degrees(run.track[:, 1]), 'height_m': run.track[:, 2]}
    for kind, position in (('', run.apart), ('predicted_', run.predicted)):
        columns[f'{kind}north_m'], columns[f'{kind}east_m'] = position[:, 1], position[:, 0]
    for k, way in ((1, 'north'), (0, 'east')):
        for axis, name in enumerate('xyz'):
            columns[f'{way}_m_per_us_{name}'] = 1e-6 * run.sensitivity.position[:, k, axis]
    return {result.figure.name: columns}


def _rates(result):
    found, name = result.map, result.figure.name
    return {name: _cells('psi_rate_rad_s', found.psi_rates, 'gamma_rate_rad_s',
                         found.gamma_rates, found.largest),
            f'{name}_across': {'detuning_rad_s': found.detunings,
                               'drift_deg_h': DEG_PER_HOUR * found.across}}


def _rocking(result):
    found, name = result.map, result.figure.name
    curve = {'psi_deg': found.psi_deg}
    for k, way in enumerate(('east', 'north', 'up')):
        curve[f'drift_{way}_deg_h'] = DEG_PER_HOUR * found.drift[:, k]
    return {name: curve, f'{name}_directions': _cells(
        'azimuth_deg', found.azimuth_deg, 'elevation_deg', found.elevation_deg, found.size)}


def _cells(x_name, x, y_name, y, drift):
    """Return the cells of a map, row by row."""
    columns, rows = np.meshgrid(x, y)
    return {x_name: columns.ravel(), y_name: rows.ravel(),
            'drift_deg_h': DEG_PER_HOUR * drift.ravel()}


_TABLES = {'errors': _errors, 'flight': _flight, 'rates': _rates, 'rocking': _rocking}


def save_csv(folder, result):
    """Save the tables of a FigureResult as CSV files; return their names."""
    saved = []
    for name, columns in figure_tables(result).items():
        np.savetxt(folder / f'{name}.csv', np.stack(list(columns.values()), axis=-1),
                   fmt='%.10g', delimiter=',', header=','.join(columns), comments='')
        saved.append(f'{name}.csv')
    return saved


def all_runs(results):
    """Return the DelayRuns of FigureResults, each once."""
    return list({id(run): run for result in results for run in result.runs}.values())


def published(run):
    """Return the published drift (3,), deg/h, and max |dN|, |dE|, m, of a run, or None."""
    key = summary.study_key(run.settings)
    return summary.PUBLISHED_DRIFT.get(key), summary.PUBLISHED_POSITION.get(key)


def run_numbers(run):
    """Return the results of a run for a summary file."""
    drift, place = published(run)
    numbers = {'run': names.run_name(run.settings), 'delays': names.late_gyros(run.settings),
               'duration_s': run.settings.motion_generator.duration_s}
    for kind, figures in (('predicted', run.prediction), ('measured', run.measured),
                          ('twin', run.twin)):
        numbers[kind] = {'drift_enu_deg_h': (DEG_PER_HOUR * figures.drift).tolist(),
                         'mean_drift_enu_deg_h': (DEG_PER_HOUR * figures.mean_drift).tolist(),
                         'largest_north_east_m': figures.largest[[1, 0]].tolist()}
    if drift or place:
        numbers['published'] = {'drift_enu_deg_h': drift, 'largest_north_east_m': place}
    numbers['end_latitude_longitude_arcmin'] = (ARCMIN * run.angles[-1]).tolist()
    if run.sensitivity is not None:
        numbers['per_us_xyz'] = {
            'north_at_end_m': (1e-6 * run.sensitivity.position[-1, 1]).tolist(),
            'east_at_end_m': (1e-6 * run.sensitivity.position[-1, 0]).tolist(),
            'drift_enu_deg_h': (1e-6 * DEG_PER_HOUR * run.sensitivity.drift).tolist()}
    return numbers


def figure_numbers(result):
    """Return the results of a FigureResult for a summary file."""
    numbers = {'figure': result.figure.name,
               'runs': [names.run_name(run.settings) for run in result.runs]}
    if result.figure.shows.figure == 'rates':
        numbers['mean_over_s'] = result.map.span_s
        numbers['lines'] = [f"psi' = {k} gamma'" for k in result.map.lines]
        numbers['half_width_rad_s'] = result.map.half_width
    return numbers
