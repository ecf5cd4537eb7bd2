"""
Published errors of runs with delays (docs/explanation/validation.md), printed and checked.

Tolerances: half a unit of the last digit in the published table, unless stated otherwise.
"""

import numpy as np
import pytest
from scipy.optimize import curve_fit
from scipy.special import j1
from support.studies import DEG_PER_HOUR, FLIGHT, MOTION_1, MOTION_2, prediction_of, settings, \
    study

from ins_sim.core.earth import ellipsoid

TABLE = [  # theta, detuning, max |dN|, max |dE|, half a unit of the last digits.
    (-30.0, 0.0, 4472.1, 623.94, 0.05, 0.005),
    (0.0, 0.0, 3442.8, 479.48, 0.05, 0.005)]
REST = [
    (-30.0, 0.001, 1963.4, 2931.6, 0.05, 0.05),
    (-30.0, 0.01, 34.03, 211.79, 0.005, 0.005),
    (-30.0, 0.1, 4.190, 25.60, 0.0005, 0.005),
    (0.0, 0.001, 1511.6, 2257.9, 0.05, 0.05),
    (0.0, 0.01, 26.42, 164.61, 0.005, 0.005),
    (0.0, 0.1, 3.501, 21.31, 0.0005, 0.005)]
CRUISE = {**FLIGHT, 'motion.kind': 'cruise'}
RACETRACK = {**FLIGHT, 'motion.kind': 'racetrack'}
AGGRESSIVE = {**FLIGHT, 'motion.kind': 'aggressive'}
SCHULER = {**MOTION_2, 'earth.rotation': False, 'output_every': 100}


def cell(theta, detuning):
    """Return the study of one cell of the table of motion 2."""
    return {**MOTION_2, 'motion.theta_deg': theta, 'motion.two_axis.detuning_rad_s': detuning}


def grouped(row):
    """
    Return a row as a parameter; tests of one row share a run, computed once by one worker.

    Rows with theta -30 deg are in the everyday run, those with theta 0 in the slow one: each is a
    simulation of an hour, with its twin.
    """
    marks = [pytest.mark.xdist_group(f'{row[0]:g}')]
    return pytest.param(*row, marks=marks if row[0] else [*marks, pytest.mark.slow])


def largest(errors):
    """Return max |dN|, max |dE|."""
    return np.abs(errors.position).max(axis=0)[[1, 0]]


def check_cell(figures, theta, detuning, north, east, tol_n, tol_e):
    """Check a cell against its published values; its zero-delay twin errs by at most 1e-4 m."""
    errors, twin = study(cell(theta, detuning))
    n, e = largest(errors)
    floor = largest(twin).max()
    print(f'\ntheta {theta:g} detuning {detuning:g}: |dN| {n:.4f} ({north}), '
          f'|dE| {e:.4f} ({east}), twin {floor:.2e} m')
    name = f'oracles.motion_2.{theta:g}.{detuning:g}'
    figures.record(f'{name}.north', n, 'm', north, 'published')
    figures.record(f'{name}.east', e, 'm', east, 'published')
    assert n == pytest.approx(north, abs=tol_n + 5e-5)
    assert e == pytest.approx(east, abs=tol_e + 5e-5)
    assert floor <= 1e-4


@pytest.mark.parametrize('theta, detuning, north, east, tol_n, tol_e', map(grouped, TABLE))
def test_table_of_motion_2(theta, detuning, north, east, tol_n, tol_e, figures):
    """
    Motion 2: max |dN| and |dE| of two of the eight published cells are reproduced.

    One of the two is in the slow run.
    """
    check_cell(figures, theta, detuning, north, east, tol_n, tol_e)


@pytest.mark.slow
@pytest.mark.parametrize('row', REST, ids=lambda row: f'{row[0]:g} {row[1]:g}')
def test_rest_of_the_table_of_motion_2(row, figures):
    """Motion 2: max |dN| and |dE| of the other six of the eight published cells are reproduced."""
    check_cell(figures, *row)


@pytest.mark.parametrize('theta, published', map(grouped, [(-30.0, 0.0334932), (0.0, 0.0257831)]))
def test_drift_of_motion_2(theta, published, figures):
    """
    The drift is 1/8 psi'^2 tau cos(theta) (1 - sin(theta)).

    Source: Bogdanov and Fomichev 2018, equation (19).
    """
    errors, _ = study(cell(theta, 0.0))
    drift = errors.drift[-1] * DEG_PER_HOUR
    formula = 0.125 * 1e-6 * np.cos(np.radians(theta)) * (1 - np.sin(np.radians(theta)))
    print(f'\nmotion 2, theta {theta:g}: drift {drift} deg/h, (19) {formula * DEG_PER_HOUR:.7f}')
    figures.record(f'oracles.motion_2.{theta:g}.drift', drift[0], 'deg/h', published, 'published')
    assert formula * DEG_PER_HOUR == pytest.approx(published, abs=5e-8)
    # Equation (19) neglects the rotation of the Earth in w: 1e-4 relative, plus (w dt)^2 / 4.
    assert drift[0] == pytest.approx(published, rel=1e-4 + 0.01 ** 2 / 4)
    assert np.abs(drift[1:]).max() < 1e-4 * published


