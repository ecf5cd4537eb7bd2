"""
Records and messages: which quantity is which double of which message.

Blocks are arrays of one row a message, in the order of the writer's runs; the ``..._one``
functions give the runs of a single message as tuples of floats.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import within_half_turn_deg
from . import topics

# of what is published on aided/sigma/*
SIGMAS = 3.0


def truth_blocks(frame, truth):
    """Return {Topic: values (n, k)} of a Truth record; frame: MapFrame."""
    r_m, q_mb, v_b = frame.pose(truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)
    return {
        topics.TRUTH_ODOMETRY: np.concatenate(
            [r_m, q_mb, v_b, _rate_in_map(frame, q_mb, truth.omega_ib_b)], axis=1),
        topics.TRUTH_ATTITUDE: truth.q_nb,
        topics.TRUTH_FIX: _fix(truth),
        topics.TRUTH_IMU: np.concatenate([q_mb, truth.omega_ib_b, truth.f_ib_b], axis=1),
    }


def truth_one(truth):
    """Return the runs of each of topics.TRUTH of an AdaptedTruth."""
    return (((*truth.r_m, *truth.q_mb), (*truth.v_b, *truth.omega_mb_b)), (truth.q_nb,),
            (fix_one((truth.lat, truth.lon, truth.height)),),
            (truth.q_mb, truth.omega_ib_b, truth.f_ib_b))


def imu_block(imu):
    """Return {Topic: values} of ImuSamples."""
    return {topics.IMU_RAW: np.concatenate([imu.omega, imu.f], axis=1)}


def state_blocks(frame, states, omega):
    """
    Return {Topic: values} of NavStates.

    omega (n, 3): the readings of the gyros at the same stamps, from which the angular velocity
    of the odometry is the rate relative to the Earth.
    """
    r_m, q_mb, v_b = frame.pose(states.lat, states.lon, states.height, states.v_n, states.q_nb)
    return {
        topics.INS_ODOMETRY: np.concatenate(
            [r_m, q_mb, v_b, _rate_in_map(frame, q_mb, omega)], axis=1),
        topics.INS_FIX: _fix(states),
    }


def error_blocks(errors):
    """Return {Topic: values} of NavErrors."""
    return dict(zip(topics.ERRORS, (errors.attitude, errors.velocity, errors.position,
                                    errors.drift)))


def aided_error_blocks(errors):
    """Return {Topic: values} of AidedErrors: errors, and SIGMAS standard deviations."""
    three = (errors.attitude_sigma, errors.velocity_sigma, errors.position_sigma)
    return dict(zip((*topics.AIDED_ERRORS, *topics.AIDED_SIGMAS), (
        errors.attitude, errors.velocity, errors.position, *(SIGMAS * s for s in three))))


def odometry_one(frame, solution, omega):
    """Return the runs of ins/odometry: solution (lat, lon, height, v_n, q_nb), gyro reading."""
    r_m, q_mb, v_b = frame.pose_one(*solution)
    turn = quaternion.rotate_back(q_mb, frame.omega_ie_m)
    return (*r_m, *q_mb), (*v_b, omega[0] - turn[0], omega[1] - turn[1], omega[2] - turn[2])


def fix_one(solution):
    """Return the run of a NavSatFix: latitude, longitude (deg, within +-180) and height, m."""
    lon_deg = math.degrees(solution[1])
    if abs(lon_deg) > 180.0:
        lon_deg = float(within_half_turn_deg(lon_deg))
    return math.degrees(solution[0]), lon_deg, solution[2]


def aided_odometry_one(frame, solution, omega, sigmas):
    """
    Return the runs of aided/odometry, those of ins/odometry each followed by its covariance.

    sigmas: of position (m), velocity (m/s) and attitude (rad) in East, North, Up, or None.  Their
    covariances are turned into the axes of map and base_link, correlations being left out; those
    of rates, and without sigmas of all, are zero: unknown.
    """
    pose, twist = odometry_one(frame, solution, omega)
    if sigmas is None:
        return pose, _UNKNOWN, twist, _UNKNOWN
    q_nb = solution[4]
    q_mn = quaternion.multiply(pose[3:], quaternion.conjugate(q_nb))
    position, velocity, turned = sigmas
    return (pose, _blocks(_turned(q_mn, position), _turned(q_mn, turned)), twist,
            _blocks(_turned(quaternion.conjugate(q_nb), velocity), _UNKNOWN[:9]))


_UNKNOWN = (0.0,) * 36


def _turned(q, sigmas):
    """Return C diag(sigmas^2) C^T for the quaternion q of C, row by row."""
    axes = [quaternion.rotate(q, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0),
                                                    (0.0, 0.0, 1.0))]
    return [sum(s * s * axis[i] * axis[k] for s, axis in zip(sigmas, axes))
            for i in range(3) for k in range(3)]


def _blocks(upper, lower):
    """Return the covariance of 6 x 6 with two blocks of 3 x 3 in its diagonal."""
    nothing = [0.0] * 3
    rows = [upper[k:k + 3] + nothing for k in (0, 3, 6)]
    rows += [nothing + list(lower[k:k + 3]) for k in (0, 3, 6)]
    return [x for row in rows for x in row]


def aided_fix_one(solution, sigmas):
    """Return the runs of aided/fix: place and variances by East, North, Up, zero if unknown."""
    variances = ((s * s,) for s in (sigmas[0] if sigmas else (0.0,) * 3))
    return fix_one(solution), *variances


def _rate_in_map(frame, q_mb, omega):
    turn = quaternion.rotate_back(np.moveaxis(q_mb, -1, 0), frame.omega_ie_m)
    return omega - np.stack(turn, axis=-1)


def _fix(record):
    return np.stack([np.degrees(record.lat), within_half_turn_deg(np.degrees(record.lon)),
                     record.height], axis=-1)
