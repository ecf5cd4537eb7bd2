"""Circular error probable (CEP) for any covariance and mean."""

import numpy as np
import pytest

from ins_sim.studies.error_circle import error_circle


@pytest.mark.parametrize('ratio, half, most', [
    (1.0, 1.17741, 2.44775), (0.5, 0.87042, 2.03586), (0.2, 0.70585, 1.97041),
    (0.0, 0.67449, 1.95996)])
def test_factors_by_the_ratio_of_the_axes(ratio, half, most):
    """K50 and K95 relative to the larger sigma are right for any orientation of the ellipse."""
    for angle in (0.0, 0.7, 2.0):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s], [s, c]])
        p = (turn @ np.diag([9.0, 9.0 * ratio * ratio]) @ turn.T)[None]
        for part, expected in ((0.5, half), (0.95, most)):
            assert error_circle(np.zeros((1, 2)), p, part)[0] == pytest.approx(
                3.0 * expected, abs=3e-5)


def test_with_a_mean_it_is_the_quantile_of_draws():
    """With a mean the radius is the quantile of 200 000 draws within 1 %, four of its sigmas."""
    mean, p = np.array([0.7, -1.2]), np.array([[1.3, 0.9], [0.9, 1.0]])
    draws = np.random.default_rng(1).multivariate_normal(mean, p, 200_000)
    size = np.hypot(draws[:, 0], draws[:, 1])
    for part in (0.5, 0.95):
        assert error_circle(mean[None], p[None], part)[0] == pytest.approx(
            np.quantile(size, part), rel=1e-2)


def test_without_scatter_it_is_the_mean():
    """With almost no scatter, or none, the radius is the length of the mean."""
    mean = np.array([[3.0, 4.0], [3.0, 4.0], [0.0, 0.0]])
    p = np.stack([np.zeros((2, 2)), 1e-16 * np.eye(2), np.zeros((2, 2))])
    assert error_circle(mean, p, 0.5) == pytest.approx([5.0, 5.0, 0.0], abs=1e-6)
