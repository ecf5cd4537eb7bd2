"""The charts of the closed-loop study as data."""

import numpy as np
import pytest

from ins_sim.report.charts.chart import CIRCLE, Curve, Markers
from ins_sim.report.studies.closed_loop import (flights_answer, flights_table, limits_answer,
                                                LimitRow, loop_row)
from ins_sim.report.studies.closed_loop_charts import histories_chart, map_answer, map_chart
from ins_sim.studies.closed_loop import LoopFlight, TABLE
from ins_sim.studies.stability_map import MapCurves, PANELS

T_S = np.arange(0.0, 300.1, 0.1)


def flight(beta_deg, z=100.0, estimated=1.0):
    """Return a LoopFlight that oscillates by beta_deg at 0.3 rad/s; estimated: error of z, m."""
    swing = np.sin(0.3 * T_S)
    return LoopFlight(T_S, z * swing, np.radians(beta_deg) * swing, z * swing + estimated)


def test_flights_over_time():
    """Each flight has panels of sideslip in deg, offset, and error of the estimated offset."""
    chart = histories_chart('histories_0.15', 'a title', ['a', 'b'],
                            [flight(8.0), flight(0.1, 2e4)])
    sideslip, offset, error = chart.panels
    assert [mark.label for mark in sideslip.marks] == ['a', 'b']
    assert sideslip.marks[0].y.max() == pytest.approx(8.0, rel=1e-3)
    assert offset.y_label == 'offset from the leg [km]'
    assert offset.marks[1].y.max() == pytest.approx(20.0, rel=1e-3)
    assert error.y_label == 'estimated less true offset [m]'
    assert error.marks[0].y == pytest.approx(1.0)
    assert sideslip.x_label == 'time [min]' and sideslip.marks[0].x[-1] == pytest.approx(5.0)


def test_every_flight_of_the_table_looks_different():
    """Each flight has its own colour and dash, the same in all panels."""
    count = len(TABLE)
    chart = histories_chart('x', '', [str(k) for k in range(count)], [flight(1.0)] * count)
    looks = [[(mark.colour, mark.dash) for mark in panel.marks] for panel in chart.panels]
    assert len(set(looks[0])) == count and looks[0] == looks[1] == looks[2]


def test_the_map_draws_no_limit_where_there_is_none():
    """Filters of one kind share a panel; limits off the map are left out, one of zero is drawn."""
    gains = np.array([0.1, 1.0, 10.0])
    curves = [MapCurves(gains, np.array([1.0, 0.5, 0.0]),
                        {1.0: np.array([1.0, 0.51, 0.0]), 100.0: np.array([0.9, 0.2, 0.0])})
              for _ in PANELS]
    chart = map_chart(PANELS, curves)
    assert chart.name == 'map' and not chart.shared
    assert [(panel.title, panel.x_label) for panel in chart.panels] == [
        ('sliding conventional', 'K_v [1/s]'), ('paper_corrected', 'K'),
        ('conventional', 'gain of a fix')]
    line, near, far = chart.panels[0].marks[:3]
    assert isinstance(line, Curve) and line.label == 'N 10, linear limit'
    assert np.isnan(line.y[0]) and line.y[1:].tolist() == [0.5, 0.0]
    assert isinstance(near, Markers) and near.marker == CIRCLE and near.colour == line.colour
    assert near.label == 'N 10, flown from z0 = 1 m' and far.y.tolist() == [0.9, 0.2, 0.0]
    assert map_answer(curves) == (
        'On the map the limit of k_z by flights differs from the linear one: in flights from 1 m '
        'by +0.000 to +0.010, from 100 m by -0.300 to +0.000.')


def test_what_the_tables_say():
    """The text counts the quiet flights and names the one with the largest oscillation."""
    quiet, restless = TABLE[0], next(case for case in TABLE if case.k_z == 0.17)
    rows = [loop_row(quiet, flight(0.01)), loop_row(restless, flight(8.0, 31.0), flight(7.9))]
    assert flights_answer(rows[:1]) == (
        '1 of 1 flights end quiet (amplitude of the sideslip below 0.05 deg).')
    assert flights_answer(rows) == (
        '1 of 2 flights end quiet (amplitude of the sideslip below 0.05 deg); of the others, '
        'sliding, N 100, K_v 1 at k_z = 0.17 oscillates most, with amplitudes of 8 deg in '
        'sideslip and 31 m.')
    slow = LoopFlight(T_S[:900], *(values[:900] for values in (
        flight(8.0).z, flight(8.0).beta, flight(8.0).z_estimated)))
    assert slow.frequency is None
    assert flights_answer([loop_row(restless, slow)]).startswith('0 of 1 flights end quiet')
    table = flights_table('Closed loop', rows)
    assert table.heads[0] == 'filter' and table.rows[1][4] == '8 7.9 (8)'
    varied = flights_table('Closed loop', [loop_row(quiet, flight(0.01), condition='gusts')])
    assert varied.heads[:2] == ('with', 'filter') and varied.rows[0][0] == 'gusts'
    assert limits_answer([LimitRow('a', 0.1, 0.3, 0.1006)]) == (
        'Flights of the whole chain lose stability within 0.6 % of the k_z of the linear theory.')
