"""Charts of an ensemble: errors over time with percentile bands, and errors at the end."""

import numpy as np

from ins_sim.core.ensemble.result import horizontal_of
from ins_sim.studies.ensemble_errors import CEP_PARTS, COLUMNS, PERCENTS
from ..charts import palette
from ..charts.chart import (Band, Chart, CROSS, Curve, DASHED, DOTTED, Level, Markers, Panel,
                            TRIANGLE)
from ..charts.scales import ANGLES, LENGTHS, scale, SPEEDS, TIMES

AXES = ('east', 'north', 'up')
UNITS = {'attitude': ANGLES, 'velocity': SPEEDS, 'position': LENGTHS}
# Maximum number of runs whose ends are drawn; number of bars of the histogram.
MOST_POINTS, BARS = 4000, 40
TURN = np.linspace(0.0, 2.0 * np.pi, 181)


def ensemble_charts(title, errors, result, worst):
    """Return the Charts of an ensemble; ``worst`` is (number, error) of the worst run, or None."""
    charts = [_horizontal(title, errors), *(_by_axis(title, errors, name) for name in COLUMNS)]
    charts = [chart for chart in charts if chart.panels]
    ends = result.final_errors[np.isfinite(result.final_errors).all(axis=1)]
    if len(ends):
        charts += [_scatter(title, errors, result, worst), _histogram(title, errors, ends)]
    return tuple(charts)


def _time(errors):
    """Return the instants as they are drawn, and the label of their axis."""
    t_s = errors.t_ns * 1e-9
    factor, unit = scale(TIMES, float(t_s[-1]) if len(t_s) else 0.0)
    return t_s * factor, f'motion time [{unit}]'


def _largest(*arrays):
    values = np.abs(np.concatenate([np.ravel(a) for a in arrays]))
    return float(values[np.isfinite(values)].max(initial=0.0))


def _bands(x, percentiles, colour):
    """Return the bands between percentiles, the widest first, and the median."""
    pairs = [(k, len(PERCENTS) - 1 - k) for k in range(len(PERCENTS) // 2)]
    bands = [Band(x, percentiles[low], percentiles[high],
                  f'{PERCENTS[low]} to {PERCENTS[high]} % of the runs',
                  colour if low else palette.GREY)
             for low, high in pairs]
    return [*bands, Curve(x, percentiles[len(PERCENTS) // 2], 'median', colour)]


def _horizontal(title, errors):
    x, label = _time(errors)
    sizes = errors.horizontal_percentiles['position']
    factor, unit = scale(LENGTHS, _largest(sizes, errors.horizontal_rms['position']))
    marks = _bands(x, factor * sizes, palette.BLUE)
    marks.append(Curve(x, factor * errors.horizontal_rms['position'], 'rms', palette.BLACK))
    for percent, dash in zip(errors.cep, (DASHED, DOTTED)):
        marks.append(Curve(x, factor * errors.cep[percent],
                           f'CEP{percent}, by mean and covariance', palette.RED, dash))
    return Chart('horizontal', f'{title}: horizontal position error',
                 (Panel(tuple(marks), label, f'horizontal position error [{unit}]'),))


def _by_axis(title, errors, name):
    x, label = _time(errors)
    mean, sigma, found = errors.mean[name], errors.sigma[name], errors.percentiles[name]
    factor, unit = scale(UNITS[name], _largest(found, mean + sigma, mean - sigma))
    panels = []
    for k, axis in enumerate(AXES):
        if not _largest(found[:, :, k]):
            # This component is held by the truth and has no error.
            continue
        colour = palette.EAST_NORTH_UP[axis]
        marks = _bands(x, factor * found[:, :, k], colour)
        marks += [Curve(x, factor * (mean + side * sigma)[:, k],
                        'mean +- sigma' if side > 0.0 else None, palette.BLACK, DASHED, 1.0)
                  for side in (1.0, -1.0)]
        panels.append(Panel(tuple(marks), label, f'{axis} [{unit}]'))
    return Chart(name, f'{title}: {name} error', tuple(panels))


def _circle(radius):
    return radius * np.sin(TURN), radius * np.cos(TURN)


def _scatter(title, errors, result, worst):
    ends = result.final_errors[:, COLUMNS['position']][:, :2]
    shown = ends[::max(1, len(ends) // MOST_POINTS)]
    radii = {percent: radius[-1] for percent, radius in errors.cep.items()}
    factor, unit = scale(LENGTHS, _largest(shown, list(radii.values())))
    marks = [Markers(*(factor * shown.T), 'runs', palette.SKY, size=2.5)]
    for (percent, radius), dash in zip(radii.items(), (DASHED, DOTTED)):
        if np.isfinite(radius):
            east, north = _circle(factor * radius)
            marks.append(Curve(east, north, f'CEP{percent}: {factor * radius:.4g} {unit}',
                               palette.BLACK, dash))
    statistics = result.statistics
    plane = slice(COLUMNS['position'].start, COLUMNS['position'].start + 2)
    covariance = statistics.covariance[-1, plane, plane]
    if np.isfinite(covariance).all():
        sizes, axes = np.linalg.eigh(covariance)
        # The 95 % ellipse of a two-dimensional normal distribution has semi-axes of
        # sqrt(-2 ln 0.05) sigma.
        reach = np.sqrt(-2.0 * np.log(0.05) * np.maximum(sizes, 0.0))
        east, north = factor * (statistics.mean[-1, plane][:, None] + axes @ (
            reach[:, None] * np.array([np.cos(TURN), np.sin(TURN)])))
        marks.append(Curve(east, north, '95 % ellipse', palette.RED))
    if worst is not None:
        end = factor * ends[worst[0] - result.runs.start]
        marks.append(Markers(end[:1], end[1:], f'worst, run {worst[0]}', palette.RED, TRIANGLE,
                             7.0))
    marks.append(Markers(np.zeros(1), np.zeros(1), 'true place', palette.BLACK, CROSS, 7.0))
    return Chart('ends', f'{title}: position error at the end of each run',
                 (Panel(tuple(marks), f'east [{unit}]', f'north [{unit}]', equal=True),))


def _histogram(title, errors, ends):
    sizes = horizontal_of(ends)[:, 2]
    factor, unit = scale(LENGTHS, _largest(sizes))
    counts, edges = np.histogram(factor * sizes, min(BARS, max(5, len(sizes) // 10)))
    steps = np.repeat(edges, 2)
    marks = [Band(steps, np.zeros(len(steps)), np.concatenate([[0], np.repeat(counts, 2), [0]]),
                  'runs', palette.SKY)]
    for percent, dash in zip(CEP_PARTS, (DASHED, DOTTED)):
        radius = errors.cep[percent][-1]
        if np.isfinite(radius):
            marks.append(Level(x=float(factor * radius), colour=palette.RED, dash=dash,
                               label=f'CEP{percent}: {factor * radius:.4g} {unit}'))
    return Chart('histogram', f'{title}: horizontal position error at the end',
                 (Panel(tuple(marks), f'horizontal position error [{unit}]', 'runs'),))
