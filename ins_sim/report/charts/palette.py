"""The colours of all figures, which the colour-blind can tell apart."""

from dataclasses import replace
from itertools import cycle

import numpy as np

from .chart import Level, Map, Stack, Stretch

# Okabe and Ito, "Color Universal Design" (2008), without the yellow, which is pale on white.
BLUE, ORANGE, GREEN, RED = '#0072b2', '#e69f00', '#009e73', '#d55e00'
PURPLE, SKY, BLACK, GREY = '#cc79a7', '#56b4e9', '#000000', '#7f7f7f'
# In the order in which curves take them.
CYCLE = (BLUE, RED, GREEN, PURPLE, ORANGE, SKY, BLACK, GREY)
EAST_NORTH_UP = {'east': RED, 'north': BLUE, 'up': GREEN}
BODY_AXES = {'x': RED, 'y': BLUE, 'z': GREEN}
# Matplotlib's names of the colours of maps: from dark to bright, and from both sides of white.
SEQUENTIAL, DIVERGING = 'viridis', 'PuOr_r'


def coloured(marks):
    """Return the marks of a panel with a colour of its own for each whose colour is None."""
    colours, found = cycle(CYCLE), []
    for mark in marks:
        if isinstance(mark, Stack):
            if not mark.colours:
                mark = replace(mark, colours=tuple(next(colours) for _ in mark.labels))
        elif isinstance(mark, (Level, Stretch)):
            mark = replace(mark, colour=mark.colour or (
                BLACK if isinstance(mark, Level) else GREY))
        elif not isinstance(mark, Map) and mark.colour is None:
            mark = replace(mark, colour=next(colours))
        found.append(mark)
    return found


def map_colours(values):
    """
    Return (Matplotlib's name of colours, lowest, highest value) of the values of a Map.

    Values of both signs have white at zero and as much on either side.
    """
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if low < 0.0 < high:
        most = max(-low, high)
        return DIVERGING, -most, most
    return SEQUENTIAL, low, high if high > low else low + (abs(low) or 1.0)
