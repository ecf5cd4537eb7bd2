"""In the chart of an Allan deviation each line is where its number in the legend is."""

from dataclasses import replace

import numpy as np
import pytest

from ins_sim.core.numerics.units import DEG_H
from ins_sim.report.allan import Allan, Coefficients, fit_coefficients
from ins_sim.report.charts.chart import Band, Curve, Level
from ins_sim.report.noise_terms import Noise, TRIADS
from ins_sim.report.studies.allan import allan_chart, allan_page

# Q, N, B, K in the units of data sheets: arcsec, deg/sqrt(h), deg/h, deg/h/sqrt(h).
WANTED = (5.0, 0.02, 0.5, 0.4)
TAU_S = np.geomspace(0.01, 2e4, 50)


def exact_noise(wanted=WANTED, settings=WANTED):
    """Return the Noise of a gyro whose Allan deviation is that of the model."""
    units = np.array([term.si for term in TRIADS['gyro']])
    model = Coefficients(*(units * wanted).tolist())
    found = Allan(TAU_S, np.tile(model.deviation(TAU_S), (3, 1)).T, 8e4)
    fit = fit_coefficients(found)
    known = None if settings is None else np.tile(units * settings, (3, 1)).T
    return Noise('gyro', ('x', 'y', 'z'), found, np.zeros_like(TAU_S), (fit,) * 3, fit, known)


def labelled(panel, start):
    """Return the mark whose label starts with a text."""
    return next(mark for mark in panel.marks if (getattr(mark, 'label', None) or '')
                .startswith(start))


def test_the_floor_that_is_drawn_is_the_number_in_the_legend():
    """The floor is drawn at sqrt(2 ln 2/pi) = 0.664 of B, and the legend has both numbers."""
    top, _ = allan_chart('a gyro', exact_noise()).panels
    floor = labelled(top, '0.664 B')
    assert isinstance(floor, Level) and floor.x is None
    assert floor.y == pytest.approx(np.sqrt(2.0 * np.log(2.0) / np.pi) * 0.5, rel=1e-6)
    assert floor.label == '0.664 B = 0.332 deg/h, B = 0.5 deg/h (settings: 0.5)'


def test_the_slopes_give_their_coefficient_where_it_is_read():
    """
    N is read at 1 h in deg/h, K at 3 h, Q (arcsec = deg/h s) at sqrt(3) s.

    Source: IEEE Std 952.
    """
    top, _ = allan_chart('a gyro', exact_noise()).panels
    for start, value, tau_s in (('sqrt(3) Q/tau, Q = 5 arcsec', 5.0, 3.0 ** 0.5),
                                ('N/sqrt(tau), N = 0.02 deg/sqrt(h)', 0.02, 3600.0),
                                ('K sqrt(tau/3), K = 0.4 deg/h/sqrt(h)', 0.4, 10800.0)):
        line = labelled(top, start)
        read = np.exp(np.interp(np.log(tau_s), np.log(line.x), np.log(line.y)))
        assert read == pytest.approx(value, rel=1e-6)


def test_fit_settings_and_what_they_are_off():
    """The chart shows fit and settings, and below the difference in percent with its scatter."""
    noise = exact_noise(settings=(5.0, 0.04, 0.5, 0.4))
    top, bottom = allan_chart('a gyro', noise).panels
    fit, expected = labelled(top, 'fit'), labelled(top, 'expected of the settings')
    assert fit.y == pytest.approx(noise.allan.deviation[:, 0] / DEG_H, rel=1e-6)
    off = [mark for mark in bottom.marks if isinstance(mark, Curve)]
    assert off[-1].y == pytest.approx(100.0 * (expected.y / fit.y - 1.0))
    assert off[-1].y.max() > 20.0 and np.abs(off[0].y).max() < 1e-4
    band, = (mark for mark in bottom.marks if isinstance(mark, Band))
    assert band.high[-1] == pytest.approx(50.0 * (2e4 / 8e4) ** 0.5)
    assert top.y_range[0] < top.marks[-1].y.min() < top.y_range[1]


def test_what_is_not_known_is_not_drawn():
    """Missing settings, settings without noise, and missing coefficients are not drawn."""
    for noise in (exact_noise(settings=None), exact_noise(settings=(0.0,) * 4)):
        top, _ = allan_chart('a gyro', noise).panels
        assert not [m for m in top.marks if 'expected' in (getattr(m, 'label', '') or '')]
    top, _ = allan_chart('a gyro', exact_noise((5.0, 0.02, 0.0, 0.0))).panels
    assert not [m for m in top.marks if isinstance(m, Level)]
    constant = replace(exact_noise(), axes=('x', 'z'), allan=exact_noise().allan.channels([0, 2]),
                       by_axis=exact_noise().by_axis[:2])
    top, _ = allan_chart('a gyro', constant).panels
    assert labelled(top, 'axis z') and 'axis y' not in [getattr(m, 'label', '') for m in top.marks]


def test_the_title_and_the_answer():
    """The title has instrument, rate and length; the answer begins with the floor drawn."""
    noise = exact_noise()
    chart = allan_chart('imu_tactical_fog', noise)
    assert chart.name == 'gyro'
    assert chart.title == 'Allan deviation of the gyro: imu_tactical_fog, 100 Hz, 22.2 h'
    page = allan_page('imu_tactical_fog', [noise], ['said once'], None, [chart])
    assert page.answer == (
        "The gyro's flicker floor is 0.332 deg/h, 0.664 of its bias instability B = 0.5 deg/h; "
        'quantisation Q = 5 arcsec; angle random walk N = 0.02 deg/sqrt(h); rate random walk '
        'K = 0.4 deg/h/sqrt(h).')
    assert page.notes == ('said once',) and page.tables[0].rows[2][-2:] == pytest.approx(
        (0.5, 0.5))
    hidden = exact_noise((5.0, 0.02, 0.0, 0.0))
    assert 'Not seen in this record: bias instability B, rate random walk K.' in allan_page(
        'x', [hidden], [], None, []).answer
