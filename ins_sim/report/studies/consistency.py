"""Panels of NEES and NIS of several runs over time, with their intervals."""

from typing import NamedTuple

from ins_sim.core.ensemble.consistency import ChiSquareSums
import numpy as np

from ..charts.chart import Band, Curve, DASHED, Level, Markers, Panel, SOLID
from ..charts.palette import BLACK, GREY
from ..consistency import sum_intervals

# Names of the blocks of states in tables and legends.
WORDS = {'position': 'position', 'velocity': 'velocity', 'attitude': 'attitude',
         'state': 'all states that are estimated'}

WITHIN = '95 % of consistent filters'
# Upper end of the axis, relative to the expected value.
MOST_SHOWN = 30.0


def per_state(sums):
    """Return mean, low and high of ChiSquareSums, each over its degrees of freedom, arrays."""
    expected = sums.expected
    return (sums.mean / expected, *(bound / expected for bound in sum_intervals(sums)))


class Entry(NamedTuple):
    """Curve of a filter or sensor: ChiSquareSums (n,) at instants x (n,), label and style."""

    label: str
    x: np.ndarray
    sums: ChiSquareSums
    colour: str
    dash: str = SOLID


def consistency_panel(entries, x_label, title, y_label, fixes=False):
    """
    Return the Panel of NEES or NIS over time, each over its degrees of freedom.

    ``entries`` is a list of Entry; those with equal degrees of freedom share a band. If ``fixes``
    is true, the instants are those of fixes, which are independent and drawn as points.
    """
    marks, banded, tops = [], set(), [2.0]
    for label, x, sums, colour, dash in entries:
        mean, low, high = per_state(sums)
        there = np.isfinite(mean)
        x, mean, low, high = x[there], mean[there], low[there], high[there]
        freedom = int(sums.freedom.max())
        if freedom not in banded:
            marks.append(Band(x, low, high, None if banded else WITHIN, GREY))
            banded.add(freedom)
        if fixes:
            marks.append(Markers(x, mean, label, colour, size=3.0))
        else:
            marks.append(Curve(x, mean, label, colour, dash))
        tops += [np.percentile(mean, 95.0), high.max()]
    marks.append(Level(y=1.0, label='expected', colour=BLACK, dash=DASHED))
    # Limit the axis, so that an outlier does not compress the rest.
    return Panel(tuple(marks), x_label, y_label, title,
                 y_range=(0.0, float(min(1.3 * max(tops), MOST_SHOWN))))


def judged(mean, low, high):
    """Return in words whether a mean is inside its interval, or '' if there is no mean."""
    if mean is None or not np.isfinite(mean):
        return ''
    if mean > high:
        return 'too optimistic'
    return 'too pessimistic' if mean < low else 'consistent'


def inside_share(sums):
    """Return the share of instants inside the 95 % interval, and the number of instants."""
    there = sums.count > 0
    low, high = sum_intervals(sums)
    with np.errstate(invalid='ignore'):
        inside = (sums.mean >= low) & (sums.mean <= high)
    count = int(np.count_nonzero(there))
    return (np.count_nonzero(inside & there) / count if count else np.nan), count
