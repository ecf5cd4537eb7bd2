"""Draw the marks of a panel with Matplotlib."""

from functools import singledispatch

from matplotlib import colormaps
import numpy as np

from .chart import (Band, Bars, CIRCLE, CROSS, Curve, DASH_DOT, DASHED, DOT, DOTTED, Level, Map,
                    Markers, SOLID, Stack, Stretch, TRIANGLE)
from .extent import map_edges, positive
from .palette import map_colours
from .thinning import band_points, kept_points, thinned_curve

LINES = {SOLID: '-', DASHED: '--', DOTTED: ':', DASH_DOT: '-.'}
POINTS = {DOT: {'marker': 'o', 'markeredgewidth': 0.0}, CROSS: {'marker': 'x'},
          CIRCLE: {'marker': 'o', 'markerfacecolor': 'none'}, TRIANGLE: {'marker': '^'}}
PALE = 0.2


@singledispatch
def draw(mark, axes, panel):
    """Draw a mark, which must have a colour, on axes; return the image of a Map for its scale."""
    raise TypeError(f'{type(mark).__name__} is no mark')


@draw.register
def _(mark: Curve, axes, panel):
    x, y = _thinned(mark, panel)
    axes.plot(x, y, LINES[mark.dash], color=mark.colour, lw=mark.width, label=mark.label)


@draw.register
def _(mark: Markers, axes, panel):
    x, y = _thinned(mark, panel)
    axes.plot(x, y, ls='none', color=mark.colour, ms=mark.size, label=mark.label,
              **POINTS[mark.marker])


@draw.register
def _(mark: Band, axes, panel):
    kept = band_points(mark.x, mark.low, mark.high)
    x, low, high = (np.asarray(values, dtype=float)[kept]
                    for values in (mark.x, mark.low, mark.high))
    axes.fill_between(x, low, high, color=mark.colour, alpha=PALE, lw=0.0, label=mark.label)


@draw.register
def _(mark: Stack, axes, panel):
    kept = kept_points(mark.x, np.sum(mark.parts, axis=1))
    x, tops = np.asarray(mark.x)[kept], np.cumsum(np.asarray(mark.parts)[kept], axis=1)
    below = np.zeros(len(kept))
    for top, colour, label in reversed(list(zip(tops.T, mark.colours, mark.labels))):
        # Draw from the top, in the order of the legend; lower areas cover higher ones.
        axes.fill_between(x, below, top, color=colour, lw=0.0, label=label)


@draw.register
def _(mark: Bars, axes, panel):
    places = range(len(mark.values))
    axes.barh(places, mark.values, color=mark.colour, height=0.7)
    axes.set_yticks(places, mark.labels)
    axes.invert_yaxis()


@draw.register
def _(mark: Level, axes, panel):
    line = axes.axvline if mark.y is None else axes.axhline
    line(mark.x if mark.y is None else mark.y, ls=LINES[mark.dash], color=mark.colour, lw=1.0,
         label=mark.label)


@draw.register
def _(mark: Stretch, axes, panel):
    label = mark.label
    for first, last in zip(np.atleast_1d(mark.first), np.atleast_1d(mark.last)):
        axes.axvspan(first, last, color=mark.colour, alpha=PALE, lw=0.0, label=label)
        label = None


@draw.register
def _(mark: Map, axes, panel):
    name, low, high = map_colours(mark.values)
    return axes.imshow(mark.values, origin='lower', aspect='auto', cmap=colormaps[name], vmin=low,
                       vmax=high, extent=(*map_edges(mark.x), *map_edges(mark.y)),
                       interpolation='nearest')


def _thinned(mark, panel):
    return thinned_curve(positive(mark.x, panel.x_scale), positive(mark.y, panel.y_scale))
