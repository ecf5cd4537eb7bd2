"""Three one-hour flights in closed form: a cruise, a racetrack and an aggressive flight."""

import math

import numpy as np

from ins_sim.core.attitude import angles
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import elementary, taylor
from ins_sim.core.numerics.units import STANDARD_GRAVITY
from .motion import Motion

TWO_PI = 2.0 * math.pi
# Angle, amplitude (deg), angular frequency (rad/s, as a factor of p), phase. The oscillations are
# added to the base angles.
CRUISE_WOBBLE = {
    'gamma': ((1.0, 0.31, 0.0), (0.5, 0.73, 1.1), (0.2, 1.37, 0.4)),
    'theta': ((0.4, 0.19, 0.7), (0.3, 0.57, 2.1), (0.1, 1.91, 1.3)),
    'psi': ((0.5, 0.31, 0.9), (0.2, 0.47, 0.2), (0.1, 1.37, 1.9))}
AGGRESSIVE_WOBBLE = {'gamma': ((25.0, 1 / 7, 0.0),), 'theta': ((6.0, 1 / 5, 1.0),),
                     'psi': ((5.0, 1 / 6, 2.0),)}
CROSS_TRACK = ((6000.0, 500.0, 60.0), (-15000.0, 1300.0, 90.0), (12000.0, 2200.0, 90.0),
               (-4000.0, 3000.0, 60.0))


def _log_cosh(x):
    """Return ln cosh x of a float."""
    return float(taylor.log_cosh(taylor.Series.time(np.array([x]), 1)).value[0])


def _cruise(t):
    """Return east, north, height: speed and height change by tanh steps; four side steps."""
    climb, slow = (t - 300.0) / 80.0, (t - 3200.0) / 80.0
    s = t * 100.0 + (taylor.log_cosh(climb) - taylor.log_cosh(slow)) * (65.0 * 80.0)
    s = s - 65.0 * 80.0 * (_log_cosh(300.0 / 80.0) - _log_cosh(3200.0 / 80.0))
    c = t.constant(0.0)
    for step, tk, width in CROSS_TRACK:
        c = c + (taylor.tanh((t - tk) / width) * (0.5 * step) + 0.5 * step)
    sin, cos = elementary.sincos(math.radians(300.0))
    h = (taylor.tanh((t - 600.0) / 250.0) - taylor.tanh((t - 3000.0) / 250.0)) * 4900.0 + 200.0
    return s * sin + c * cos, s * cos - c * sin, h


def _racetrack(t):
    s, c = taylor.sincos(t * (TWO_PI / 400.0))
    return (1.0 - c) * 15000.0, s * 6000.0, t.constant(6000.0)


def _aggressive(t):
    s1, c1 = taylor.sincos(t * (TWO_PI / 200.0))
    s2, c2 = taylor.sincos(t * (TWO_PI / 55.0))
    h = (taylor.sin(t * (TWO_PI / 90.0)) * 1200.0 + taylor.sin(t * (TWO_PI / 37.0)) * 300.0
         + 5000.0)
    return ((1.0 - c1) * 8000.0 + (1.0 - c2) * 1200.0, s1 * 8000.0 + s2 * 1200.0, h)


def _wobbling(angle, t, terms):
    """Return an angle plus the oscillations listed for it in terms; both are Series."""
    for amplitude_deg, frequency, phase in terms:
        angle = angle + taylor.sin(t * (TWO_PI * frequency) + phase) * math.radians(amplitude_deg)
    return angle


def _flight(path, trim_deg, wobble):
    """Return a function that makes the pose and the path, with coordinated angles plus wobble."""
    def at_datum(datum):
        lat0, lon0 = math.radians(datum.latitude_deg), math.radians(datum.longitude_deg)
        per_lon = ellipsoid.MEAN_RADIUS * elementary.cos(lat0)

        def located(east, north, height):
            return north / ellipsoid.MEAN_RADIUS + lat0, east / per_lon + lon0, height

        def pose(t):
            east, north, height = path(t)
            v_east, v_north = east.derivative(), north.derivative()
            speed = taylor.sqrt(v_east * v_east + v_north * v_north)
            psi = taylor.atan2(v_east, v_north)
            theta = taylor.atan2(height.derivative(), speed)
            gamma = taylor.atan2(speed * psi.derivative(), t.constant(STANDARD_GRAVITY))
            # Pitch and bank come from derivatives, so their order is two lower.
            low = taylor.Series(t.c[:len(gamma.c)])
            psi, theta, gamma = (_wobbling(angle, low, wobble[name]) for name, angle in (
                ('psi', psi), ('theta', theta), ('gamma', gamma)))
            q_nb = angles.from_angles(-psi, theta + math.radians(trim_deg), gamma)
            return *located(east, north, height), q_nb

        return pose, lambda t: located(*path(t))

    return at_datum


FLIGHTS = {'cruise': _flight(_cruise, 3.0, CRUISE_WOBBLE),
           'racetrack': _flight(_racetrack, 3.0, CRUISE_WOBBLE),
           'aggressive': _flight(_aggressive, 0.0, AGGRESSIVE_WOBBLE)}


def flight_motion(motion, datum, earth):
    """Return the flight named by MotionSettings, starting at a Datum; earth: Earth."""
    pose, path = FLIGHTS[motion.kind](datum)
    return Motion(pose, 3, earth.rotation, path=path, gravity=earth.gravity)
