"""Small offsets on the ellipsoid, and the rate of the Earth."""

import math

from ins_sim.core.earth import ellipsoid
import numpy as np
import pytest

PLACE = (math.radians(55.0), math.radians(179.99999), 300.0)


def test_offset_is_the_inverse_of_moved():
    """``offset`` and ``moved`` are inverse to 1e-9 m, the rounding of an angle, for any angle."""
    enu = (12.0, -30.0, 4.0)
    lat, lon, height = ellipsoid.moved(*PLACE, enu)
    for turns in (-1, 0, 1):
        found = ellipsoid.offset(*PLACE, (lat, lon + turns * 2.0 * math.pi, height))
        assert found == pytest.approx(enu, abs=2e-8)


def test_moved_is_the_offset_between_cartesian_points():
    """The offset differs from the straight line by d^2 / 2R only."""
    def ecef(lat, lon, height):
        return np.array(ellipsoid.ecef(math.sin(lat), math.cos(lat), math.sin(lon), math.cos(lon),
                                       height))

    far = ecef(*ellipsoid.moved(*PLACE, (300.0, 400.0, 0.0))) - ecef(*PLACE)
    assert np.linalg.norm(far) == pytest.approx(500.0, abs=500.0 ** 2 / 2.0 / 6.3e6)


def test_moved_takes_arrays_with_the_bits_of_floats():
    """``moved`` of an array of offsets has the bits of its elements."""
    enu = np.array([[1.0, -200.0, 3.0], [1e-3, 5.0, -7.0]])
    places = np.stack(ellipsoid.moved(*PLACE, enu.T), axis=-1)
    assert places.tolist() == [list(ellipsoid.moved(*PLACE, one)) for one in enu.tolist()]


def test_rotation_rate():
    """The rotation rate is that of WGS-84, or zero for a non-rotating Earth."""
    assert (ellipsoid.rotation_rate(True), ellipsoid.rotation_rate(False)) == (7.292115e-5, 0.0)
