"""Charts of the study of delays."""

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.units import DEG_PER_HOUR
from ..charts import scales
from ..charts.chart import (Chart, CIRCLE, CROSS, Curve, DASHED, DOT, DOTTED, Level, Map, Markers,
                            Panel)
from ..charts.palette import BLACK, BLUE, BODY_AXES, CYCLE, EAST_NORTH_UP, GREY
from . import delay_names as names

ARCMIN, ARCSEC = 60.0 * np.degrees(1.0), 3600.0 * np.degrees(1.0)
# Curves smaller than this part of the largest are repeated in a separate panel.
SMALL = 0.05
# Differences below this, arcsec, are shown in milliarcseconds.
FINE = 0.1
NAMES = ('latitude', 'longitude')
LINEAR = 'Linear theory without the rotation of the Earth.'


def figure_charts(result):
    """Return the Charts of a FigureResult."""
    return _MAKERS[result.figure.shows.figure](result)


def _errors(result):
    """Latitude and longitude error of motion 2: all runs, small ones, minus the prediction."""
    figure, shown = result.figure, result.figure.shows.shown
    picked = [k for k, name in enumerate(NAMES) if shown in ('both', name)]
    rows = []
    for make in (_whole, _small, _residual):
        # The legend of the first panel applies to all.
        row = [make(result.runs, k, k == picked[0]) for k in picked]
        if any(row):
            rows += [panel or Panel((), '', '', note='no small ones') for panel in row]
    what = ' and '.join(NAMES[k] for k in picked).capitalize()
    return (Chart(figure.name, f'{what} error of {_titled(figure)}', tuple(rows),
                  columns=len(picked),
                  caption=f'{names.conditions(figure.simulation)} Computed less true. The '
                  'prediction is that of the linear theory.'),)


def _titled(figure):
    return f'{names.motion_name(figure.simulation)}, {names.late_gyros(figure.simulation)}'


def _time(runs):
    factor, unit = scales.scale(scales.TIMES, max(run.t_s[-1] for run in runs))
    return factor, f'time [{unit}]'


def _whole(runs, k, labelled):
    factor, label = _time(runs)
    return Panel(tuple(Curve(factor * run.t_s, ARCMIN * run.angles[:, k],
                             names.short_run_name(run.settings) if labelled else None, colour)
                       for run, colour in zip(runs, CYCLE * len(runs))),
                 label, f'{NAMES[k]} error [arcmin]')


def _small(runs, k, _):
    largest = [np.abs(run.angles[:, k]).max() for run in runs]
    small = [size < SMALL * max(largest) for size in largest]
    if not any(small):
        return None
    factor, label = _time(runs)
    return Panel(tuple(Curve(factor * run.t_s, ARCSEC * run.angles[:, k], None, colour)
                       for run, colour, is_small in zip(runs, CYCLE * len(runs), small)
                       if is_small),
                 label, f'{NAMES[k]} error [arcsec]', title='the small ones alone')


def _residual(runs, k, _):
    factor, label = _time(runs)
    apart = [ARCSEC * (run.angles[:, k] - run.predicted_angles[:, k]) for run in runs]
    fine, unit = (1e3, 'mas') if max(np.abs(y).max() for y in apart) < FINE else (1.0, 'arcsec')
    return Panel(tuple(Curve(factor * run.t_s, fine * y, None, colour)
                       for run, y, colour in zip(runs, apart, CYCLE * len(runs))),
                 label, f'difference [{unit}]', title='run less prediction')


def _flight(result):
    """Track and position error of a flight, and what each channel contributes."""
    figure, (run,) = result.figure, result.runs
    factor, label = _time(result.runs)
    metres, unit = scales.scale(scales.LENGTHS, np.abs(run.apart).max())
    apart = run.apart - run.predicted
    fine, fine_unit = scales.scale(scales.LENGTHS, np.abs(apart[:, :2]).max())
    motion = names.motion_name(figure.simulation).capitalize()
    panels = (_track(run),
              Panel(_by_axis(run, metres * run.apart, factor), label, f'position error [{unit}]',
                    title='run less the run without delays'),
              Panel(_by_axis(run, fine * apart, factor, labelled=False), label,
                    f'difference [{fine_unit}]', title='run less prediction'))
    return (Chart(figure.name, f'{motion}, {names.late_gyros(figure.simulation)}', panels,
                  shared=False, caption=names.conditions(figure.simulation)),
            _contributions(result, motion))


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


