"""Colours of all figures; colour-blind readers can distinguish them."""

from dataclasses import replace
from itertools import cycle

import numpy as np

from .chart import Level, Map, Stack, Stretch

# Okabe and Ito, "Color Universal Design" (2008), without the yellow, which is pale on white.
BLUE, ORANGE, GREEN, RED = '#0072b2', '#e69f00', '#009e73', '#d55e00'
PURPLE, SKY, BLACK, GREY = '#cc79a7', '#56b4e9', '#000000', '#7f7f7f'
# The order in which curves use them.
CYCLE = (BLUE, RED, GREEN, PURPLE, ORANGE, SKY, BLACK, GREY)
EAST_NORTH_UP = {'east': RED, 'north': BLUE, 'up': GREEN}
BODY_AXES = {'x': RED, 'y': BLUE, 'z': GREEN}
# Names of Matplotlib colour maps: from dark to bright, and diverging from white.
SEQUENTIAL, DIVERGING = 'viridis', 'PuOr_r'


def coloured(marks):
    """Return the marks of a panel; marks without a colour get one of the cycle."""
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
    Return (name of the Matplotlib colour map, lowest, highest value) for the values of a Map.

    For values of both signs, white is at zero and the range is symmetric.
    """
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if low < 0.0 < high:
        most = max(-low, high)
        return DIVERGING, -most, most
    return SEQUENTIAL, low, high if high > low else low + (abs(low) or 1.0)
