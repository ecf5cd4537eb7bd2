"""
Orthodromic coordinates: round trip, comparison with an independent library, and sign of Z.

Rounding: the last digit of a latitude or longitude near 180 deg is 2^-52 rad, 1.4e-9 m; a few of
them add up to the bounds of 1e-8 m.
"""

import math

from hypothesis import assume, given, strategies as st
import numpy as np
import pytest

from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.great_circle import AXIS_RATIO2, GreatCircleRoute, Leg, unit_vector
from ins_sim.settings.route import TurningPoints

R0 = ellipsoid.MEAN_RADIUS
LATITUDES = st.floats(-1.56, 1.56)
LONGITUDES = st.floats(-math.pi, math.pi)


def apart(p, q):
    """Return the distance (m) of points (lat, lon), along the chord of the sphere."""
    return R0 * np.sqrt(sum((a - b) ** 2 for a, b in zip(unit_vector(*p), unit_vector(*q))))


def a_leg(lat1, lon1, lat2, lon2):
    """Return a Leg, or skip the example if the points do not define one well."""
    u, v = unit_vector(lat1, lon1), unit_vector(lat2, lon2)
    assume(1e-3 < math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(u, v))))) < 3.0)
    return Leg(lat1, lon1, lat2, lon2)


@given(LATITUDES, LONGITUDES, LATITUDES, LONGITUDES, LATITUDES, LONGITUDES)
def test_there_and_back(lat1, lon1, lat2, lon2, lat, lon):
    """Any point is recovered from its X and Z."""
    leg = a_leg(lat1, lon1, lat2, lon2)
    assert apart((lat, lon), leg.from_xz(*leg.to_xz(lat, lon))) < 1e-8


def test_the_worst_of_many_there_and_back():
    """A million points on two hundred legs, up to the poles of the leg, are recovered."""
    rng = np.random.default_rng(1)
    worst = far = 0.0
    for _ in range(200):
        lat, lon = np.arcsin(rng.uniform(-1, 1, 5002)), rng.uniform(-math.pi, math.pi, 5002)
        leg = Leg(lat[0], lon[0], lat[1], lon[1])
        x, z = leg.to_xz(lat[2:], lon[2:])
        back = leg.from_xz(x, z)
        assert isinstance(leg.to_xz(float(lat[2]), float(lon[2]))[0], float)
        np.testing.assert_allclose(leg.to_xz(float(lat[2]), float(lon[2])), (x[0], z[0]), 0, 1e-8)
        worst = max(worst, apart((lat[2:], lon[2:]), back).max())
        again = leg.to_xz(*back)
        turn = np.abs(np.remainder(again[0] - x + math.pi * R0, 2 * math.pi * R0) - math.pi * R0)
        far = max(far, (turn * np.cos(z / R0)).max(), np.abs(again[1] - z).max())
    print(f'\nworst of a million: position {worst:.2e} m, X cos(Z/R0) and Z {far:.2e} m (1e-6)')
    assert worst < 1e-8 and far < 1e-8


def test_lengths_and_courses_of_geographiclib():
    """
    Lengths and courses agree with GeographicLib (Karney's inverse problem on the sphere).

    The sphere has geocentric latitudes.
    """
    geodesic = pytest.importorskip('geographiclib.geodesic').Geodesic(R0, 0.0)
    rng = np.random.default_rng(2)
    worst = np.zeros(4)
    for _ in range(2000):
        lat, lon = rng.uniform(-1.5, 1.5, 2).tolist(), rng.uniform(-math.pi, math.pi, 2).tolist()
        centric = [math.degrees(math.atan(AXIS_RATIO2 * math.tan(x))) for x in lat]
        leg = Leg(lat[0], lon[0], lat[1], lon[1])
        if leg.length > 0.95 * math.pi * R0:
            continue
        other = geodesic.Inverse(centric[0], math.degrees(lon[0]), centric[1],
                                 math.degrees(lon[1]))
        chi = leg.course(np.array(lat), np.array(lon))
        turned = [math.remainder(a - math.radians(b), 2 * math.pi)
                  for a, b in zip(chi, (other['azi1'], other['azi2']))]
        x, z = leg.to_xz(lat[1], lon[1])
        worst = np.maximum(worst, np.abs((leg.length - other['s12'], x - leg.length, z,
                                          max(map(abs, turned)))))
    print('\nlength {:.2e} m, X and Z of the second point {:.2e}, {:.2e} m, courses {:.2e} rad'
          .format(*worst))
    # Course of a leg of 2 km or more: the last digit of degrees is 3e-14.
    assert worst[:3].max() < 2e-8 and worst[3] < 1e-10


