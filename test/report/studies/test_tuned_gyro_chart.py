"""The chart and the report of the tuned-gyro study as data."""

import numpy as np
import pytest

from ins_sim.report.charts.chart import Curve, Level, Markers
from ins_sim.report.studies.tuned_gyro import study_chart, study_page, TunedGyroStudy
from ins_sim.settings.tuned_gyro import TunedGyroStudySettings
from ins_sim.studies.tuned_gyro import Cell

SETTINGS = TunedGyroStudySettings(sweep='rotor_speed', values=(130.0, 337.0),
                                  paper_deg=(9.98, 9.81), paper_limits_hz=(130.0, 337.0))
CELLS = (Cell(130.0, 9.9715, 9.9715, 9.98), Cell(337.0, 9.8140, 9.8140, 9.81))
CURVE = (CELLS[0], Cell(200.0, 9.9331, 9.9331, None), CELLS[1])


def test_the_paper_beside_ours():
    """Published points are drawn on our curve, with the difference in a panel below."""
    chart = study_chart('dtg_study_speed', SETTINGS, CURVE, CELLS, (129.4, 337.4))
    top, bottom = chart.panels
    ours, paper = top.marks[:2]
    assert isinstance(ours, Curve) and isinstance(paper, Markers)
    assert ours.y == pytest.approx([-0.0285, -0.0669, -0.186])
    assert paper.y == pytest.approx([-0.02, -0.19])
    off, = (mark for mark in bottom.marks if isinstance(mark, Markers))
    assert off.y == pytest.approx([-0.0085, 0.0040])
    limits = {mark.label: mark.x for mark in top.marks if isinstance(mark, Level)}
    assert limits == {'RK4 is unstable below 129.4 Hz': 129.4, 'in the paper below 130 Hz': 130.0,
                      'RK4 is unstable above 337.4 Hz': 337.4, 'in the paper above 337 Hz': 337.0}
    assert top.x_range[0] < 129.4 and top.x_range[1] > 337.4
    assert chart.name == 'dtg_study_speed'
    assert chart.title == ('Roll of a rocking base through two tuned gyros: 10 deg of roll, base '
                           'at 1 rad/s, preset sapegin_2016, RK4 at 0.75 ms')


def test_a_study_without_a_paper_has_no_difference():
    """Without published values there is one panel; a missing limit has no line."""
    settings = TunedGyroStudySettings(sweep='rotor_speed', values=(130.0, 337.0))
    cells = tuple(Cell(c.value, c.poisson_deg, c.euler_vector_deg, None) for c in CELLS)
    top, = study_chart('x', settings, cells, cells, (None, 337.4)).panels
    assert [mark.x for mark in top.marks if isinstance(mark, Level)] == [337.4]
    assert np.isfinite(top.x_range).all()


def test_the_report_answers():
    """The report states the worst amplitude, the difference from the paper, and the limits."""
    chart = study_chart('dtg_study_speed', SETTINGS, CURVE, CELLS, (129.4, 337.4))
    page = study_page([TunedGyroStudy('dtg_study_speed', SETTINGS, CELLS, (129.4, 337.4), chart)])
    assert page.answer == (
        'A roll of 10 deg is recovered as 9.814 deg at a rotor speed of 337 Hz, the least '
        'accurate of 2 values; the published values are reproduced within 0.0085 deg. RK4 at '
        '0.75 ms is stable from 129.4 to 337.4 Hz; published: 130 to 337 Hz.')
    assert page.charts == (chart,) and list(page.files) == ['dtg_study_speed.png']
    assert page.tables[0].rows[0] == ('130', '9.9715', '9.9715', '9.98', '-0.0085')
