"""The summary of a comparison of filters: the best one, its margin, and the consistency."""

from ins_sim.report.charts.chart import Curve, DASHED, SOLID
from ins_sim.report.studies.consistency import judged
from ins_sim.report.studies.filter_charts import answer, charts_of
from ins_sim.report.studies.filters import filter_row
from ins_sim.studies.filters import cases_of, FilterCase, FilterFlight
import numpy as np
import pytest

TIMES_S = np.arange(0.0, 3001.0, 5.0)


def flight(end_m, sigma_m=np.nan, square=np.nan, nis=()):
    """Return a FilterFlight whose error grows linearly, the same east and north."""
    error = np.zeros((len(TIMES_S), 3))
    error[:, :2] = (end_m / np.sqrt(2.0) * TIMES_S / TIMES_S[-1])[:, None]
    freedom = np.tile([2, 2, 0, 4], (len(TIMES_S), 1)) * np.isfinite(square)
    freedom[0] = 0
    nees = np.where(freedom > 0, square, np.nan)
    return FilterFlight(TIMES_S, error, np.full(error.shape, sigma_m), error[:, 0], error[:, 0],
                        error, nees, freedom, np.array(nis, dtype=float),
                        10.0 * (1.0 + np.arange(len(nis))), 0, '')


def study():
    """Return the rows and flights of a comparison with one filter twice, and two equal ones."""
    flown = {FilterCase('free', 1000): flight(9000.0), FilterCase('paper', 1000): flight(9000.0),
             FilterCase('window_kf', 1000): flight(900.0, 100.0, 40.0, [5.0] * 300),
             FilterCase('eskf', 1000): flight(300.0, 200.0, 2.0, [2.0] * 300),
             FilterCase('eskf', 100): flight(310.0, 200.0, 2.0, [2.0] * 300)}
    flights = [[one] * 12 for one in flown.values()]
    return [filter_row(case, f) for case, f in zip(flown, flights)], flights


def test_the_answer():
    """The best filter is compared with the next one; filters outside NIS or NEES are named."""
    rows, _ = study()
    assert answer(rows, 3000.0) == (
        'Of 5 filters over 12 flights of 50 min, eskf, N 1000, was best: rms horizontal error at '
        'the end 300 m, 3 times less than window_kf, N 1000 (900 m). Too optimistic by NIS '
        'and by NEES of the position at the end: window_kf, N 1000. Consistent by NIS and by NEES '
        'of the position at the end: eskf, N 1000; eskf, N 100. No statement is possible '
        'without a covariance: free, N 1000; paper, N 1000.')


def test_rows_have_nees_at_the_end():
    """Rows have NEES at the end: mean over flights, chi-square interval, degrees of freedom."""
    rows, _ = study()
    by = {row.name: row for row in rows}
    assert by['free, N 1000'].nees == {}
    mean, low, high, freedom = by['eskf, N 1000'].nees['position']
    # Chi-square of 24 degrees of freedom (Abramowitz and Stegun, table 26.8), divided by 12.
    assert (mean, freedom) == (2.0, 2)
    assert low == pytest.approx(12.401 / 12.0, rel=1e-4)
    assert high == pytest.approx(39.364 / 12.0, rel=1e-4)
    assert list(by['eskf, N 1000'].nees) == ['position', 'velocity', 'state']


def test_equal_curves_are_one_with_both_names():
    """
    Equal curves are drawn once with both names.

    A filter has one colour, and its windows have different dashes.
    """
    rows, flights = study()
    errors, consistency, shown = charts_of(rows, flights)
    curves = [mark for mark in errors.panels[0].marks if isinstance(mark, Curve)]
    assert [curve.label for curve in curves] == [
        'free, N 1000 and paper, N 1000', 'window_kf, N 1000', 'eskf, N 1000', 'eskf, N 100']
    assert [curve.dash for curve in curves] == [SOLID, SOLID, SOLID, DASHED]
    assert errors.panels[0].y_label == 'rms error [m]' and errors.panels[0].x_label == 'time [min]'
    assert shown.title == 'Position error of each flight, filter eskf, N 1000'
    nees = [mark for mark in consistency.panels[0].marks if isinstance(mark, Curve)]
    assert {c.label: c.colour for c in nees}.items() <= {c.label: c.colour for c in curves}.items()
    # The range of the figure includes the filter that is 20 times too optimistic.
    assert consistency.panels[0].y_range[1] > 20.0


@pytest.mark.parametrize('mean, words', [
    (2.0, 'consistent'), (4.0, 'too optimistic'), (0.5, 'too pessimistic'),
    (np.nan, ''), (None, '')])
def test_where_a_mean_lies(mean, words):
    """The text states whether a mean lies in, below or above its interval."""
    assert judged(mean, 1.0, 3.0) == words


def test_cases():
    """The first window is used for all filters, others for eskf; unknown names are refused."""
    assert cases_of(['free', 'eskf', 'free'], [100, 10]) == (
        FilterCase('free', 100), FilterCase('eskf', 100), FilterCase('eskf', 10))
    with pytest.raises(ValueError, match="filter is 'ukf'; expected one of free, conventional"):
        cases_of(['ukf'])
    with pytest.raises(ValueError, match='filters is empty; expected one or more'):
        cases_of([])
