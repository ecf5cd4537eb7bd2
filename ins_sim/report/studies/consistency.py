"""NEES and NIS over runs against time, and where they lie in their intervals."""

from typing import NamedTuple

from ins_sim.core.ensemble.consistency import ChiSquareSums
import numpy as np

from ..charts.chart import Band, Curve, DASHED, Level, Markers, Panel, SOLID
from ..charts.palette import BLACK, GREY
from ..consistency import sum_intervals

# What the blocks of states are called in tables and legends.
WORDS = {'position': 'position', 'velocity': 'velocity', 'attitude': 'attitude',
         'state': 'all states that are estimated'}

WITHIN = '95 % of consistent filters'
# In parts of what is expected.
MOST_SHOWN = 30.0


def per_state(sums):
    """Return mean, low and high of ChiSquareSums, each over its degrees of freedom, arrays."""
    expected = sums.expected
    return (sums.mean / expected, *(bound / expected for bound in sum_intervals(sums)))


class Entry(NamedTuple):
    """A filter or an instrument in a panel: ChiSquareSums (n,) at instants x (n,), and style."""

    label: str
    x: np.ndarray
    sums: ChiSquareSums
    colour: str
    dash: str = SOLID


def consistency_panel(entries, x_label, title, y_label, fixes=False):
    """
    Return the Panel of NEES or NIS over time, each over its degrees of freedom.

    entries: list of Entry, those with the same freedom having one band; fixes: whether instants
    are those of fixes, drawn as points, since each is independent of the one before.
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
    # An outlier does not flatten the rest.
    return Panel(tuple(marks), x_label, y_label, title,
                 y_range=(0.0, float(min(1.3 * max(tops), MOST_SHOWN))))


def judged(mean, low, high):
    """Return in words where a mean lies, or '' where there is none."""
    if mean is None or not np.isfinite(mean):
        return ''
    if mean > high:
        return 'too optimistic'
    return 'too pessimistic' if mean < low else 'consistent'


def inside_share(sums):
    """Return which part of the instants lies inside the 95 % interval, and of how many."""
    there = sums.count > 0
    low, high = sum_intervals(sums)
    with np.errstate(invalid='ignore'):
        inside = (sums.mean >= low) & (sums.mean <= high)
    count = int(np.count_nonzero(there))
    return (np.count_nonzero(inside & there) / count if count else np.nan), count
