"""The range of the axes of a panel."""

from ins_sim.report.charts.chart import Curve, Level, LOG, Map, Panel
from ins_sim.report.charts.extent import equal_ranges, horizontal_range, vertical_range
from ins_sim.report.charts.palette import coloured, CYCLE, DIVERGING, map_colours, SEQUENTIAL
import numpy as np
import pytest

X = np.array([0.0, 1.0, 2.0])


def panel(*marks, **options):
    """Return a Panel of marks."""
    return Panel(marks, 'x', 'y', **options)


def test_all_values_are_shown():
    """Curves fill the width, levels are included, and values that are not finite are ignored."""
    one = panel(Curve(X, np.array([1.0, np.nan, 3.0])), Level(y=-5.0))
    low, high = vertical_range(one)
    assert low < -5.0 and high > 3.0 and high - low < 1.1 * 8.0
    assert horizontal_range((one,)) == (0.0, 2.0)
    assert horizontal_range((one, panel(Curve(X + 5.0, X)))) == (0.0, 7.0)


def test_given_ranges_are_kept():
    """Given ranges are used for any data."""
    one = panel(Curve(X, X), x_range=(0.5, 1.0), y_range=(2.0, 3.0))
    assert horizontal_range((one,)) == (0.5, 1.0) and vertical_range(one) == (2.0, 3.0)


def test_a_logarithmic_axis_shows_positive_values():
    """Zero and negative values are left out of a logarithmic axis."""
    low, high = vertical_range(panel(Curve(X, np.array([-1.0, 0.1, 10.0])), y_scale=LOG))
    assert 0.0 < low < 0.1 and 10.0 < high < 20.0


@pytest.mark.parametrize('shape', [0.3, 1.0, 3.0])
def test_equal_axes_have_one_scale_and_show_all(shape):
    """One unit is equally long on both axes of a panel of any shape."""
    (left, right), (bottom, top) = equal_ranges(
        panel(Curve(np.array([0.0, 40.0]), np.array([-5.0, 5.0])), equal=True), shape)
    assert (right - left) / (top - bottom) == pytest.approx(shape)
    assert left <= 0.0 and right >= 40.0 and bottom <= -5.0 and top >= 5.0


def test_marks_take_colours_in_turn():
    """A mark without a colour gets the next one of the cycle; a given colour is kept."""
    marks = coloured([Curve(X, X), Curve(X, X, colour='#123456'), Curve(X, X), Level(y=0.0)])
    assert [mark.colour for mark in marks] == [CYCLE[0], '#123456', CYCLE[1], '#000000']


def test_maps_of_both_signs_are_white_at_zero():
    """The colour scale of a map with both signs is symmetric; otherwise it covers the values."""
    def of(*values):
        return map_colours(Map(X, X[:1], np.array([values]), 'm').values)

    assert of(-1.0, 0.5, np.nan) == (DIVERGING, -1.0, 1.0)
    assert of(1.0, 3.0, 2.0) == (SEQUENTIAL, 1.0, 3.0)
    name, low, high = of(2.0, 2.0, 2.0)
    assert name == SEQUENTIAL and low < high
