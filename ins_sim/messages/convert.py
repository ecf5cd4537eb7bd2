"""
Convert records to the doubles of messages.

The runs of a message are the slices of its doubles that change from message to message, see
``cdr.Writer``. Blocks are arrays with one row per message, which holds its runs one after the
other; the functions ``..._one`` return the runs of a single message as tuples of floats.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import within_half_turn_deg
from ins_sim.core.attitude.matrix import dcm_of, turned_back
from . import topics

# Number of standard deviations published on aided/sigma/*.
SIGMAS = 3.0


def truth_blocks(frame, truth):
    """Return {Topic: values (n, k)} of a Truth record; frame is a MapFrame."""
    r_m, q_mb, v_b = frame.pose(truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)
    return {
        topics.TRUTH_ODOMETRY: np.concatenate(
            [r_m, q_mb, v_b, _rate_in_map(frame, q_mb, truth.omega_ib_b)], axis=1),
        topics.TRUTH_ATTITUDE: truth.q_nb,
        topics.TRUTH_FIX: _fix(truth),
        topics.TRUTH_IMU: np.concatenate([q_mb, truth.omega_ib_b, truth.f_ib_b], axis=1),
    }


def truth_one(truth):
    """Return the runs of the messages on each of topics.TRUTH, from an AdaptedTruth."""
    return (((*truth.r_m, *truth.q_mb), (*truth.v_b, *truth.omega_mb_b)), (truth.q_nb,),
            (fix_one((truth.lat, truth.lon, truth.height)),),
            (truth.q_mb, truth.omega_ib_b, truth.f_ib_b))


def imu_block(imu):
    """Return {Topic: values} of ImuSamples."""
    return {topics.IMU_RAW: np.concatenate([imu.omega, imu.f], axis=1)}


def state_blocks(frame, states, imu, known):
    """
    Return {Topic: values} of NavStates.

    imu holds the ImuSamples of the same stamps, from which the angular velocity relative to the
    Earth is computed; known is a PublishedCovariance with arrays for all states.
    """
    r_m, q_mb, v_b = frame.pose(states.lat, states.lon, states.height, states.v_n, states.q_nb)
    velocity = turned_back(dcm_of(np.moveaxis(states.q_nb, -1, 0)), known.velocity.T)
    twist = np.zeros((len(states), 6, 6))
    twist[:, :3, :3] = np.stack(velocity, axis=-1).reshape(-1, 3, 3)
    twist[:, 3:, 3:] = known.rate.reshape(-1, 3, 3)
    return {
        topics.INS_ODOMETRY: np.concatenate(
            [r_m, q_mb, known.pose, v_b, _rate_in_map(frame, q_mb, imu.omega),
             twist.reshape(-1, 36)], axis=1),
        topics.INS_FIX: np.concatenate([_fix(states), known.place], axis=1),
        topics.IMU_DATA: np.concatenate(
            [q_mb, known.pose.reshape(-1, 6, 6)[:, 3:, 3:].reshape(-1, 9), imu.omega, imu.f],
            axis=1),
    }


def error_blocks(errors):
    """Return {Topic: values} of NavErrors."""
    return dict(zip(topics.ERRORS, (errors.attitude, errors.velocity, errors.position,
                                    errors.drift)))


def command_block(estimates):
    """Return the values of GUIDANCE_COMMAND (n, 3) of SteeringEstimates."""
    return np.stack([estimates.command, estimates.z, estimates.v_z], axis=1)


def aided_error_blocks(errors):
    """Return {Topic: values} of AidedErrors: errors, and SIGMAS standard deviations."""
    three = (errors.attitude_sigma, errors.velocity_sigma, errors.position_sigma)
    return dict(zip((*topics.AIDED_ERRORS, *topics.AIDED_SIGMAS), (
        errors.attitude, errors.velocity, errors.position, *(SIGMAS * s for s in three))))


def ins_odometry_one(frame, solution, omega, known):
    """
    Return the runs of ins/odometry.

    solution is lat, lon, height, v_n, q_nb; omega the gyro reading; known a PublishedCovariance.
    """
    pose, twist = odometry_one(frame, solution, omega)
    return (pose, known.pose, twist,
            _blocks(turned_back(dcm_of(solution[4]), known.velocity), known.rate))


def orientation_one(pose, known):
    """Return orientation and covariance of imu/data, from the pose of ins/odometry."""
    c = known.pose
    return pose[3:], (*c[21:24], *c[27:30], *c[33:36])


def odometry_one(frame, solution, omega):
    """Return pose and twist of an odometry, from a solution and a gyro reading."""
    r_m, q_mb, v_b = frame.pose_one(*solution)
    turn = quaternion.rotate_back(q_mb, frame.omega_ie_m)
    return (*r_m, *q_mb), (*v_b, omega[0] - turn[0], omega[1] - turn[1], omega[2] - turn[2])


def fix_one(solution):
    """Return the run of a NavSatFix: latitude, longitude (deg, within +-180) and height, m."""
    lon_deg = math.degrees(solution[1])
    if abs(lon_deg) > 180.0:
        lon_deg = float(within_half_turn_deg(lon_deg))
    return math.degrees(solution[0]), lon_deg, solution[2]


def aided_odometry_one(frame, solution, omega, sigmas, rate_variance):
    """
    Return the runs of aided/odometry, pose and twist each followed by its covariance.

    sigmas are the standard deviations of position (m), velocity (m/s) and attitude (rad) in East,
    North, Up, or None for unknown.  The covariances are rotated to the axes of map and base_link;
    correlations are neglected.  rate_variance is that of the angular velocity, (rad/s)^2.
    """
    pose, twist = odometry_one(frame, solution, omega)
    rates = _diagonal(rate_variance)
    if sigmas is None:
        return pose, _blocks(_UNKNOWN, _UNKNOWN), twist, _blocks(_UNKNOWN, rates)
    q_nb = solution[4]
    q_mn = quaternion.multiply(pose[3:], quaternion.conjugate(q_nb))
    position, velocity, turned = sigmas
    return (pose, _blocks(_turned(q_mn, position), _turned(q_mn, turned)), twist,
            _blocks(_turned(quaternion.conjugate(q_nb), velocity), rates))


def _diagonal(variance):
    """Return a 3 x 3 covariance row by row, with the same variance along each axis."""
    return (variance, 0.0, 0.0, 0.0, variance, 0.0, 0.0, 0.0, variance)


_UNKNOWN = _diagonal(topics.UNMEASURED)


def _turned(q, sigmas):
    """Return C diag(sigmas^2) C^T for the quaternion q of C, row by row."""
    axes = [quaternion.rotate(q, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0),
                                                    (0.0, 0.0, 1.0))]
    return [sum(s * s * axis[i] * axis[k] for s, axis in zip(sigmas, axes))
            for i in range(3) for k in range(3)]


def _blocks(upper, lower):
    """Return the 6 x 6 covariance with two 3 x 3 blocks on its diagonal."""
    a, b, c, d, e, f, g, h, i = upper
    j, k, m, n, o, p, q, r, s = lower
    return (a, b, c, 0.0, 0.0, 0.0, d, e, f, 0.0, 0.0, 0.0, g, h, i, 0.0, 0.0, 0.0,
            0.0, 0.0, 0.0, j, k, m, 0.0, 0.0, 0.0, n, o, p, 0.0, 0.0, 0.0, q, r, s)


def aided_fix_one(solution, sigmas):
    """Return the runs of aided/fix: position and variances (East, North, Up; 0 = unknown)."""
    variances = ((s * s,) for s in (sigmas[0] if sigmas else (0.0,) * 3))
    return fix_one(solution), *variances


def _rate_in_map(frame, q_mb, omega):
    turn = quaternion.rotate_back(np.moveaxis(q_mb, -1, 0), frame.omega_ie_m)
    return omega - np.stack(turn, axis=-1)


def _fix(record):
    return np.stack([np.degrees(record.lat), within_half_turn_deg(np.degrees(record.lon)),
                     record.height], axis=-1)
