"""Charts of the closed-loop study: flights over time, and the stability map."""

from itertools import cycle, islice, product

import numpy as np

from ins_sim.studies.stability_map import MOST_K_Z
from ..charts import palette
from ..charts.chart import (Chart, CIRCLE, CROSS, Curve, DASH_DOT, DASHED, DOTTED, LOG, Markers,
                            Panel, SOLID)
from ..charts.scales import LENGTHS, scale, TIMES

DASHES = (SOLID, DASHED, DOTTED, DASH_DOT)
GAINS = {('conventional', True): 'K_v [1/s]', ('conventional', False): 'gain of a fix',
         ('paper_corrected', False): 'K'}


def histories_chart(name, title, labels, flights):
    """Return the Chart of LoopFlights: sideslip, offset, and error of the estimated offset."""
    per_s, time_unit = scale(TIMES, max(float(f.t_s[-1]) for f in flights))
    per_m, unit = scale(LENGTHS, max(float(np.abs(f.z).max()) for f in flights))
    off_per_m, off_unit = scale(LENGTHS, max(float(np.abs(f.z_estimated - f.z).max())
                                             for f in flights))
    sideslip, offset, error = [], [], []
    for label, flight, (dash, colour) in zip(labels, flights, styles(len(flights))):
        t = flight.t_s * per_s
        sideslip.append(Curve(t, np.degrees(flight.beta), label, colour, dash, 1.0))
        offset.append(Curve(t, flight.z * per_m, None, colour, dash, 1.0))
        error.append(Curve(t, (flight.z_estimated - flight.z) * off_per_m, None, colour, dash,
                           1.0))
    x_label = f'time [{time_unit}]'
    return Chart(name, title, (
        Panel(tuple(sideslip), x_label, 'sideslip [deg]', height=1.5),
        Panel(tuple(offset), x_label, f'offset from the leg [{unit}]'),
        Panel(tuple(error), x_label, f'estimated less true offset [{off_unit}]')))


def styles(count):
    """Return (dash, colour) for ``count`` curves, distinct as long as there are enough."""
    return list(islice(cycle(product(DASHES, palette.CYCLE)), count))


def map_chart(panels, curves):
    """Return the Chart of the stability map: MapPanels and the MapCurves of each."""
    groups = {}
    for panel, found in zip(panels, curves):
        groups.setdefault((panel.kind, panel.slides), []).append((panel, found))
    return Chart('map', 'Stability of the loop: stable below the line, unstable above it',
                 tuple(_map_panel(group, members) for group, members in groups.items()),
                 shared=False, caption='No line and no mark where the loop is stable up to k_z = '
                 f'{MOST_K_Z:g}; z0: the offset at the start of a flight.')


def _map_panel(group, members):
    """Return the Panel of a group of filters: limits by linear theory and by flights."""
    kind, slides = group
    marks = []
    for (panel, found), colour in zip(members, cycle(palette.CYCLE)):
        marks.append(Curve(found.gains, _inside(found.linear), f'N {panel.cycles}, linear limit',
                           colour))
        for (start, limits), marker in zip(found.flown.items(), (CIRCLE, CROSS)):
            marks.append(Markers(found.gains, _inside(limits),
                                 f'N {panel.cycles}, flown from z0 = {start:g} m', colour, marker,
                                 6.0))
    name = 'sliding conventional' if slides else kind
    return Panel(tuple(marks), GAINS[group], 'limit of k_z', name, x_scale=LOG,
                 y_range=(0.0, MOST_K_Z))


def _inside(limits):
    """Return limits of k_z, NaN if the loop is stable up to MOST_K_Z."""
    return np.where(limits < MOST_K_Z, limits, np.nan)


def map_answer(curves):
    """Return a sentence about MapCurves: differences of flown and linear limits."""
    words = []
    for start in curves[0].flown:
        off = np.concatenate([_inside(c.flown[start]) - _inside(c.linear) for c in curves])
        off = off[np.isfinite(off)]
        if len(off):
            words.append(f'from {start:g} m by {off.min():+.3f} to {off.max():+.3f}')
    if not words:
        return 'On the map the loop is stable throughout.'
    return ('On the map the limit of k_z by flights differs from the linear one: in flights '
            + ', '.join(words) + '.')
