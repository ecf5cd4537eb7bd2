"""Legend of a panel as HTML, which wraps to the width of the page."""

from matplotlib import colormaps
from matplotlib.colors import to_hex

from ..charts.chart import (Band, CIRCLE, CROSS, Curve, DASH_DOT, DASHED, DOT, DOTTED,
                            Level, Map, Markers, SOLID, Stack, Stretch, TRIANGLE)
from ..charts.palette import map_colours
from .words import text

DASHES = {SOLID: '', DASHED: '7 3', DOTTED: '2 3', DASH_DOT: '7 3 2 3'}
POINTS = {DOT: '<circle cx="14" cy="6" r="3.5" fill="{0}"/>',
          CIRCLE: '<circle cx="14" cy="6" r="4" fill="none" stroke="{0}" stroke-width="1.5"/>',
          CROSS: '<path d="M10 2l8 8m0-8l-8 8" stroke="{0}" stroke-width="1.5"/>',
          TRIANGLE: '<path d="M14 1l5 9h-10z" fill="{0}"/>'}


def legend(marks):
    """Return the legend of marks, which must have colours, or ''."""
    items = [f'<li><svg viewBox="0 0 28 12" aria-hidden="true">{swatch}</svg>{text(label)}</li>'
             for mark in marks for swatch, label in _entries(mark) if label]
    return f'<ul class="legend">{"".join(items)}</ul>' if items else ''


def _entries(mark):
    """Yield (swatch, label) of a mark."""
    if isinstance(mark, Stack):
        # List from the top, in the order of the stacked areas.
        for colour, label in reversed(list(zip(mark.colours, mark.labels))):
            yield _surface(colour, 1.0), label
    elif isinstance(mark, (Curve, Level)):
        dash = DASHES[mark.dash]
        yield (f'<path d="M0 6h28" stroke="{text(mark.colour)}" stroke-width="2"'
               + (f' stroke-dasharray="{dash}"' if dash else '') + '/>', mark.label)
    elif isinstance(mark, Markers):
        yield POINTS[mark.marker].format(text(mark.colour)), mark.label
    elif isinstance(mark, (Band, Stretch)):
        yield _surface(mark.colour, 0.25), mark.label
    elif isinstance(mark, Map):
        name, _, _ = map_colours(mark.values)
        yield ''.join(f'<rect x="{4 * k}" width="4" height="12" fill="{to_hex(colour)}"/>'
                      for k, colour in enumerate(colormaps[name](range(18, 256, 36)))), mark.unit


def _surface(colour, opacity):
    return f'<rect width="28" height="12" fill="{text(colour)}" fill-opacity="{opacity}"/>'
