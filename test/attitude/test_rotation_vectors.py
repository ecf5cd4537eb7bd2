"""Exponential and logarithm of arrays are those of floats, to the bit."""

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
    """Short vectors (by series) and long ones (by sine and cosine) have the bits of floats."""
    for phi in (vectors(), vectors()[:, :4]):
        assert np.array_equal(np.array(exponentials(phi)).T,
                              [quaternion.exponential(row) for row in phi.T.tolist()])


def test_logarithms():
    """Both signs of a quaternion, and one with another norm, have the bits of floats."""
    q = np.array(exponentials(vectors())) * RNG.choice([-1.0, 1.0, 0.7], 4000)
    assert np.array_equal(np.array(quaternion.logarithm(q)).T,
                          [quaternion.logarithm(row) for row in q.T.tolist()])
