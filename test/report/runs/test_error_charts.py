"""The figures of a run: suitable units, and a prediction only if it is meaningful."""

from dataclasses import replace

import ins_sim
from ins_sim.core.timeseries.histories import NavErrors
from ins_sim.report.charts.chart import Level
from ins_sim.report.runs.curves import history_curves, interpolated
from ins_sim.report.runs.error_charts import delay_chart, error_chart
from ins_sim.report.summary import DEG_PER_HOUR
from ins_sim.report.runs.track import run_tracks, track_chart
import numpy as np
import pytest


@pytest.fixture(scope='module')
def motion_2():
    """Return a run of motion 2 with its delay, and its Prediction."""
    settings = ins_sim.read_settings(['motion_2', 'delay_y_1us'], {'duration_s': 60.0})
    run = ins_sim.simulate(settings, twin=False)
    return run, ins_sim.predict(settings)


def errors(size, n=1000):
    """Return NavErrors of a given size: m, m/s, rad, rad/s."""
    ramp = np.linspace(0.0, size, n)[:, None] * np.array([1.0, -0.5, 0.0])
    return NavErrors(np.arange(n, dtype=np.int64) * 10 ** 9, ramp * 1e-6, ramp, ramp, ramp * 1e-9)


def labels(panel):
    """Return the labels of the marks of a panel."""
    return [mark.label for mark in panel.marks if mark.label]


def test_a_prediction_that_fits_has_a_panel_of_what_it_leaves(motion_2):
    """If prediction and run agree, the difference is drawn separately, a thousand times larger."""
    run, prediction = motion_2
    chart = error_chart('t', run.errors, prediction)
    position, residual, _, drift = chart.panels
    assert labels(position) == ['east', 'north', 'linear prediction']
    assert labels(residual) == ['east', 'north']
    # The panel is in mm: the difference is within the bound of the prediction.
    left = max(np.abs(mark.y).max() for mark in residual.marks)
    assert 0.0 < left < 0.05 * 57.5
    assert [mark.y for mark in drift.marks if isinstance(mark, Level)] == pytest.approx(
        (prediction.drift * DEG_PER_HOUR).tolist())


def test_a_prediction_of_nothing_is_not_drawn(motion_2):
    """A prediction below its own bound, or a missing one, is not drawn."""
    run, prediction = motion_2
    for given in (None, replace(prediction, largest=np.zeros(3)),
                  replace(prediction, position_bound=1e9)):
        chart = error_chart('t', run.errors, given)
        assert len(chart.panels) == 3
        assert 'linear prediction' not in sum(map(labels, chart.panels), [])


def test_a_prediction_that_is_wrong_has_no_panel_of_its_own(motion_2):
    """A wrong prediction is drawn with the run, and there is no panel of differences."""
    run, prediction = motion_2
    doubled = replace(prediction, position=2.0 * prediction.position)
    chart = error_chart('t', run.errors, doubled)
    assert len(chart.panels) == 3 and 'linear prediction' in labels(chart.panels[0])


def test_what_delays_cause_is_the_run_less_its_twin():
    """The panel of run minus twin shows 4.5 m due to 1 us among kilometres due to a FOG."""
    settings = ins_sim.read_settings(['motion_2', 'delay_y_1us', 'imu_tactical_fog'],
                                     {'duration_s': 200.0})
    run, prediction = ins_sim.simulate(settings), ins_sim.predict(settings)
    position, *_ = delay_chart('t', run.errors, run.twin, prediction).panels
    assert labels(position) == ['east', 'north', 'linear prediction']
    north = (run.errors.position - run.twin.position)[:, 1]
    assert position.y_label == 'position error [m]'
    assert np.abs(position.marks[1].y).max() == np.abs(north).max()
    # The effect of the delays agrees within a percent, although the FOG causes a hundred times
    # more.
    assert np.abs(north).max() == pytest.approx(prediction.largest[1], rel=0.01)
    assert np.abs(run.errors.position[:, 1]).max() > 20.0 * np.abs(north).max()


@pytest.mark.parametrize('size, unit, factor', [(2e4, 'km', 1e-3), (500.0, 'm', 1.0),
                                                (0.01, 'mm', 1e3)])
def test_positions_are_in_the_unit_of_their_size(size, unit, factor):
    """Large errors are drawn in km; up is left out if it is zero."""
    position = error_chart('t', errors(size)).panels[0]
    assert position.y_label == f'position error [{unit}]'
    assert labels(position) == ['east', 'north']
    assert position.marks[0].y.max() == pytest.approx(size * factor)
    assert position.x_label == 'time [min]'


def test_a_history_is_read_in_blocks():
    """Curves contain the extremes of a long history for any block length."""
    n = 200001
    values = np.random.default_rng(1).normal(size=(n, 3))
    history = NavErrors(np.arange(n, dtype=np.int64), values, values, values, values)
    curves = history_curves(history, {'position': lambda block: block.position})['position']
    for axis, (t, found) in enumerate(curves):
        assert np.array_equal(found, values[t, axis])
        assert (found.min(), found.max()) == (values[:, axis].min(), values[:, axis].max())
        assert np.all(np.diff(t) > 0) and len(t) < 0.2 * n


def test_blocks_are_interpolated_without_a_seam():
    """Interpolation block by block equals numpy.interp, with NaN beyond the ends."""
    known = np.arange(0.0, 100.0)
    values = np.stack([known ** 2, -known], axis=1)
    t = np.linspace(-1.0, 101.0, 977)
    inside = (t >= 0.0) & (t <= 99.0)
    for column in (0, 1):
        found = interpolated(t, known, values, column, block=7)
        assert np.array_equal(found[inside], np.interp(t[inside], known, values[:, column]))
        assert np.isnan(found[~inside]).all()


def test_a_track_has_equal_axes_and_kilometres():
    """A flight of 60 s at 200 m/s is drawn from its start, in km, with equal axes."""
    settings = ins_sim.read_settings(['cruise'], {'duration_s': 120.0})
    run = ins_sim.simulate(settings, twin=False)
    tracks = run_tracks(run.result)
    panel, = track_chart('t', tracks).panels
    assert panel.equal and panel.x_label == 'east of the start [km]'
    assert labels(panel) == ['truth', 'solution', 'start']
    truth = panel.marks[0]
    assert (truth.x[0], truth.y[0]) == (0.0, 0.0)
    speed = np.hypot(*run.truth.v_n[:, :2].T).mean()
    assert np.hypot(truth.x[-1], truth.y[-1]) == pytest.approx(0.12 * speed, rel=0.05)
