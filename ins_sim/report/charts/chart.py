"""
Content of a figure: a Chart consists of Panels, which contain marks such as curves and bands.

A mark with label None is not in the legend. Values that are not finite interrupt a curve, as do
values that are not positive on a logarithmic axis. Colours are those of ``palette``; colour None
selects the next colour of the cycle (black for a Level, grey for a Stretch).
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
    """Stacked areas: parts (n, m) over x (n,), the first at the bottom."""

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
    An interval of the horizontal axis from first to last, shaded over the whole height.

    ``first`` and ``last`` are numbers, or arrays (n,) for several intervals.
    """

    first: Union[float, np.ndarray]
    last: Union[float, np.ndarray]
    label: str | None = None
    colour: str | None = None


@dataclass(frozen=True, eq=False)
class Map:
    """
    Colour map of values (rows, columns) over evenly spaced y (rows,) and x (columns,).

    ``unit`` labels the colour scale. Values of both signs get diverging colours about zero.
    """

    x: np.ndarray
    y: np.ndarray
    values: np.ndarray
    unit: str


Mark = Union[Curve, Markers, Band, Stack, Bars, Level, Stretch, Map]


@dataclass(frozen=True)
class Panel:
    """
    Marks on common axes, drawn in their order.

    Attributes
    ----------
    marks : tuple of marks; later ones cover earlier ones
    x_label, y_label : labels of the axes with units in brackets
    title : title of the panel
    x_scale, y_scale : LINEAR or LOG
    x_range, y_range : shown ranges, or None to fit the data
    equal : whether both axes have the same scale, for tracks
    height : height relative to the other panels of the chart
    note : text in the middle of the panel, such as the reason why it is empty
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

    Attributes
    ----------
    name : name of the file, without extension
    title : title in words
    panels : Panels from top to bottom, and from left to right if there are several columns
    shared : whether all panels have the same horizontal axis
    caption : sentence below the figure, or ''
    """

    name: str
    title: str
    panels: tuple[Panel, ...]
    shared: bool = True
    caption: str = ''
    columns: int = 1