def _contributions(result, motion):
    figure, (run,) = result.figure, result.runs
    factor, label = _time(result.runs)
    panels = tuple(
        Panel(tuple(Curve(factor * run.t_s, 1e-6 * run.sensitivity.position[:, k, axis],
                          f'gyro {name}', BODY_AXES[name]) for axis, name in enumerate('xyz')),
              label, f'{way} error [m/us]') for k, way in ((1, 'north'), (0, 'east')))
    return Chart(f'{figure.name}_by_channel', f'{motion}: position error by one microsecond of '
                 'delay of one gyro', panels,
                 caption=f'{names.conditions(figure.simulation)} Linear theory. For any '
                 'three delays add the curves, each times its delay.')


def _rates(result):
    """Drift over both rates, about those of the settings, and over the detuning."""
    figure, found = result.figure, result.map
    unit, axes = 'mean drift [deg/h]', ("psi' [rad/s]", "gamma' [rad/s]")
    lines = [(k, dash) for k, dash in zip(sorted(found.lines, reverse=True),
                                          (DASHED, DOTTED) * len(found.lines))]
    whole = Map(found.psi_rates, found.gamma_rates, DEG_PER_HOUR * found.largest, unit)
    near = Map(found.near_psi_rates, found.near_gamma_rates, DEG_PER_HOUR * found.near, unit)
    told = ', '.join(f"{dash}: psi' = {k} gamma'" for k, dash in lines)
    panels = (Panel((whole, *(_line(found.gamma_rates, k, dash) for k, dash in lines)), *axes,
                    title=f'the largest in each cell; {told}', height=2.2,
                    x_range=_ends(found.psi_rates), y_range=_ends(found.gamma_rates)),
              Panel((near, *(_line(found.near_gamma_rates, k, dash) for k, dash in lines)), *axes,
                    title='about the rates of the settings', height=1.8,
                    x_range=_ends(found.near_psi_rates), y_range=_ends(found.near_gamma_rates)))
    title = f'Mean drift of {_titled(figure)}, over {found.span_s:g} s'
    return (Chart(figure.name, title, panels, shared=False, caption=LINEAR),
            Chart(f'{figure.name}_across', f'{title}, over the detuning', (_across(result),),
                  caption=LINEAR))


def _line(gamma_rates, k, dash):
    """Return the line psi' = k gamma' across a map."""
    gamma = np.array(_ends(gamma_rates))
    return Curve(k * gamma, gamma, None, 'white', dash, 0.8)


def _ends(middles):
    half = 0.5 * (middles[1] - middles[0])
    return float(middles[0] - half), float(middles[-1] + half)


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
    return Panel(tuple(marks), "detuning of psi' [mrad/s]", 'mean drift [deg/h]',
                 height=1.5)


def _rocking(result):
    """Drift over psi, runs less theory, and over the direction of the axis in the body."""
    figure, found = result.figure, result.map
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
    title = f'drift of {_titled(figure)}'
    over_psi = (Panel((*curves, *points), 'psi [deg]', 'drift [deg/h]'),
                Panel((Level(y=0.0, colour=GREY), *apart), 'psi [deg]',
                      'difference [1e-6 deg/h]', title='runs less linear theory'))
    over_direction = Panel(
        (Map(found.azimuth_deg, found.elevation_deg, DEG_PER_HOUR * found.size,
             'size of the mean drift [deg/h]'),),
        'azimuth of the axis of rocking in the body, from forward to left [deg]',
        'elevation of the axis [deg]', height=1.8)
    return (Chart(figure.name, f'Up {title}' if len(curves) == 1 else title.capitalize(), over_psi,
                  caption=f'{names.conditions(figure.simulation)} {LINEAR}'),
            Chart(f'{figure.name}_directions', f'Mean {title}, over the direction of the axis',
                  (over_direction,), caption=LINEAR))


_MAKERS = {'errors': _errors, 'flight': _flight, 'rates': _rates, 'rocking': _rocking}
