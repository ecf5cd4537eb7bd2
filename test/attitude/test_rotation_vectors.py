"""Exponential and logarithm of arrays equal those of floats, to the bit."""

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.rotation_vectors import exponentials
import numpy as np

RNG = np.random.default_rng(8)


def vectors():
    """Return rotation vectors of all lengths, (3, n), including zero."""
    size = 10.0 ** RNG.uniform(-170.0, 0.8, 4000)
    size[:5] = 0.0
    size[5:2000] = 10.0 ** RNG.uniform(-5.0, 0.8, 1995)
    return size * RNG.normal(size=(3, 4000))


def test_exponentials():
    """Exponentials of short vectors (series) and long ones have the bits of floats."""
    for phi in (vectors(), vectors()[:, :4]):
        assert np.array_equal(np.array(exponentials(phi)).T,
                              [quaternion.exponential(row) for row in phi.T.tolist()])


def test_logarithms():
    """The logarithm has the bits of floats for both signs of a quaternion and for another norm."""
    q = np.array(exponentials(vectors())) * RNG.choice([-1.0, 1.0, 0.7], 4000)
    assert np.array_equal(np.array(quaternion.logarithm(q)).T,
                          [quaternion.logarithm(row) for row in q.T.tolist()])
