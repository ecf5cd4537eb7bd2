"""The budget compared with ensembles: inside 99.9 % intervals while linear theory holds."""

import numpy as np
import pytest

import ins_sim
from ins_sim.core.prediction.budget.linear_budget import LinearBudget
from ins_sim.core.prediction.budget.sources import ErrorSource
from ins_sim.studies.budget.beside import BesideRuns, compared, rms_scatter, sigma_interval

SOURCE = ErrorSource('one', 'one', 'm', (1.0,), (1.0,), False, 0, 'white')
FOG, MEMS = 'imu_tactical_fog', 'imu_tactical_mems'


def test_intervals_of_a_thousand_runs():
    """For 1000 runs s/sigma is in [0.956, 1.044] (95 %) and [0.927, 1.074] (99.9 %)."""
    assert np.round(sigma_interval(1000, 0.95), 3).tolist() == [0.956, 1.044]
    assert np.round(sigma_interval(1000), 3).tolist() == [0.927, 1.074]


def test_scatter_of_the_horizontal_rms():
    """
    The scatter of the horizontal rms is sqrt((s_N^4 + s_E^4)/2n)/(s_N^2 + s_E^2).

    10000 draws with a mean agree.
    """
    sigma = np.array([4300.0, 8600.0])
    wanted = np.sqrt(np.sum(sigma ** 4) / 2000.0) / np.sum(sigma ** 2)
    found = rms_scatter(np.diag(sigma ** 2)[None], np.zeros((1, 2)), 1000)[0]
    assert found == pytest.approx(wanted, rel=1e-12)
    p, mean = np.array([[2.0, 0.7], [0.7, 1.0]]), np.array([1.0, -0.5])
    draws = np.random.default_rng(1).multivariate_normal(mean, p, (10000, 50))
    rms = np.sqrt(np.mean(np.sum(draws ** 2, axis=2), axis=1))
    whole = np.sqrt(np.trace(p) + mean @ mean)
    # Terms of second order in the scatter, and the scatter of a standard deviation from 10000
    # draws.
    assert rms.std() / whole == pytest.approx(
        rms_scatter(p[None], mean[None], 50)[0], rel=0.03)


def test_the_scatter_of_that_fog(fog):
    """The horizontal rms of 1000 runs of the tactical FOG has a sigma of 1.83 % after 1 h."""
    p = fog.linear.total_covariance()[-1, :2, :2]
    plain = np.diag(np.diag(p))
    assert rms_scatter(plain[None], np.zeros((1, 2)), 1000)[0] == pytest.approx(0.0183, abs=5e-5)


def test_an_ensemble_of_another_instrument_differs():
    """1000 runs with 1.15 times the sigma of the budget are marked, runs with its sigma not."""
    t_s = np.array([0.0, 10.0])
    p = np.zeros((1, 2, 9, 9))
    p[0, 1] = np.diag([4.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1e-8, 1e-8, 1e-6])
    linear = LinearBudget(t_s, np.full(2, 0.9), (SOURCE,), p, np.zeros((1, 2, 3, 9)), (),
                          np.zeros((0, 2, 9)), np.zeros(2))
    mean, order = np.zeros((1, 9)), [6, 7, 8, 3, 4, 5, 0, 1, 2]
    sample = p[0, 1][order][:, order]
    count = np.array([1000])
    for factor, differs in ((1.0, False), (1.15, True)):
        for found in compared(linear, BesideRuns(
                1000, (), np.array([10.0]), count, mean, factor ** 2 * sample[None])):
            assert bool(found.differs[0]) == differs, found.name
            assert found.ratio[0] == pytest.approx(factor, rel=1e-3)


@pytest.mark.parametrize('instrument, runs, seconds', [
    (MEMS, 64, 200.0), pytest.param(FOG, 128, 600.0, marks=pytest.mark.slow),
    pytest.param(FOG, 1000, 3600.0, marks=pytest.mark.figures),
    pytest.param(MEMS, 1000, 3600.0, marks=pytest.mark.figures)])
def test_ensemble_is_inside_its_interval(instrument, runs, seconds, figures):
    """
    On the racetrack every quantity is inside its interval until linear theory ends.

    The hour of 1000 runs takes minutes and is simulated by ``make figures``.
    """
    settings = ins_sim.read_settings(['racetrack', instrument], {'duration_s': seconds})
    budget = ins_sim.budget(settings, runs=runs)
    assert budget.beside.count.min() == runs
    for found in budget.compared():
        print(instrument, found.name, found.ratio.min().round(4), found.ratio.max().round(4),
              found.low.min().round(4), found.high.max().round(4))
        assert not (found.differs & found.linear).any(), found.name
        if runs < 1000:
            continue
        at = [int(np.argmin(abs(found.t_s - t))) for t in (600.0, 1800.0, 3600.0)]
        name = f'budget.{instrument}.{found.name}'
        figures.record(f'{name}.budget', found.budget[at])
        figures.record(f'{name}.ratio', found.ratio[at], expected=[
            found.low[at].tolist(), found.high[at].tolist()], source='99.9 % interval')
    if runs == 1000:
        until = budget.linear_until()
        figures.record(f'budget.{instrument}.linear_until_s', seconds if until is None else until,
                       's')
