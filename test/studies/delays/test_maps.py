"""The maps of drift, compared with closed forms and with means over time."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import j1
from support.studies import delay_figure as figure

from ins_sim.core.motion.factory import make_motion
from ins_sim.core.numerics.units import DEG_PER_HOUR
from ins_sim.core.prediction.drift import mean_drift, two_axis_resonances
from ins_sim.studies.delays.maps import (delays_s, rates_map, rocking_map, TwoAxisDrift)

WITHOUT_EARTH = {'earth__rotation': False, 'gyro__delay_us__x': 2.0, 'gyro__delay_us__y': -1.0,
                 'gyro__delay_us__z': 3.0}


def mean_over_time(settings, span_s=None):
    """Return the mean drift (3,) of the motion of settings by ``core.prediction``, rad/s."""
    generator, tau = settings.motion_generator, delays_s(settings)
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    if span_s is not None:
        motion.period_s = None
    return mean_drift(motion, lambda truth: truth.omega_ib_b * tau, generator.earth.rotation,
                      generator.start_s, span_s)


@pytest.mark.parametrize('psi_rate, gamma_rate', [(1.0, 0.5), (-0.7, 0.35), (0.31, -0.9),
                                                  (0.002, 0.4), (1.2, 0.001), (-1.0, -0.5)])
def test_drift_over_the_rates_is_the_mean_over_time(psi_rate, gamma_rate):
    """
    The drift over the rates equals a sum over instants 0.0125 s apart.

    It may differ by this interval divided by the time.
    """
    span_s = 300.0
    shows = figure('rates', duration_s=span_s, start_s=7.0, motion__theta_deg=20.0,
                   motion__psi_deg=40.0, motion__gamma_deg=-25.0,
                   motion__two_axis__psi_rate_rad_s=psi_rate,
                   motion__two_axis__gamma_rate_rad_s=gamma_rate, **WITHOUT_EARTH)
    drift = TwoAxisDrift(shows.simulation)
    expected = mean_over_time(shows.simulation, span_s)
    found = drift.mean(psi_rate, gamma_rate)
    # The largest w x T w, at the first and the last instant.
    largest = 4e-6 * (abs(psi_rate) + abs(gamma_rate)) ** 2
    assert (found.real, found.imag) == pytest.approx(expected[:2],
                                                     abs=0.0125 / span_s * largest)


@pytest.mark.parametrize('theta', [-30.0, 0.0, 30.0])
def test_on_both_lines_it_is_equation_19(theta):
    """
    On both lines the drift is equation (19), except for the incomplete last cycle of an hour.

    Source: Bogdanov and Fomichev 2018.
    """
    settings = figure('rates', motion__theta_deg=theta).simulation
    drift = TwoAxisDrift(settings)
    assert set(drift.lines) == {2, -2}
    for _, rate, formula in two_axis_resonances(settings.motion_generator.motion,
                                                delays_s(settings)):
        found = drift.mean(rate, 0.5)
        # The other harmonics rotate at 1 rad/s or faster, each of at most a us rad^2/s^2.
        assert (found.real, found.imag) == pytest.approx(formula[:2], abs=3e-6 / 3600.0)
    best = {-30.0: 0.0334932, 0.0: 0.0257831, 30.0: 0.0334932}[theta]
    largest = max(abs(drift.mean(rate, 0.5)) for rate in (1.0, -1.0))
    assert DEG_PER_HOUR * largest == pytest.approx(best, rel=3e-4)


def test_width_of_a_resonance(figures):
    """The drift is halved where sin x / x is 1/2: 1.05e-3 rad/s off the resonance for an hour."""
    found = rates_map(figure('rates').simulation)
    half = 2.0 * 1.8954943 / 3600.0
    print(f'\nhalf as high at {found.half_width:.6g} rad/s; sin x / x: {half:.6g}')
    figures.record('delays.half_width', found.half_width, 'rad/s', 1.05e-3, 'specification')
    # psi'^2 is larger by 2e-3 there.
    assert found.half_width == pytest.approx(half, rel=2e-3)
    assert found.half_width == pytest.approx(1.05e-3, abs=5e-6)
    for steps in (found.near_psi_rates, 2.0 * found.near_gamma_rates, found.detunings):
        assert 0.0 < np.diff(steps).max() <= 5e-4


def test_of_a_shorter_mean_a_resonance_is_wider():
    """The width is inversely proportional to the time; far off there is no half width."""
    short = rates_map(figure('rates', duration_s=360.0).simulation)
    assert short.half_width == pytest.approx(2.0 * 1.8954943 / 360.0, rel=2e-2)
    off = rates_map(figure('rates', motion__two_axis__psi_rate_rad_s=0.8).simulation)
    assert off.half_width is None


def test_no_resonance_is_lost_between_the_cells():
    """Each cell shows the largest drift that a search in steps of 2e-5 rad/s finds in it."""
    settings = figure('rates').simulation
    found, drift = rates_map(settings), TwoAxisDrift(settings)
    width = found.psi_rates[1] - found.psi_rates[0]
    for row in (0, 17, 62, 90):
        gamma = found.gamma_rates[row]
        for k in drift.lines:
            column = int(np.argmin(np.abs(found.psi_rates - k * gamma)))
            psi = found.psi_rates[column] + np.arange(-0.5 * width, 0.5 * width, 2e-5)
            # A cell wider than a line contains its foot as well, where psi'^2 is larger.
            assert found.largest[row, column] == pytest.approx(
                np.abs(drift.mean(psi, gamma)).max(), rel=1e-3)
    on = [found.largest[row, np.argmin(np.abs(found.psi_rates - 2.0 * gamma))]
          for row, gamma in enumerate(found.gamma_rates)]
    assert DEG_PER_HOUR * max(on) == pytest.approx(1.5 ** 2 * 0.0334932, rel=1e-3)
    assert found.largest.max() == max(on)


def test_without_a_difference_of_delays_there_is_no_drift():
    """Three equal delays only shift the time: the map is zero and has no lines."""
    settings = figure('rates', gyro__delay_us__x=1.0, gyro__delay_us__z=1.0).simulation
    found = rates_map(settings)
    assert found.lines == () and found.half_width is None and not found.largest.any()


def test_drift_of_motion_1_over_psi(figures):
    """Motion 1 drifts by 0.0154884 sin(2 psi) deg/h about Up, and about no other axis."""
    found = rocking_map(figure('rocking').simulation, (0.0, 45.0, 180.0))
    expected = 0.0154884 * np.sin(2.0 * np.radians(found.psi_deg))
    drift = DEG_PER_HOUR * found.drift
    figures.record('delays.rocking', drift[found.psi_deg == 45.0, 2][0], 'deg/h', 0.0154884,
                   'specification')
    assert drift[:, 2] == pytest.approx(expected, abs=5e-8)
    assert np.abs(drift[:, :2]).max() <= 1e-15


@pytest.mark.parametrize('theta, gamma, axis', [(0.0, 0.0, 'north'), (-45.0, 0.0, 'north'),
                                                (20.0, 70.0, 'east'), (60.0, -130.0, 'north')])
def test_any_axis_is_the_closed_form_and_the_mean_over_time(theta, gamma, axis):
    """For any axis the drift is kappa0 w^2 J1(kappa0) R0 (n x T n), also at large amplitudes."""
    psi = 35.264
    settings = figure('rocking', motion__theta_deg=theta, motion__gamma_deg=gamma,
                      motion__rocking__axis=axis, motion__rocking__amplitude_deg=50.0,
                      motion__psi_deg=psi, **WITHOUT_EARTH).simulation
    found = rocking_map(settings, (psi,))
    drift = found.drift[found.psi_deg == psi][0]
    assert drift == pytest.approx(mean_over_time(settings), abs=1e-9 * np.linalg.norm(drift))
    kappa, w, tau = np.radians(50.0), 2.0 * np.pi, delays_s(settings)
    factor = kappa * w * w * j1(kappa)
    a, e = np.radians(found.azimuth_deg[None, :]), np.radians(found.elevation_deg[:, None])
    n = np.stack(np.broadcast_arrays(np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)), -1)
    size = factor * np.linalg.norm(np.cross(n, tau * n), axis=-1)
    assert found.size == pytest.approx(size, abs=1e-12 * size.max())


def test_the_direction_decides_the_size_alone():
    """The drift of a rotated body is that of the map in the direction of the axis."""
    settings = figure('rocking', motion__theta_deg=-45.0, **WITHOUT_EARTH).simulation
    found = rocking_map(settings, (90.0,))
    # With psi = 90 deg the axis to the north is to the right of the body: azimuth -90 deg,
    # elevation 0.
    row, column = (np.flatnonzero(values == value)[0] for values, value in (
        (found.elevation_deg, 0.0), (found.azimuth_deg, -90.0)))
    assert np.linalg.norm(found.drift[found.psi_deg == 90.0]) == pytest.approx(
        found.size[row, column], abs=1e-12 * found.size.max())
    motion = settings.motion_generator.motion
    level = replace(settings, motion_generator=replace(
        settings.motion_generator, motion=replace(motion, theta_deg=0.0)))
    # Level at psi 30, the axis is 30 deg to the right of forward.
    drift = rocking_map(level, (30.0,)).drift[0]
    column = np.flatnonzero(found.azimuth_deg == -30.0)[0]
    assert np.linalg.norm(drift) == pytest.approx(found.size[row, column], rel=1e-12)
