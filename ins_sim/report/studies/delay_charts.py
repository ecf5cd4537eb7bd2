"""The figures of the study of delays as Charts."""

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.units import DEG_PER_HOUR
from ..charts import scales
from ..charts.chart import (Chart, CIRCLE, CROSS, Curve, DASHED, DOT, DOTTED, Level, Map, Markers,
                            Panel)
from ..charts.palette import BLACK, BLUE, BODY_AXES, CYCLE, EAST_NORTH_UP, GREY
from . import delay_names as names

ARCMIN, ARCSEC = 60.0 * np.degrees(1.0), 3600.0 * np.degrees(1.0)
# Curves smaller than this part of the largest are drawn once more by themselves.
SMALL = 0.05
NAMES = ('latitude', 'longitude')


def figure_charts(result):
    """Return the Charts of a FigureResult."""
    return _MAKERS[result.figure.shows.figure](result)


def _errors(result):
    """Latitude and longitude error of motion 2: all runs, the small ones, less the prediction."""
    figure, shown = result.figure, result.figure.shows.shown
    picked = [k for k, name in enumerate(NAMES) if shown in ('both', name)]
    rows = []
    for make in (_whole, _small, _residual):
        row = [make(result.runs, k) for k in picked]
        if any(row):
            rows += [panel or Panel((), '', '', note='no small ones') for panel in row]
    what = ' and '.join(NAMES[k] for k in picked).capitalize()
    return (Chart(figure.name, f'{what} error of {names.motion_name(figure.simulation)}, '
                  f'{names.conditions(figure.simulation)}', tuple(rows), columns=len(picked),
                  caption='Computed less true. The prediction is that of the linear theory.'),)


def _time(runs):
    factor, unit = scales.scale(scales.TIMES, max(run.t_s[-1] for run in runs))
    return factor, f'time [{unit}]'


def _whole(runs, k):
    factor, label = _time(runs)
    return Panel(tuple(Curve(factor * run.t_s, ARCMIN * run.angles[:, k],
                             names.short_run_name(run.settings), colour)
                       for run, colour in zip(runs, CYCLE * len(runs))),
                 label, f'{NAMES[k]} error [arcmin]')


def _small(runs, k):
    largest = [np.abs(run.angles[:, k]).max() for run in runs]
    small = [size < SMALL * max(largest) for size in largest]
    if not any(small):
        return None
    factor, label = _time(runs)
    return Panel(tuple(Curve(factor * run.t_s, ARCSEC * run.angles[:, k], None, colour)
                       for run, colour, is_small in zip(runs, CYCLE * len(runs), small)
                       if is_small),
                 label, f'{NAMES[k]} error [arcsec]', title='the small ones alone')


def _residual(runs, k):
    factor, label = _time(runs)
    return Panel(tuple(Curve(factor * run.t_s,
                             ARCSEC * (run.angles[:, k] - run.predicted_angles[:, k]), None,
                             colour) for run, colour in zip(runs, CYCLE * len(runs))),
                 label, 'difference [arcsec]', title='run less prediction')


def _flight(result):
    """Track and position error of a flight, and what each channel contributes."""
    figure, (run,) = result.figure, result.runs
    settings = figure.simulation
    factor, label = _time(result.runs)
    metres, unit = scales.scale(scales.LENGTHS, np.abs(run.apart).max())
    apart = run.apart - run.predicted
    fine, fine_unit = scales.scale(scales.LENGTHS, np.abs(apart[:, :2]).max())
    title = f'{names.motion_name(settings).capitalize()}, {names.conditions(settings)}'
    panels = (_track(run),
              Panel(_by_axis(run, metres * run.apart, factor), label, f'position error [{unit}]',
                    title='run less the run without delays'),
              Panel(_by_axis(run, fine * apart, factor, labelled=False), label,
                    f'difference [{fine_unit}]', title='run less prediction'))
    return (Chart(figure.name, title, panels, shared=False), _contributions(result, title))


def _by_axis(run, position, factor, labelled=True):
    return tuple(Curve(factor * run.t_s, position[:, k], name if labelled else None,
                       EAST_NORTH_UP[name]) for k, name in ((1, 'north'), (0, 'east')))


def _track(run):
    lat, lon, height = run.track.T
    east, north, _ = ellipsoid.offset(lat[0], lon[0], height[0], (lat, lon, height))
    kilo, unit = scales.scale(scales.LENGTHS, max(np.abs(east).max(), np.abs(north).max()))
    east, north = kilo * east, kilo * north
    return Panel((Curve(east, north, 'track', BLACK),
                  Markers(east[:1], north[:1], 'start', BLUE, CIRCLE, 8.0),
                  Markers(east[-1:], north[-1:], 'end', BLUE, CROSS, 8.0)),
                 f'east of the start [{unit}]', f'north of the start [{unit}]', equal=True)


