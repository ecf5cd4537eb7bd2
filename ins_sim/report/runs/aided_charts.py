"""Chart of an aided solution: errors with three-sigma bounds of the filter, outages, NIS."""

import numpy as np

from ins_sim.core.aiding.navigator import GNSS, METER
from ..charts.chart import Band, Chart, CROSS, Curve, DASHED, Level, LOG, Markers, Panel, Stretch
from ..charts.palette import BLACK, EAST_NORTH_UP, GREY, ORANGE, PURPLE, RED
from ..charts.scales import ANGLES, LENGTHS, scale, SPEEDS, TIMES
from ..consistency import chi_square_limit

# Sensor: (colour of its marks, name, colour of the shaded outages).
SOURCES = {METER: (PURPLE, 'velocity meter', ORANGE), GNSS: ('#0099aa', 'GNSS', GREY)}
# (field, label, components, units)
PANELS = (('position', 'position error', (0, 1, 2), LENGTHS),
          ('velocity', 'velocity error', (0, 1, 2), SPEEDS),
          ('attitude', 'tilt', (0, 1), ANGLES), ('attitude', 'azimuth error', (2,), ANGLES))
NAMES = tuple(EAST_NORTH_UP)
# The line through the NIS is a moving mean over 1/SPANS of the accepted fixes, at least MEAN_OF.
MEAN_OF, SPANS = 20, 60
# It is interrupted between fixes that are farther apart than GAP times their median interval.
GAP = 5.0
# Outages of a sensor are merged if the time between them is less than this part of the run.
APART = 1.0 / 500.0


def aided_chart(title, flown, sources, gate_probability):
    """
    Return the Chart of an aided run.

    Parameters
    ----------
    title : title of the run
    flown : AidedResult with the fixes of the sensors
    sources : aiding sensors
    gate_probability : setting of the navigator; 0 for no gate
    """
    errors = flown.errors
    start_ns, end_ns = int(errors.t_ns[0]), int(errors.t_ns[-1])
    factor, unit = scale(TIMES, (end_ns - start_ns) * 1e-9)

    def time(t_ns):
        return (np.asarray(t_ns, dtype=np.int64) - start_ns) * (1e-9 * factor)

    label, span = f'time [{unit}]', tuple(map(float, time((start_ns, end_ns))))
    silent = _silences(flown, sources, time, span)
    panels = [_errors(time(errors.t_ns), errors, silent, label, span, *panel)
              for panel in PANELS]
    if any(t.outcome.nis is not None for t in flown.judged):
        panels.append(Panel((*silent, *_nis(flown.judged, sources, gate_probability, time)),
                            label, 'NIS per degree of freedom', y_scale=LOG, x_range=span))
    return Chart('aided', title, tuple(panels))


def _errors(t, errors, silent, x_label, span, field, label, components, units):
    """Return the panel of errors and of the three-sigma bands of the filter."""
    values, sigmas = getattr(errors, field), getattr(errors, f'{field}_sigma')
    # Height and vertical velocity often follow an ideal altimeter; their errors are then exactly
    # zero and are not shown.
    shown = [axis for axis in components if axis < 2 or len(components) == 1
             or np.any(values[:, axis])]
    factor, unit = scale(units, float(np.abs(values[:, shown]).max()))
    bands = []
    for axis in shown:
        bound = 3.0 * factor * sigmas[:, axis]
        if np.isfinite(bound).all() and bound.any():
            name = NAMES[axis]
            bands.append(Band(t, -bound, bound, f'3 sigma {name}', EAST_NORTH_UP[name]))
    return Panel((*silent, *bands, *(
        Curve(t, values[:, axis] * factor, NAMES[axis], EAST_NORTH_UP[NAMES[axis]], width=1.2)
        for axis in shown)), x_label, f'{label} [{unit}]', x_range=span)


def _nis(judged, sources, gate_probability, time):
    """Return the marks of the NIS of each fix, the mean over accepted fixes, and the gate."""
    marks = []
    for source in sources:
        colour, name, _ = SOURCES[source]
        fixes = [t for t in judged if t.source == source and t.outcome.nis is not None]
        if not fixes:
            continue
        freedom = fixes[0].outcome.freedom
        t = time([fix.t_ns for fix in fixes])
        nis = np.maximum([fix.outcome.nis / freedom for fix in fixes], 1e-3)
        good = np.array([fix.outcome.taken for fix in fixes])
        marks.append(Markers(t[good], nis[good], name, colour, size=2.5))
        if not good.all():
            marks.append(Markers(t[~good], nis[~good], f'{name}, refused', RED, CROSS, 6.0))
        count = max(MEAN_OF, int(good.sum()) // SPANS)
        label = f'{name}, mean of {count}'
        for part in _unbroken(t[good]):
            if part.stop - part.start > count:
                mean = np.convolve(nis[good][part], np.full(count, 1.0 / count), 'valid')
                marks.append(Curve(t[good][part][count - 1:], mean, label, colour))
                label = None
        if gate_probability:
            marks.append(Level(chi_square_limit(freedom, gate_probability) / freedom,
                               label=f'{name}, gate', colour=colour, dash=DASHED))
    return [*marks, Level(1.0, label='expected mean', colour=BLACK)]


def _unbroken(t):
    """Return slices of sorted times without missing fixes."""
    steps = np.diff(t)
    ends = np.flatnonzero(steps > GAP * np.median(steps)) + 1 if len(steps) else []
    bounds = [0, *ends, len(t)]
    return [slice(*pair) for pair in zip(bounds, bounds[1:])]


def _silences(flown, sources, time, span):
    """Return a Stretch with the outages of each sensor that had any."""
    found = []
    for source, fixes in ((GNSS, flown.gnss_fixes), (METER, flown.velocity_fixes)):
        if source not in sources:
            continue
        spans = silent_spans(fixes, int(flown.errors.t_ns[0]), int(flown.errors.t_ns[-1]))
        joined = []
        for first, last in (time(pair) for pair in spans):
            if joined and first - joined[-1][1] < APART * (span[1] - span[0]):
                joined[-1][1] = last
            else:
                joined.append([first, last])
        if joined:
            _, name, shade = SOURCES[source]
            found.append(Stretch(*np.array(joined).T, f'no {name}', shade))
    return found


def silent_spans(fixes, start_ns, end_ns):
    """Return the spans (first, last), ns, from an invalid fix to the next valid one."""
    spans, since_ns = [], None
    for fix in fixes:
        if not fix.valid and since_ns is None:
            since_ns = fix.t_ns
        elif fix.valid and since_ns is not None:
            spans.append((since_ns, fix.t_ns))
            since_ns = None
    if since_ns is not None:
        spans.append((since_ns, end_ns))
    return [(max(first, start_ns), min(last, end_ns)) for first, last in spans
            if last > start_ns and first < end_ns]