def test_motion_1(figures):
    """
    Motion 1 errs by up to 111.98 m north and 15.03 m east, and drifts by the Bessel formula.

    The formula is multiplied by 1 - (w dt)^2/6 for the sampling. The errors are published.
    """
    errors, twin = study(MOTION_1)
    n, e = largest(errors)
    floor = largest(twin).max()
    kappa, w = np.radians(5.0), 2 * np.pi
    exact = 1e-6 * kappa * w * w * j1(kappa) * 0.5 * DEG_PER_HOUR
    drift = errors.drift[-1] * DEG_PER_HOUR
    factor = 1 - (w * 0.01) ** 2 / 6
    print(f'\nmotion 1: |dN| {n:.3f} (111.98), |dE| {e:.3f} (15.03), twin {floor:.2e} m, '
          f'drift {drift[2]:.7f}, exact {exact:.7f} x {factor:.6f} = {exact * factor:.7f} deg/h')
    figures.record('oracles.motion_1', (n, e), 'm', (111.98, 15.03), 'published')
    figures.record('oracles.motion_1.drift', drift[2], 'deg/h', exact * factor, 'Bessel formula')
    assert exact == pytest.approx(0.0154884, abs=5e-8)
    assert (n, e) == (pytest.approx(111.98, abs=5e-3), pytest.approx(15.03, abs=5e-3))
    assert drift[2] == pytest.approx(exact * factor, rel=1e-5)
    assert floor <= 1e-4


def check_flight(figures, values, north, east):
    """Check the error minus the twin of a flight of section 7; the twin errs by at most 1 mm."""
    errors, twin = study(values)
    n, e = np.abs(errors.position - twin.position).max(axis=0)[[1, 0]]
    floor = largest(twin).max()
    print(f'\n{values["motion.kind"]}: |dN| {n:.4f} ({north}), |dE| {e:.4f} ({east}), '
          f'twin {floor:.2e} m')
    kind = values['motion.kind']
    figures.record(f'oracles.{kind}', (n, e), 'm', (north, east), 'published')
    figures.record(f'oracles.{kind}.twin', floor, 'm', 1e-3, 'asked')
    assert (n, e) == (pytest.approx(north, abs=5e-4), pytest.approx(east, abs=5e-4))
    assert floor <= 1e-3


@pytest.mark.slow
def test_the_aggressive_flight(figures):
    """
    One hour of the aggressive flight errs by up to 5.997 m north and 10.741 m east.

    The delays are 1, 2, 3 us. Source: specification, section 7.
    """
    check_flight(figures, AGGRESSIVE, 5.997, 10.741)


@pytest.mark.slow
def test_the_cruise(figures):
    """
    One hour of cruise with delays of 1, 2, 3 us errs by up to 3.591 m north, 3.327 m east.

    Source: specification, section 7.
    """
    check_flight(figures, CRUISE, 3.591, 3.327)


@pytest.mark.slow
def test_racetrack_errs_by_metres_at_most(figures):
    """
    With delays the racetrack errs by a few metres in an hour, as the linear model predicts.

    This is a conclusion of Bogdanov and Fomichev 2018 for real flights; no value is published for
    this one. The model must predict the whole history of the error to within 1 % of its largest
    value, as in test_prediction.
    """
    errors, twin = study(RACETRACK)
    added = errors.position - twin.position
    n, e = np.abs(added).max(axis=0)[[1, 0]]
    # The prediction has a step of 0.1 s.
    predicted = prediction_of(settings(RACETRACK)).position
    off = np.abs(added[::10][:len(predicted)] - predicted[:len(added[::10])]).max() / max(n, e)
    print(f'\nracetrack: |dN| {n:.4f}, |dE| {e:.4f}, predicted within {off:.1e} of it, twin '
          f'{largest(twin).max():.2e} m')
    figures.record('oracles.racetrack.twin', largest(twin).max(), 'm', 1e-3, 'asked')
    assert off <= 0.01
    assert largest(twin).max() <= 1e-3


@pytest.mark.slow
def test_schuler_period(figures):
    """
    The fitted Schuler period agrees with 2 pi sqrt(R_N / g) = 5065.2 s.

    A constant drift causes a (t - sin(w t) / w); the boundary term [R T w](0) of the attitude
    error, an initial tilt, causes b (1 - cos(w t)).
    """
    errors, _ = study(SCHULER)
    t = (errors.t_ns - errors.t_ns[0]) * 1e-9

    def north(t, a, b, period):
        w = 2 * np.pi / period
        return a * (t - np.sin(w * t) / w) + b * (1 - np.cos(w * t))

    (_, _, period), _ = curve_fit(north, t, errors.position[:, 1], p0=(-1.0, 0.0, 5000.0))
    s = np.sin(np.radians(55.75))
    theory = 2 * np.pi * np.sqrt(ellipsoid.radii(s)[0] / ellipsoid.gravity(s, 0.0))
    print(f'\nSchuler period {period:.3f} s, 2 pi sqrt(R_N / g) = {theory:.3f} s (5065.2)')
    figures.record('oracles.schuler_period', period, 's', theory, '2 pi sqrt(R_N / g)')
    # The published value is a fit as well: ours agrees with theory, which rounds to that value.
    assert period == pytest.approx(theory, abs=0.01)
    assert theory == pytest.approx(5065.2, abs=0.05)
