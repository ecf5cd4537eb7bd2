"""Charts of the navigation on a recording: errors, gaps and the track."""

from dataclasses import replace

import numpy as np
import pytest
from support.readings.recorded_imu import recorded, run, SECOND, stamps

from ins_sim.core.postprocessing.reference import SampledTrack
from ins_sim.report.charts.chart import Curve, Markers, Stretch
from ins_sim.report.navigation_charts import navigation_charts

FACTOR = 3.0


def with_gap(length_s):
    """Return stamps of 20 s at 100 Hz with a gap from 9 s on."""
    t_ns = stamps(100.0)
    return t_ns[(t_ns <= 9 * SECOND) | (t_ns >= 9 * SECOND + round(length_s * SECOND))]


def drawn(result, name='navigation'):
    """Return the Chart with a name."""
    return next(c for c in navigation_charts('a flight', result, FACTOR) if c.name == name)


def marks(chart, kind):
    """Return the marks of a class in the first panel of a chart."""
    return [mark for mark in chart.panels[0].marks if isinstance(mark, kind)]


@pytest.fixture(scope='module')
def navigated():
    """Return the navigation on a record without a gap."""
    return run(*recorded(stamps(100.0)))


def known(result, **values):
    """Return the result with a constant error (3,) for each kind."""
    comparison, = result.comparisons
    t_ns = comparison.position.t_ns
    return replace(result, comparisons=[replace(comparison, **{
        kind: SampledTrack(t_ns, np.tile(np.array(error, float), (len(t_ns), 1)))
        for kind, error in values.items()})])


def test_errors_have_the_units_in_which_they_read_well(navigated):
    """
    Errors from 10 km on are drawn in km; horizontal and up share a panel.

    Headings are clockwise.
    """
    chart = drawn(known(navigated, position=(3e4, 4e4, -2e4), velocity=(0.3, 0.4, 0.2),
                        attitude=(np.radians(3.0), 0.0, np.radians(-5.0))))
    assert chart.title == 'Solution of the strapdown on a flight at 100 Hz, less truth'
    assert [panel.y_label for panel in chart.panels] == [
        'position error [km]', 'velocity error [m/s]', 'attitude error [deg]']
    found = [{mark.label: mark.y[0] for mark in panel.marks if isinstance(mark, Curve)}
             for panel in chart.panels]
    assert found[0] == pytest.approx({'horizontal position': 50.0, 'height': -20.0})
    assert found[1] == pytest.approx({'horizontal velocity': 0.5, 'vertical velocity': 0.2})
    assert found[2] == pytest.approx({'tilt': 3.0, 'heading': 5.0})
    assert chart.panels[0].x_label == 'time since the start [s]'


def test_a_part_that_would_hide_the_other_has_its_own_panel(navigated):
    """A height error that grows fast has its own panel, so that the horizontal one is readable."""
    chart = drawn(known(navigated, position=(30.0, 40.0, 2e4)))
    assert [panel.y_label for panel in chart.panels][:2] == ['horizontal position error [m]',
                                                             'height error [km]']
    first, = marks(chart, Curve)
    assert first.label is None and first.y == pytest.approx(50.0)


def test_an_error_that_is_not_known_has_no_panel(navigated):
    """Without an attitude in the reference there is no panel of attitude errors."""
    comparison, = navigated.comparisons
    chart = drawn(replace(navigated, comparisons=[replace(comparison, attitude=None)]))
    assert not any('tilt' in p.y_label or 'attitude' in p.y_label for p in chart.panels)


def test_two_references_are_told_apart(navigated):
    """Two references differ by name and dash, with the colours of the components."""
    comparison, = navigated.comparisons
    both = replace(navigated, comparisons=[comparison, replace(comparison, name='odometry')],
                   references=[*navigated.references, navigated.references[0]])
    lines = marks(drawn(both), Curve)
    assert {mark.label.rpartition(', ')[2] for mark in lines} == {'truth', 'odometry'}
    assert len({(mark.colour, mark.dash) for mark in lines}) == len(lines)


def test_gaps_are_shaded(navigated):
    """Between segments nothing is drawn; a bridged gap is labelled as such."""
    assert marks(drawn(navigated), Stretch) == []
    restarted = drawn(run(*recorded(with_gap(0.5)), on_gap='restart'))
    stretch, = marks(restarted, Stretch)
    assert (stretch.first, stretch.last) == pytest.approx((8.0, 8.5))
    assert stretch.label == 'no solution'
    stretch, = marks(drawn(run(*recorded(with_gap(0.5)), on_gap='bridge')), Stretch)
    assert (stretch.first, stretch.last) == pytest.approx((8.0, 8.5))
    assert stretch.label == 'gap, bridged'


def test_a_curve_is_interrupted_where_nothing_is_known_for_long():
    """A curve is interrupted where the reference is silent for 6 s."""
    imu, reference = recorded(stamps(100.0))
    heard = (reference.position.t_ns < 5 * SECOND) | (reference.position.t_ns > 11 * SECOND)
    position = SampledTrack(reference.position.t_ns[heard], reference.position.values[heard])
    line = marks(drawn(run(imu, replace(reference, position=position))), Curve)[0]
    breaks = np.flatnonzero(np.isnan(line.y))
    assert len(breaks) == 1 and line.x[breaks[0] - 1] < 4.0 and line.x[breaks[0] + 1] > 10.0


def test_the_track_has_equal_axes(navigated):
    """Solution and reference are drawn in metres from one origin; without errors they coincide."""
    panel, = drawn(navigated, 'track').panels
    assert panel.equal and panel.x_label == 'east of the start [m]'
    solution, reference = (mark for mark in panel.marks if isinstance(mark, Curve))
    assert (solution.label, reference.label) == ('solution', 'truth')
    assert solution.x[0] == solution.y[0] == 0.0
    assert reference.x[-1] == pytest.approx(solution.x[-1], abs=0.1)
    start, = (mark for mark in panel.marks if isinstance(mark, Markers))
    assert start.label == 'start'


def test_a_solution_that_leaves_its_reference_has_a_second_panel(navigated):
    """A diverging solution has a second panel; otherwise the reference would shrink to a dot."""
    states, = navigated.states
    away = replace(states, lat=states.lat + np.linspace(0.0, 0.01, len(states.lat)))
    far, near = drawn(replace(navigated, states=[away]), 'track').panels
    assert far.y_label.endswith('[km]') and near.y_label.endswith('[m]') and near.equal
    solution, reference = (mark for mark in near.marks if isinstance(mark, Curve))
    size = max(np.abs(reference.x).max(), np.abs(reference.y).max())
    assert np.isnan(solution.y[-1]) and np.nanmax(np.abs(solution.y)) <= 1.2 * size


def test_without_a_reference_the_solution_is_drawn(navigated):
    """Without a reference, velocity and height are drawn, and no error is stated."""
    alone = replace(navigated, comparisons=[], references=[])
    chart = drawn(alone)
    assert [panel.y_label for panel in chart.panels] == ['velocity [m/s]', 'height [m]']
    assert [mark.label for mark in marks(chart, Curve)] == ['east', 'north', 'up']
    assert len([m for m in drawn(alone, 'track').panels[0].marks if isinstance(m, Curve)]) == 1