@given(LATITUDES, LONGITUDES, LATITUDES, LONGITUDES, st.floats(0.0, 1.0), st.floats(-0.3, 0.3))
def test_the_course_turns_small_displacements(lat1, lon1, lat2, lon2, part, side):
    """E = X sin(chi) + Z cos(chi) and N = X cos(chi) - Z sin(chi) hold to second order."""
    leg = a_leg(lat1, lon1, lat2, lon2)
    x, z, small = part * leg.length, side * R0, 100.0
    lat, lon = leg.from_xz(x, z)
    centric = math.atan(AXIS_RATIO2 * math.tan(lat))
    assume(abs(centric) < 1.5)
    chi = leg.course(lat, lon)
    for dx, dz in ((small, 0.0), (0.0, small)):
        # X is an angle about the pole of the leg.
        lat2, lon2 = leg.from_xz(x + dx / math.cos(z / R0), z + dz)
        north = R0 * (math.atan(AXIS_RATIO2 * math.tan(lat2)) - centric)
        east = R0 * math.cos(centric) * math.remainder(lon2 - lon, 2 * math.pi)
        # 100 m on a parallel whose radius is at least 0.07 R0, and on a circle of latitude.
        bound = 2.0 * small ** 2 / R0 * (1.0 + math.tan(abs(centric)))
        assert east == pytest.approx(dx * math.sin(chi) + dz * math.cos(chi), abs=bound)
        assert north == pytest.approx(dx * math.cos(chi) - dz * math.sin(chi), abs=bound)


def test_z_is_to_the_right():
    """Z is positive south of an eastward leg and east of a northward one."""
    assert Leg(0.0, 0.0, 0.0, 1.0).to_xz(-0.1, 0.5)[1] > 0.0
    assert Leg(0.0, 0.0, 1.0, 0.0).to_xz(0.5, 0.1)[1] > 0.0


def test_both_ends_of_a_short_leg_are_on_it():
    """The great circle through points ten metres apart contains both to rounding."""
    rng = np.random.default_rng(5)
    worst = 0.0
    for _ in range(500):
        lat, lon, chi = rng.uniform(-1.5, 1.5), rng.uniform(-3.0, 3.0), rng.uniform(0.0, 6.0)
        end = (lat + 2e-6 * math.cos(chi), lon + 2e-6 * math.sin(chi) / math.cos(lat))
        leg = Leg(lat, lon, *end)
        ends = np.array((leg.to_xz(lat, lon), leg.to_xz(*end)))
        # The middle of the leg is where the leg itself computes it.
        middle = leg.to_xz(*leg.from_xz(0.5 * leg.length, 0.0))
        worst = max(worst, np.abs(ends - ((0.0, 0.0), (leg.length, 0.0))).max(), abs(middle[1]))
    print(f'\nlegs of 13 m: ends and middle off by {worst:.1e} m')
    assert worst < 1e-8


def test_legs_change_at_the_bisector():
    """At a corner of 90 deg the next leg begins on the line at 45 deg, on either side."""
    lat, lon = [0.0, 0.0, 0.02], [0.0, 0.02, 0.02]
    route = GreatCircleRoute(lat, lon)
    for side in (-1e-4, 1e-4):
        # On the bisector, inside and outside the corner, in geocentric latitude.
        up = math.atan(math.tan(side) / AXIS_RATIO2)
        assert route.leg_at(up, 0.02 - side - 1e-9) == 0
        assert route.leg_at(up, 0.02 - side + 1e-9) == 1
    assert route.leg_at(0.0, 0.0, leg=1) == 1
    assert route.starts[1] == pytest.approx(0.02 * R0)
    assert route.length == sum(leg.length for leg in route.legs)


def test_a_route_that_crosses_itself_keeps_its_order():
    """On a square route that crosses its first side the current leg never goes back."""
    lat, lon = [0.0, 0.0, 0.02, 0.02, -0.02], [-0.02, 0.02, 0.02, 0.0, 0.0]
    route = GreatCircleRoute(lat, lon)
    way = [leg.from_xz(np.linspace(0.01 * leg.length, 0.99 * leg.length, 99), np.zeros(99))
           for leg in route.legs]
    lats, lons = (np.concatenate(parts) for parts in zip(*way))
    index, leg = route.legs_at(lats, lons), 0
    assert index.tolist() == np.repeat(range(4), 99).tolist()
    for k, point in enumerate(zip(lats.tolist(), lons.tolist())):
        leg = route.leg_at(*point, leg)
        assert leg == index[k]
    x, z = route.to_xz(lats, lons, index)
    assert np.abs(z).max() < 1e-8
    assert x[0] == pytest.approx(0.01 * route.legs[0].length, abs=1e-8)
    assert route.to_xz(float(lats[-1]), float(lons[-1]), 3)[0] == pytest.approx(x[-1], abs=1e-8)


BAD = [((55.0,), (37.0,), 'the route has 1 turning points; expected two or more'),
       ((), (), 'the route has 0 turning points'),
       ((55.0, 56.0), (37.0,), 'the route has 2 latitudes and 1 longitudes; expected equal'),
       ((55.0, 55.0), (37.0, 37.0), 'the leg from 55, 37 deg to 55, 37 deg joins the same point'),
       ((55.0, 56.0, 56.0), (180.0, 180.0, -180.0), 'joins the same point'),
       ((55.0, -55.0), (37.0, -143.0), 'joins antipodes; expected points with one great circle')]


@pytest.mark.parametrize('lat, lon, sentence', BAD)
def test_bad_points(lat, lon, sentence):
    """Points without a leg give one message with the points and what is expected."""
    with pytest.raises(ValueError) as error:
        GreatCircleRoute.of_points(TurningPoints(lat, lon))
    assert str(error.value).startswith('motion.route.points: ')
    assert sentence in str(error.value) and '\n' not in str(error.value)
