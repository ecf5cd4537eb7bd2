"""The circle that contains a given part of the runs, compared with published factors."""

from ins_sim.studies.error_circle import error_circle
import numpy as np
import pytest


@pytest.mark.parametrize('ratio, half, most', [
    (1.0, 1.17741, 2.44775), (0.5, 0.87042, 2.03586), (0.2, 0.70585, 1.97041)])
@pytest.mark.parametrize('turn', [0.0, 0.7])
def test_factors_of_the_longer_sigma(ratio, half, most, turn):
    """The factors of the larger sigma are the tabulated ones, for any direction of the axes."""
    axes = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    covariance = axes @ np.diag([49.0, 49.0 * ratio ** 2]) @ axes.T
    for part, factor in ((0.5, half), (0.95, most)):
        assert error_circle((0.0, 0.0), covariance, part) == pytest.approx(7.0 * factor,
                                                                           abs=7.0 * 6e-6)


def test_a_mean_counts():
    """
    The circle is centred on the true position: a mean shifts runs out of it.

    Of 4e5 normal points the given part lies inside, within 5 sigma.
    """
    mean, covariance = np.array([3.0, -2.0]), np.array([[4.0, 1.0], [1.0, 0.5]])
    drawn = np.random.default_rng(1).multivariate_normal(mean, covariance, 400000)
    for part in (0.5, 0.95):
        inside = np.mean(np.hypot(*drawn.T) < error_circle(mean, covariance, part))
        assert abs(inside - part) < 5.0 * np.sqrt(part * (1.0 - part) / len(drawn))


@pytest.mark.parametrize('mean, sigmas, part, radius', [
    ((0.0, 0.0), (0.0, 0.0), 0.5, 0.0), ((3.0, 4.0), (0.0, 0.0), 0.95, 5.0),
    # With one axis: quantiles of the absolute normal distribution.
    ((0.0, 0.0), (0.0, 2.0), 0.95, 2.0 * 1.9599640), ((0.0, 0.0), (1e-12, 1.0), 0.5, 0.6744898),
    # Far away only the spread along the mean matters.
    ((1e4, 0.0), (1.0, 1.0), 0.5, 1e4 + 0.5e-4)])
def test_narrow_and_far(mean, sigmas, part, radius):
    """The circle is right if one axis has no width, or if the mean is far from the truth."""
    found = error_circle(mean, np.diag(np.square(sigmas)), part)
    assert found == pytest.approx(radius, rel=1e-6)


def test_what_is_not_known_has_no_circle():
    """One run has no covariance and therefore no circle."""
    assert np.isnan(error_circle((0.0, 0.0), np.full((2, 2), np.nan), 0.5))
