"""Draw the marks of a panel with Bokeh."""

from functools import singledispatch

from bokeh.models import ColorBar, LinearColorMapper, Span
from matplotlib import colormaps
from matplotlib.colors import to_hex
import numpy as np

from ins_sim.visible_text import visible
from ..charts.chart import (Band, Bars, CIRCLE, CROSS, Curve, DOT, Level, Map, Markers, Stack,
                            Stretch, TRIANGLE)
from ..charts.extent import horizontal_range, map_edges, positive
from ..charts.palette import map_colours
from ..charts.thinning import band_points, kept_points, thinned_curve

# Screen pixels per point.
PIXELS = 4.0 / 3.0
POINTS = {DOT: 'circle', CROSS: 'x', CIRCLE: 'circle', TRIANGLE: 'triangle'}
PALE = 0.25
# Single precision suffices if the values spread over at least this part of the largest one.
SPREAD = 1e-3


@singledispatch
def draw(mark, drawn, panel):
    """Draw a mark, which must have a colour, into a Bokeh figure."""
    raise TypeError(f'{type(mark).__name__} is no mark')


@draw.register
def _(mark: Curve, drawn, panel):
    x, y = _thinned(mark, panel)
    drawn.line(x, y, line_color=mark.colour, line_dash=mark.dash, line_width=mark.width)


@draw.register
def _(mark: Markers, drawn, panel):
    x, y = _thinned(mark, panel)
    drawn.scatter(x, y, marker=POINTS[mark.marker], size=PIXELS * mark.size,
                  line_color=None if mark.marker == DOT else mark.colour,
                  fill_color=None if mark.marker == CIRCLE else mark.colour)


@draw.register
def _(mark: Band, drawn, panel):
    kept = band_points(mark.x, mark.low, mark.high)
    x, low, high = (_packed(np.asarray(values)[kept]) for values in (mark.x, mark.low, mark.high))
    drawn.varea(x, low, high, fill_color=mark.colour, fill_alpha=PALE)


@draw.register
def _(mark: Stack, drawn, panel):
    parts = np.asarray(mark.parts, dtype=float)
    kept = kept_points(mark.x, np.sum(parts, axis=1))
    x, tops = _packed(np.asarray(mark.x)[kept]), np.cumsum(parts[kept], axis=1)
    below = np.zeros(len(kept))
    for top, colour in zip(tops.T, mark.colours):
        drawn.varea(x, _packed(below), _packed(top), fill_color=colour)
        below = top


@draw.register
def _(mark: Bars, drawn, panel):
    places = np.arange(len(mark.values))
    # Bokeh does not draw bars that begin at zero on a logarithmic axis.
    edge = max(0.0, horizontal_range((panel,))[0])
    drawn.hbar(y=places + 0.18, left=edge, right=np.asarray(mark.values, dtype=float), height=0.42,
               fill_color=mark.colour, line_color=None)
    # The labels are above the bars, where they fit at any width of the page.
    drawn.text([edge] * len(places), places - 0.24, [visible(label) for label in mark.labels],
               text_baseline='middle', text_font_size='12px', x_offset=4)
    drawn.yaxis.visible = drawn.ygrid.visible = False


@draw.register
def _(mark: Level, drawn, panel):
    vertical = mark.y is None
    drawn.add_layout(Span(location=float(mark.x if vertical else mark.y), line_dash=mark.dash,
                          dimension='height' if vertical else 'width', line_color=mark.colour,
                          line_width=1.2))


@draw.register
def _(mark: Stretch, drawn, panel):
    first, last = (np.atleast_1d(np.asarray(values, dtype=float))
                   for values in (mark.first, mark.last))
    drawn.vstrip(first, last, line_color=None, fill_color=mark.colour, fill_alpha=PALE,
                 level='underlay')


@draw.register
def _(mark: Map, drawn, panel):
    values = np.asarray(mark.values)
    name, low, high = map_colours(values)
    colours = LinearColorMapper([to_hex(colour) for colour in colormaps[name](range(256))],
                                low=low, high=high, nan_color='#dddddd')
    (left, right), (bottom, top) = map_edges(mark.x), map_edges(mark.y)
    drawn.image([values.astype(np.float32)], x=left, y=bottom, dw=right - left, dh=top - bottom,
                color_mapper=colours)
    drawn.add_layout(ColorBar(color_mapper=colours, width=12), 'right')


def _thinned(mark, panel):
    return map(_packed, thinned_curve(positive(mark.x, panel.x_scale),
                                      positive(mark.y, panel.y_scale)))


def _packed(values):
    """Return the numbers in single precision if no visible detail is lost."""
    finite = values[np.isfinite(values)]
    if finite.size and np.ptp(finite) < SPREAD * np.abs(finite).max():
        return values.astype(np.float64)
    return values.astype(np.float32)
