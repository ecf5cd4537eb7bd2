"""The three orientation algorithms compared with a closed form and with each other."""

import math

import numpy as np
import pytest

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import roll_of_matrix
from ins_sim.core.attitude.integration import bortz_factor, KINDS, Orientation
from ins_sim.core.attitude.matrix import dcm_of, quaternion_of
from ins_sim.core.attitude.quaternion import shorter

SPIN, WOBBLE, TURN = 1.0, 0.01, 0.7


def rate(t):
    """Return a rate of 1 rad/s about z plus a wobble of 0.01 rad/s that rotates in the body."""
    return WOBBLE * math.cos(TURN * t), WOBBLE * math.sin(TURN * t), SPIN


def truth(t):
    """Return q for that rate: exp(t (w(0) + TURN e_z)) exp(-TURN t e_z)."""
    return quaternion.multiply(quaternion.exponential((WOBBLE * t, 0.0, (SPIN + TURN) * t)),
                               quaternion.exponential((0.0, 0.0, -TURN * t)))


def run(kind, duration, dt):
    """Return the greatest error of the DCM relative to the closed form, and its history."""
    algorithm, worst, history = Orientation(kind), 0.0, []
    for k in range(round(duration / dt)):
        mid = rate((k + 0.5) * dt)
        algorithm.step((rate(k * dt), mid, mid, rate((k + 1) * dt)), dt)
        history.append(algorithm.dcm)
        off = np.subtract(history[-1], dcm_of(truth((k + 1) * dt)))
        worst = max(worst, abs(off).max())
    return worst, np.array(history)


def test_three_algorithms_agree():
    """
    The DCMs of the algorithms agree over 20 s at 10 ms, through three switches at pi.

    RK4 on C' = C [w x] lags by (w h)^5 / 120 per step, here 1.67e-9 rad in all: this truncation is
    the tolerance for Poisson; the other two are good to 1e-11.
    """
    bound = (SPIN * 0.01) ** 4 / 120.0 * SPIN * 20.0
    errors, histories = zip(*(run(kind, 20.0, 0.01) for kind in KINDS))
    for kind, error in zip(KINDS, errors):
        print(f'\n{kind}: {error:.2e} from the closed form')
    difference = abs(histories[0] - histories[1]).max()
    print(f'Poisson against the Euler vector: {difference:.2e}')
    assert difference <= bound and errors[0] <= bound and max(errors[1:]) <= 1e-11
    # At 8 ms the difference is below 1e-9 throughout.
    assert abs(run('poisson', 20.0, 0.008)[1] - run('euler_vector', 20.0, 0.008)[1]).max() <= 1e-9


@pytest.mark.parametrize('kind', KINDS)
def test_order_is_four(kind):
    """Halving the step divides the error by 16."""
    coarse, fine = (run(kind, 4.0, dt)[0] for dt in (0.08, 0.04))
    print(f'\n{kind}: {coarse:.2e} at 80 ms, {fine:.2e} at 40 ms')
    assert 13.0 < coarse / fine < 36.0


def test_quaternion_is_exact_for_a_constant_rate():
    """A quaternion step of any length is exact for a constant rate."""
    w = (0.3, -0.8, 1.1)
    algorithm = Orientation('quaternion')
    algorithm.advance(tuple(1.3 * a for a in w), 1.3)
    np.testing.assert_allclose(algorithm.q, quaternion.exponential(tuple(1.3 * a for a in w)),
                               atol=1e-15)


@pytest.mark.parametrize('kind', KINDS)
def test_readings_alone_and_a_kept_state(kind):
    """Mean rates of the intervals suffice as input; a restored state gives the same bits."""
    algorithm, start = Orientation(kind, truth(5.0)), np.array(truth(5.0))
    assert min(abs(np.array(algorithm.q) - start).max(),
               abs(np.array(algorithm.q) + start).max()) < 1e-14
    kept = algorithm.state
    algorithm.advance((0.001, 0.002, 0.003), 0.01)
    once = algorithm.state
    algorithm.state = kept
    algorithm.advance((0.001, 0.002, 0.003), 0.01)
    assert algorithm.state == once
    expected = quaternion.multiply(tuple(start), quaternion.exponential((0.001, 0.002, 0.003)))
    np.testing.assert_allclose(algorithm.dcm, dcm_of(expected), atol=1e-12)


def test_bortz_series_meets_the_closed_form():
    """
    The series of Bortz's equation meets the closed form at d^2 = 0.01 to rounding, 1e-16 / d^2.

    Near 2 pi the closed form is large.
    """
    half = 0.5 * math.sqrt(0.01)
    assert bortz_factor(0.01 - 1e-12) == pytest.approx((1 - half / math.tan(half)) / 0.01,
                                                       abs=3e-14)
    assert bortz_factor(0.0) == 1.0 / 12.0
    assert bortz_factor(math.pi ** 2) == pytest.approx(1.0 / math.pi ** 2)
    assert bortz_factor(6.28 ** 2) > 5.0


def test_shorter_is_the_same_rotation():
    """``shorter`` returns the same rotation as a vector of length at most pi."""
    for d in (1.0, 3.2, 5.0, 6.2):
        theta = (0.6 * d, 0.0, 0.8 * d)
        short = shorter(theta)
        assert math.hypot(*short) <= math.pi
        np.testing.assert_allclose(dcm_of(quaternion.exponential(short)),
                                   dcm_of(quaternion.exponential(theta)), atol=1e-14)


def test_quaternion_of_a_dcm():
    """All four branches give the quaternion of a DCM; roll is right wing down."""
    for seed in range(50):
        q = np.random.default_rng(seed).normal(size=4) ** 3
        q /= np.linalg.norm(q)
        back = np.array(quaternion_of(dcm_of(tuple(q.tolist()))))
        assert min(abs(back - q).max(), abs(back + q).max()) < 1e-14
    assert roll_of_matrix(dcm_of(quaternion.exponential((0.2, 0.0, 0.0)))) == pytest.approx(0.2)


def test_unknown_algorithm():
    """The message for an unknown algorithm names it and lists the known ones."""
    with pytest.raises(ValueError, match="orientation is 'euler'; expected poisson, euler_vector"):
        Orientation('euler')
