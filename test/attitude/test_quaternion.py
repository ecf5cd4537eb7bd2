"""Quaternions compared with SciPy: product, rotation, exponential, logarithm."""

from hypothesis import given, strategies as st
import numpy as np
from scipy.spatial.transform import Rotation

from ins_sim.core.attitude import quaternion
from support.conventional import matrix

VECTORS = st.tuples(*[st.floats(-3.0, 3.0)] * 3)


@given(VECTORS, VECTORS)
def test_quaternions_are_scipys(a, b):
    """Product, rotation, exponential and logarithm agree with SciPy: Hamilton, scalar last."""
    p, q = quaternion.exponential(a), quaternion.exponential(b)
    ra, rb = Rotation.from_rotvec(a), Rotation.from_rotvec(b)
    np.testing.assert_allclose(matrix(quaternion.multiply(p, q)), (ra * rb).as_matrix(),
                               atol=1e-14)
    np.testing.assert_allclose(quaternion.rotate(p, b), ra.apply(b), atol=1e-13)
    np.testing.assert_allclose(quaternion.rotate_back(p, b), ra.inv().apply(b), atol=1e-13)
    np.testing.assert_allclose(quaternion.logarithm(quaternion.multiply(p, q)),
                               (ra * rb).as_rotvec(), atol=1e-7)


@given(st.tuples(*[st.floats(-1e-3, 1e-3)] * 3), st.floats(1e-9, 1.0))
def test_logarithm_inverts_exponential_at_any_size(direction, scale):
    """
    From 1e-12 rad to pi the logarithm inverts the exponential to a relative error of rounding.

    The formula with atan2 loses no digits.
    """
    phi = tuple(1e3 * scale * x for x in direction)
    back = quaternion.logarithm(quaternion.exponential(phi))
    np.testing.assert_allclose(back, phi, rtol=1e-14, atol=1e-15 * np.linalg.norm(phi) + 1e-300)
