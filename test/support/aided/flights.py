"""
Closed-form flights for the tests of the aided navigator, with IMU samples and velocity fixes.
"""

import math

from ins_sim.core.attitude import angles
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import taylor
from ins_sim.settings.catalogue import build
from ins_sim.core.timeseries.fixes import VelocityFix
from ins_sim.core.sensors.imu.ideal import MotionImu
from ins_sim.core.earth.rates import body_velocity
from ins_sim.core.motion.motion import Motion
from ins_sim.settings.imu import ImuSensorSettings
import numpy as np

DT_NS = 10_000_000


def circle(rate_deg_s=1.2, speed=200.0):
    """Return a flat turn at constant speed, heading along the track, wings level."""
    w = math.radians(rate_deg_s)
    # Without meridian convergence, because psi is counted from north.
    lat0, lon0, radius = math.radians(1.0), math.radians(37.0), speed / w
    r_n, r_e = (r + 500.0 for r in ellipsoid.radii(math.sin(lat0)))

    def pose(t):
        s, c = taylor.sincos(t * w)
        # Clockwise from north: east = r (1 - cos), north = r sin.
        q = angles.from_angles(t * -w, t.constant(0.0), t.constant(0.0))
        return (s * (radius / r_n) + lat0,
                (1.0 - c) * (radius / (r_e * math.cos(lat0))) + lon0, t.constant(500.0), q)

    return Motion(pose, 3, True)


def straight(speed=200.0):
    """Return a flight north along a meridian, which is a great circle."""
    lat0, lon0 = math.radians(55.0), math.radians(37.0)

    def pose(t):
        level = t.constant(0.0)
        return (t * (speed / 6371000.0) + lat0, level + lon0, t.constant(500.0),
                angles.from_angles(level, level, level))

    return Motion(pose, 3, True)


def samples_of(motion, count, bias=(0.0, 0.0, 0.0)):
    """
    Return the IMU samples that AidedNavigator.step accepts: count samples at 100 Hz from motion
    time 0.

    bias: added to perfect readings of the accelerometers, m/s^2.
    """
    imu = MotionImu(build(ImuSensorSettings, {}), motion, 0).advance(count)
    truth = motion.at(imu.t_ns)
    places = zip(truth.lat.tolist(), truth.lon.tolist(), truth.height.tolist(),
                 map(tuple, truth.v_n.tolist()), map(tuple, truth.q_nb.tolist()))
    return list(zip(imu.t_ns.tolist(), map(tuple, imu.omega.tolist()),
                    map(tuple, (imu.f + bias).tolist()), places))


def perfect_fixes(motion, windows, cycles, offset=(0.0, 0.0), sigma=(1.0, 1.0), late_ns=0):
    """
    Return the VelocityFixes of the first windows.

    offset: added to the velocity, m/s; late_ns: time from the end of the window to the arrival,
    ns.
    """
    v_b = body_velocity(motion.at(np.arange(windows * cycles + 1) * DT_NS))[:, :2]
    means = (0.5 * (v_b[:-1] + v_b[1:])).reshape(windows, cycles, 2).mean(axis=1) + offset
    span = cycles * DT_NS
    return [VelocityFix(k * span, (k + 1) * span, cycles, tuple(mean), sigma,
                        arrival_ns=(k + 1) * span + late_ns)
            for k, mean in enumerate(means.tolist())]
