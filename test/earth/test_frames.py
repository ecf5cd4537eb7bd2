"""The map frame, a plane tangent at the datum, and the conversion to geodetic and back."""

import math

from hypothesis import given, settings as hypothesis_settings, strategies as st
import numpy as np
import pytest

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.frames import MapFrame
from ins_sim.settings.place import Datum
from support.conventional import matrix

VECTORS = st.tuples(*[st.floats(-3.0, 3.0)] * 3)


@given(st.floats(-80, 80), st.floats(-180, 180), st.floats(-2, 2), st.floats(-2, 2), VECTORS)
@hypothesis_settings(deadline=None)
def test_map_frame_round_trip(lat, lon, d_lat, d_lon, phi):
    """A pose converted to map and back is recovered up to hundreds of kilometres away."""
    frame = MapFrame(Datum(lat, lon, 100.0), True)
    here = (math.radians(lat + d_lat), math.radians(lon + d_lon), 5000.0, (10.0, 20.0, 3.0),
            quaternion.exponential(phi))
    back = frame.geodetic_one(*frame.pose_one(*here))
    assert abs(back[0] - here[0]) < 2e-15
    assert abs(math.remainder(back[1] - here[1], 2 * math.pi)) < 1e-14
    assert abs(back[2] - 5000.0) < 1e-8
    np.testing.assert_allclose(back[3], here[3], atol=1e-13)
    np.testing.assert_allclose(matrix(back[4]), matrix(here[4]), atol=1e-14)
    arrays = frame.pose(*(np.array([x]) for x in here))
    for one, many in zip(frame.pose_one(*here), arrays):
        np.testing.assert_allclose(many[0], one, rtol=1e-15, atol=1e-9)


def test_map_is_the_tangent_plane_at_the_datum():
    """The origin of map is the datum, east and north are in the plane, the ground is below."""
    frame = MapFrame(Datum(55.0, 37.0, 0.0), True)
    level = quaternion.IDENTITY
    lat, lon = math.radians(55.0), math.radians(37.0)
    r, _, _ = frame.pose_one(lat, lon, 0.0, (0.0, 0.0, 0.0), level)
    np.testing.assert_allclose(r, 0.0, atol=1e-8)
    r, _, _ = frame.pose_one(lat + 1e-3, lon, 0.0, (0.0, 0.0, 0.0), level)
    # Over this distance the meridian radius changes by 3 e^2 sin(lat) cos(lat) 1e-3 = 1e-5.
    radius = ellipsoid.radii(math.sin(lat))[0]
    assert r[1] == pytest.approx(1e-3 * radius, rel=1e-5)
    assert r[2] == pytest.approx(-0.5 * r[1] ** 2 / radius, rel=1e-5)