def _contributions(result, title):
    figure, (run,) = result.figure, result.runs
    factor, label = _time(result.runs)
    panels = tuple(
        Panel(tuple(Curve(factor * run.t_s, 1e-6 * run.sensitivity.position[:, k, axis],
                          f'gyro {name}', BODY_AXES[name]) for axis, name in enumerate('xyz')),
              label, f'{way} error [m/us]') for k, way in ((1, 'north'), (0, 'east')))
    return Chart(f'{figure.name}_by_channel', f'{title}: position error by one microsecond of '
                 'delay of one gyro', panels,
                 caption='Linear theory. For any three delays add the curves, each times its '
                 'delay.')


def _rates(result):
    """Drift over both rates, about one resonance, and across it."""
    figure, found = result.figure, result.map
    settings, unit = figure.simulation, 'mean drift [deg/h]'
    whole = Map(found.psi_rates, found.gamma_rates, DEG_PER_HOUR * found.largest, unit)
    near = Map(found.near_psi_rates, found.near_gamma_rates, DEG_PER_HOUR * found.near, unit)
    axes = "psi' [rad/s]", "gamma' [rad/s]"
    panels = (Panel((whole, *_lines(found)), *axes, title='largest in each cell', height=2.2,
                    x_range=_ends(found.psi_rates), y_range=_ends(found.gamma_rates)),
              Panel((near,), *axes, title='about the rates of the settings', height=1.6),
              _across(result))
    return (Chart(figure.name, f'Mean drift of {names.motion_name(settings)}, over '
                  f'{found.span_s:g} s, {names.late_gyros(settings)}', panels, shared=False,
                  caption='Linear theory, without the rotation of the Earth.'),)


def _ends(middles):
    half = 0.5 * (middles[1] - middles[0])
    return float(middles[0] - half), float(middles[-1] + half)


def _lines(found):
    """Return the lines of resonance, beside the bright cells that they run through."""
    aside = 3.0 * (found.gamma_rates[1] - found.gamma_rates[0])
    top = found.gamma_rates[-1]
    return tuple(Curve(k * (gamma := np.array([-top, top])), gamma + aside,
                       f"psi' = {k} gamma'", 'white', dash)
                 for k, dash in zip(sorted(found.lines, reverse=True), (DASHED, DOTTED) * 3))


def _across(result):
    figure, found, milli = result.figure, result.map, 1e3
    rates = figure.simulation.motion_generator.motion.two_axis
    detunings = np.array([names.psi_rate(run.settings) - rates.psi_rate_rad_s
                          for run in result.runs])
    drifts = np.array([np.hypot(*run.measured.mean_drift[:2]) for run in result.runs])
    seen = np.abs(detunings) <= found.detunings[-1]
    marks = [Curve(milli * found.detunings, DEG_PER_HOUR * found.across, 'linear theory', BLUE),
             Markers(milli * detunings[seen], DEG_PER_HOUR * drifts[seen], 'runs', BLACK, DOT,
                     6.0)]
    if found.half_width is not None:
        half = 0.5 * DEG_PER_HOUR * np.interp(0.0, found.detunings, found.across)
        marks += [Level(y=half, colour=GREY, dash=DASHED), *(
            Level(x=sign * milli * found.half_width, colour=GREY, dash=DASHED,
                  label=f'half at {milli * found.half_width:.3g} mrad/s' if sign > 0 else None)
            for sign in (-1.0, 1.0))]
    return Panel(tuple(marks), "detuning of psi' [mrad/s]", 'mean drift [deg/h]')


def _rocking(result):
    """Drift over psi, runs less theory, and over the direction of the axis in the body."""
    figure, found = result.figure, result.map
    settings = figure.simulation
    psi = np.array([run.settings.motion_generator.motion.psi_deg for run in result.runs])
    curves, points, apart = [], [], []
    for k, name in enumerate(('east', 'north', 'up')):
        drift = DEG_PER_HOUR * found.drift[:, k]
        if np.abs(drift).max() < 1e-6 * DEG_PER_HOUR * np.abs(found.drift).max():
            continue
        measured = DEG_PER_HOUR * np.array([run.measured.drift[k] for run in result.runs])
        colour = EAST_NORTH_UP[name]
        curves.append(Curve(found.psi_deg, drift, f'{name}, linear theory', colour))
        points.append(Markers(psi, measured, f'{name}, runs', BLACK, DOT, 6.0))
        apart.append(Markers(psi, 1e6 * (measured - np.interp(psi, found.psi_deg, drift)), None,
                             colour, DOT, 6.0))
    panels = (Panel((*curves, *points), 'psi [deg]', 'drift [deg/h]'),
              Panel((Level(y=0.0), *apart), 'psi [deg]', 'difference [1e-6 deg/h]',
                    title='runs less linear theory'),
              Panel((Map(found.azimuth_deg, found.elevation_deg, DEG_PER_HOUR * found.size,
                         'size of the mean drift [deg/h]'),),
                    'azimuth of the axis of rocking in the body, forward to left [deg]',
                    'its elevation [deg]', title='over the direction of the axis', height=1.8))
    return (Chart(figure.name, f'Mean drift of {names.motion_name(settings)}, '
                  f'{names.conditions(settings)}', panels, shared=False,
                  caption='Linear theory, without the rotation of the Earth.'),)


_MAKERS = {'errors': _errors, 'flight': _flight, 'rates': _rates, 'rocking': _rocking}
