"""
What a figure shows: a Chart of Panels, one below the other, of marks.

A label of None leaves a mark out of the legend. Values that are not finite interrupt a curve, as
do those that are not positive on a logarithmic axis. Colours are those of ``palette``; a colour of
None is the next one of its cycle, of a Level or a Stretch black or grey.
"""

from dataclasses import dataclass
from typing import Union

import numpy as np

SOLID, DASHED, DOTTED, DASH_DOT = 'solid', 'dashed', 'dotted', 'dotdash'
LINEAR, LOG = 'linear', 'log'
DOT, CROSS, CIRCLE, TRIANGLE = 'dot', 'cross', 'circle', 'triangle'


@dataclass(frozen=True, eq=False)
class Curve:
    """A line through x, y (n,); dash: one of SOLID, DASHED, DOTTED, DASH_DOT; width: in points."""

    x: np.ndarray
    y: np.ndarray
    label: str | None = None
    colour: str | None = None
    dash: str = SOLID
    width: float = 1.5


@dataclass(frozen=True, eq=False)
class Markers:
    """Points x, y (n,); marker: one of DOT, CROSS, CIRCLE, TRIANGLE; size: in points."""

    x: np.ndarray
    y: np.ndarray
    label: str | None = None
    colour: str | None = None
    marker: str = DOT
    size: float = 4.0


@dataclass(frozen=True, eq=False)
class Band:
    """The surface between two curves low and high (n,) over x, pale."""

    x: np.ndarray
    low: np.ndarray
    high: np.ndarray
    label: str | None = None
    colour: str | None = None


@dataclass(frozen=True, eq=False)
class Stack:
    """Surfaces on top of each other: parts (n, m) over x (n,), the first at the bottom."""

    x: np.ndarray
    parts: np.ndarray
    labels: tuple[str, ...]
    colours: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Bars:
    """Horizontal bars: values (n,), the first at the top, with their labels."""

    values: np.ndarray
    labels: tuple[str, ...]
    colour: str | None = None


@dataclass(frozen=True)
class Level:
    """A straight line across the panel at y, or at x."""

    y: float | None = None
    x: float | None = None
    label: str | None = None
    colour: str | None = None
    dash: str = SOLID


@dataclass(frozen=True, eq=False)
class Stretch:
    """
    The stretch of the horizontal axis from first to last, shaded over the whole height.

    first, last: numbers, or arrays (n,) of several stretches.
    """

    first: Union[float, np.ndarray]
    last: Union[float, np.ndarray]
    label: str | None = None
    colour: str | None = None


@dataclass(frozen=True, eq=False)
class Map:
    """
    Values (rows, columns) over y (rows,) and x (columns,), evenly spaced, as colours.

    unit: of the values, for the scale of colours. Diverging colours about zero where values have
    both signs.
    """

    x: np.ndarray
    y: np.ndarray
    values: np.ndarray
    unit: str


Mark = Union[Curve, Markers, Band, Stack, Bars, Level, Stretch, Map]


@dataclass(frozen=True)
class Panel:
    """
    Marks over common axes, in their order, the first lowest.

    x_label, y_label: with units in brackets; title; x_scale, y_scale: LINEAR or LOG; x_range,
    y_range: what is shown, or None; equal: whether a unit is as long on both axes, for tracks;
    height: relative to the other panels of the chart; note: a text in the middle of the panel,
    such as why it is empty.
    """

    marks: tuple[Mark, ...]
    x_label: str
    y_label: str
    title: str = ''
    x_scale: str = LINEAR
    y_scale: str = LINEAR
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    equal: bool = False
    height: float = 1.0
    note: str = ''


@dataclass(frozen=True)
class Chart:
    """
    One figure.

    name: of its file, without extension; title: what it shows, in words; panels: from above, and
    from the left if there are several columns; they have one horizontal axis if shared; caption: a
    sentence below it, or ''.
    """

    name: str
    title: str
    panels: tuple[Panel, ...]
    shared: bool = True
    caption: str = ''
    columns: int = 1
