"""The figure of an aided run: its errors within three sigma of the filter, outages and NIS."""

import numpy as np

from ins_sim.core.aiding.navigator import GNSS, METER
from .consistency import chi_square_limit
from .plotting import COLOURS, literal, new_figure, save_png, thinned

SOURCES = {METER: ('tab:purple', 'velocity meter'), GNSS: ('tab:cyan', 'GNSS')}
PANELS = (('position', 'position error [m]', (0, 1, 2), 1.0),
          ('velocity', 'velocity error [m/s]', (0, 1, 2), 1.0),
          ('attitude', 'tilt [arcsec]', (0, 1), np.degrees(1.0) * 3600.0),
          ('attitude', 'azimuth error [arcmin]', (2,), np.degrees(1.0) * 60.0))
NAMES = tuple(COLOURS)
# the line through the NIS is a mean of so many fixes at least, and has so many such spans at most
MEAN_OF, SPANS = 20, 60
# and is broken where fixes are missing: at so many times their usual distance
GAP = 5.0
# of a panel's height: the strip that shows when the velocity meter had no fix
STRIP = 0.04


def save_figure(path, title, flown, sources, gate_probability):
    """
    Save the figure as PNG.

    flown: AidedResult with the fixes of the instruments; sources: those that aid;
    gate_probability: of the navigator, 0: none.
    """
    start_ns, end_ns = int(flown.errors.t_ns[0]), int(flown.errors.t_ns[-1])
    span_s = (end_ns - start_ns) * 1e-9
    unit, per = ('min', 60.0) if span_s > 300.0 else ('s', 1.0)

    def time(t_ns):
        return (np.asarray(t_ns, dtype=np.int64) - start_ns) * 1e-9 / per

    errors = thinned(flown.errors)
    weighed = any(t.outcome.nis is not None for t in flown.judged)
    rows = len(PANELS) + weighed
    figure = new_figure(10, 2.6 * rows)
    panels = figure.subplots(rows, 1, sharex=True)
    for axes, (kind, label, components, factor) in zip(panels, PANELS):
        _show_errors(axes, time(errors.t_ns), getattr(errors, kind) * factor,
                     getattr(errors, f'{kind}_sigma') * factor, components)
        axes.set_ylabel(label)
    if weighed:
        _show_nis(panels[-1], flown.judged, sources, gate_probability, time)
        panels[-1].set_ylabel('NIS per degree of freedom')
    panels[-1].set_xlabel(f'time [{unit}]')
    silent = {source: [time(span) for span in _silent(fixes, start_ns, end_ns)]
              for source, fixes in ((GNSS, flown.gnss_fixes), (METER, flown.velocity_fixes))
              if source in sources}
    for axes in panels:
        for k, span in enumerate(silent.get(GNSS, [])):
            axes.axvspan(*span, color='0.5', alpha=0.15, lw=0.0, label=None if k else 'no GNSS')
        if silent.get(METER):
            colour, name = SOURCES[METER]
            axes.broken_barh([(first, last - first) for first, last in silent[METER]],
                             (0.0, STRIP), transform=axes.get_xaxis_transform(), color=colour,
                             label=f'no {name}')
        axes.grid(alpha=0.3)
        axes.set_xlim(*time((start_ns, end_ns)))
        axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.0), fontsize='small', frameon=False)
    figure.suptitle(literal(title))
    save_png(figure, path)


def _show_errors(axes, t, errors, sigmas, components):
    """Plot errors, and the bands in which the filter believes them."""
    for axis in components:
        colour, bound = COLOURS[NAMES[axis]], 3.0 * sigmas[:, axis]
        if len(components) == 3 and axis == 2 and not np.any(errors[:, axis]):
            # held by the altimeter: nothing to see
            continue
        if np.isfinite(bound).all() and bound.any():
            axes.fill_between(t, -bound, bound, color=colour, alpha=0.12, lw=0.0)
            for sign in (1.0, -1.0):
                axes.plot(t, sign * bound, color=colour, lw=0.6, alpha=0.7)
        axes.plot(t, errors[:, axis], color=colour, lw=1.0, label=NAMES[axis])
    if axes.collections:
        axes.fill_between([], [], [], color='0.4', alpha=0.25, label='3 sigma')


def _show_nis(axes, taken, sources, gate_probability, time):
    """Plot the NIS of each fix, the running mean of those taken, and where the gate is."""
    for source in sources:
        colour, name = SOURCES[source]
        fixes = [t for t in taken if t.source == source and t.outcome.nis is not None]
        if not fixes:
            continue
        freedom = fixes[0].outcome.freedom
        t = time([fix.t_ns for fix in fixes])
        nis = np.maximum([fix.outcome.nis / freedom for fix in fixes], 1e-3)
        good = np.array([fix.outcome.taken for fix in fixes])
        axes.plot(t[good], nis[good], '.', ms=3, alpha=0.5, color=colour, label=name)
        if not good.all():
            axes.plot(t[~good], nis[~good], 'x', ms=6, color='tab:red', label=f'{name}, refused')
        count = max(MEAN_OF, int(good.sum()) // SPANS)
        label = f'mean of {count}'
        for part in _unbroken(t[good]):
            if part.stop - part.start > count:
                mean = np.convolve(nis[good][part], np.full(count, 1.0 / count), 'valid')
                axes.plot(t[good][part][count - 1:], mean, color=colour, lw=1.6, label=label)
                label = None
        if gate_probability:
            axes.axhline(chi_square_limit(freedom, gate_probability) / freedom, color=colour,
                         ls='--',
                         lw=0.8, label='gate')
    axes.set_yscale('log')
    axes.axhline(1.0, color='k', lw=0.8)


def _unbroken(t):
    """Return the slices of sorted times between which fixes are missing."""
    steps = np.diff(t)
    ends = np.flatnonzero(steps > GAP * np.median(steps)) + 1 if len(steps) else []
    bounds = [0, *ends, len(t)]
    return [slice(*pair) for pair in zip(bounds, bounds[1:])]


def _silent(fixes, start_ns, end_ns):
    """Return the spans (first, last), ns, from a fix that is none to the next that is one."""
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
