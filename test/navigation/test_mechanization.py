"""The step of position and velocity anywhere on Earth, for any interval, and its order."""

import math

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation import mechanization, polar_step
from ins_sim.core.navigation.vertical_channel import DAMPED, damping, FREE, FROM_TRUTH
import numpy as np
import pytest

SPIN = ellipsoid.ROTATION_RATE
NOTHING = (0.0, 0.0, 0.0, 0.0, 0.0)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
# A circular orbit in a plane through the Earth's axis: 300 m/s; m and rad/s.
RADIUS, RATE = 6.36e6, 300.0 / 6.36e6


class Orbit:
    """A point on an inertial circle at constant rate that misses the pole by miss (m) at t = 0."""

    def __init__(self, miss):
        self.tilt = miss / RADIUS

    def at(self, t):
        """Return position, velocity and acceleration in i."""
        a = RATE * t
        s, c = math.sin(a), math.cos(a)
        y, z = math.sin(self.tilt), math.cos(self.tilt)
        r = RADIUS * np.array((s, c * y, c * z))
        return r, RADIUS * RATE * np.array((c, -s * y, -s * z)), -RATE * RATE * r

    def force(self, t):
        """Return the specific force in i, m/s^2."""
        r, _, acceleration = self.at(t)
        return acceleration - polar_step.gravitation(tuple(r.tolist()), SPIN)[0]

    def increment(self, start, dt):
        """Return the integral of the specific force over an interval, exact to rounding."""
        return tuple((0.5 * dt * sum(w * self.force(start + 0.5 * dt * (1.0 + x))
                                     for x, w in zip(NODES, WEIGHTS))).tolist())


def off_track(miss, dt, half_s):
    """Return the deviation from the orbit after passing the pole, m and m/s."""
    orbit = Orbit(miss)
    r, v, _ = orbit.at(-half_s)
    sin_lat, cos_lat, sin_lon, cos_lon, height = ellipsoid.geodetic_directions(*r.tolist())
    v_n = polar_step.in_level(v, r, sin_lat, cos_lat, sin_lon, cos_lon, SPIN)
    place = mechanization.begin(math.atan2(sin_lat, cos_lat), math.atan2(sin_lon, cos_lon),
                                height, v_n, 0.0)
    count = round(2.0 * half_s / dt)
    for k in range(count):
        place = mechanization.advance(place, quaternion.IDENTITY,
                                      orbit.increment(-half_s + k * dt, dt), dt, SPIN,
                                      SPIN * k * dt, FREE, NOTHING)
    lat, lon, height, *v_n = place[:6]
    lon += SPIN * count * dt
    frame = math.sin(lat), math.cos(lat), math.sin(lon), math.cos(lon)
    found = np.array(ellipsoid.ecef(*frame, height))
    r, v, _ = orbit.at(half_s)
    return (np.linalg.norm(found - r),
            np.linalg.norm(np.array(polar_step.in_inertial(v_n, found, *frame, SPIN)) - v))


@pytest.mark.parametrize('miss', [0.0, 1.0, 5e3, 3.17e5, 3.3e5])
def test_a_pole_is_passed(miss):
    """A pass over or near a pole is as accurate as anywhere else, with both kinds of step."""
    position, velocity = off_track(miss, 0.1, 60.0)
    # Mid-interval values are second order in dt: v' changes by 3e-5 1/s of 10 m/s^2 over the
    # interval. The error per step is of order dt^3, and 1200 steps add up to at most 1e-4 m.
    assert position < 1e-3 and velocity < 1e-4


@pytest.mark.parametrize('miss', [0.0, 3.3e5])
def test_a_pole_is_passed_in_second_order(miss):
    """Half the step leaves less than 0.4 of the error behind a pole: second order."""
    coarse, fine = (off_track(miss, dt, 40.0)[0] for dt in (1.0, 0.5))
    print(f'\npole missed by {miss:g} m: {coarse:.2e} m at 1 s, {fine:.2e} m at 0.5 s')
    assert fine < 0.4 * coarse


@pytest.mark.parametrize('channel, reference', [
    (FREE, NOTHING), (FROM_TRUTH, (301.0, 0.5, 0.0, 0.0, 0.0)),
    (DAMPED, (301.0, 0.5, *damping(100.0)))])
def test_both_kinds_of_step_are_one(channel, reference):
    """The kinds of step differ by order dt^3: half the step divides the difference by eight."""
    differences = []
    for dt in (2.0, 1.0):
        place = mechanization.begin(0.9, 0.6, 300.0, (150.0, -100.0, 1.0), 0.3)
        force = (4.0, 5.0, 6.0)
        increment = tuple(dt * x for x in force)
        # Set the previous acceleration; without it the first step is of first order.
        small = mechanization.small_step(place, tuple(1e-3 * x for x in force), 1e-3, SPIN,
                                         channel, reference)
        place = (*place[:12], *small[12:15], *place[15:])
        one = mechanization.small_step(place, increment, dt, SPIN, channel, reference)
        other = polar_step.advance(place, increment, dt, SPIN, 0.3, channel, reference)
        differences.append([abs(a - b) for a, b in zip(one[:6], other[:6])])
    (lat, lon, height, *v), (lat_2, lon_2, height_2, *v_2) = differences
    assert RADIUS * lat < 1e-1 and RADIUS * lon < 1e-1 and height < 1e-1 and max(v) < 1e-1
    assert max(v_2) <= 0.3 * max(v) + 1e-9


def test_carried_sines_stay_those_of_the_angles():
    """After a day at 1 Hz the recursive sines differ from exact ones by less than 3e-14 rad."""
    place = mechanization.begin(0.9, 0.6, 300.0, (150.0, -100.0, 0.0), 0.0)
    for k in range(86400):
        place = mechanization.advance(place, quaternion.IDENTITY, (0.0, 0.0, 0.0), 1e-3, SPIN,
                                      SPIN * k * 1e-3, FROM_TRUTH, (300.0, 0.0, 0.0, 0.0, 0.0))
    sin_lat, cos_lat, sin_lon, cos_lon, rest_lat, rest_lon = place[6:12]
    off_lat = math.atan2(sin_lat, cos_lat) + rest_lat - place[0]
    off_lon = math.remainder(math.atan2(sin_lon, cos_lon) + rest_lon - place[1] - SPIN * 86.4,
                             2.0 * math.pi)
    assert abs(off_lat) < 3e-14 and abs(off_lon) < 3e-14


def test_no_number_is_no_error():
    """A solution that is not finite is advanced without an exception."""
    place = mechanization.begin(math.nan, 0.6, math.inf, (1.0, 2.0, math.nan), 0.0)
    for _ in range(300):
        place = mechanization.advance(place, quaternion.IDENTITY, (math.nan, 0.0, 1e300), 0.01,
                                      SPIN, 0.0, FREE, NOTHING)
    assert math.isnan(place[3])
