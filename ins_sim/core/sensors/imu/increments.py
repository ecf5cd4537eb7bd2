"""
The increments of one sampling interval, and loops over the intervals of a block.

Functions take floats; with arrays for components they take the intervals of a block at once.  A
function ``..._rows`` is the loop over flat rows, to be compiled, and ``..._arrays`` does the same
with arrays; the bits are equal.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion

# Gauss-Legendre, three points on [0, 1]
NODES = (0.5 - math.sqrt(0.15), 0.5, 0.5 + math.sqrt(0.15))
WEIGHTS = (5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0)


def rotation_increment(q_start, q_end, dq_earth):
    """
    Return the rotation vector from the inertial attitude at the start to that at the end, rad.

    q_start, q_end: q_mb; dq_earth: rotation of m in i over the interval.
    """
    return quaternion.logarithm(quaternion.multiply(quaternion.conjugate(q_start),
                                                    quaternion.multiply(dq_earth, q_end)))


def mean_force(forces_m, node_rotations):
    """
    Return the mean over the interval of the specific force in the inertial axes m of its start.

    forces_m: specific force in m at the three Gauss nodes, m/s^2; node_rotations: rotations of m
    in i from the start to the nodes.
    """
    (w1, w2, w3), (f1, f2, f3), (r1, r2, r3) = WEIGHTS, forces_m, node_rotations
    a, b, c = quaternion.rotate(r1, f1), quaternion.rotate(r2, f2), quaternion.rotate(r3, f3)
    return (w1 * a[0] + w2 * b[0] + w3 * c[0], w1 * a[1] + w2 * b[1] + w3 * c[1],
            w1 * a[2] + w2 * b[2] + w3 * c[2])


def velocity_increment(q_start, forces_m, node_rotations):
    """Return Q_ib(start)^-1 times the mean of Q_ib f_b over the interval, m/s^2."""
    return quaternion.rotate_back(q_start, mean_force(forces_m, node_rotations))


def rotation_rows(before, q_mb, dq_earth, out):
    """Write the rotation increments to attitudes q_mb, the first from ``before``, into out."""
    for k in range(len(q_mb) // 4):
        i, j = 4 * k, 3 * k
        q = q_mb[i], q_mb[i + 1], q_mb[i + 2], q_mb[i + 3]
        out[j], out[j + 1], out[j + 2] = rotation_increment(before, q, dq_earth)
        before = q


def rotation_arrays(before, q_mb, dq_earth, out):
    """Do what ``rotation_rows`` does with q_mb (n, 4) and out (n, 3)."""
    starts = _starts(before, q_mb)
    out[:] = np.stack(rotation_increment(starts, np.ascontiguousarray(q_mb.T), dq_earth), axis=-1)


def force_rows(before, q_mb, mean, out):
    """Write means of specific force in m into out, in the body axes at the starts."""
    for k in range(len(q_mb) // 4):
        i, j = 4 * k, 3 * k
        f = mean[j], mean[j + 1], mean[j + 2]
        out[j], out[j + 1], out[j + 2] = quaternion.rotate_back(before, f)
        before = q_mb[i], q_mb[i + 1], q_mb[i + 2], q_mb[i + 3]


def force_arrays(before, q_mb, mean, out):
    """Do what ``force_rows`` does with q_mb (n, 4), mean and out (n, 3)."""
    out[:] = np.stack(quaternion.rotate_back(_starts(before, q_mb), mean.T), axis=-1)


def turned_rows(q_mn, q_nb, out):
    """Write q_mn times the attitudes q_nb into out; q_mn: of a place where all of them are."""
    for k in range(len(q_nb) // 4):
        i = 4 * k
        q = q_nb[i], q_nb[i + 1], q_nb[i + 2], q_nb[i + 3]
        out[i], out[i + 1], out[i + 2], out[i + 3] = quaternion.multiply(q_mn, q)


def turned_arrays(q_mn, q_nb, out):
    """Do what ``turned_rows`` does with q_nb and out (n, 4); q_mn may be four arrays too."""
    out[:] = np.stack(quaternion.multiply(q_mn, np.ascontiguousarray(q_nb.T)), axis=-1)


def _starts(before, q_mb):
    """Return the attitudes, four arrays, from which the intervals begin that end at q_mb."""
    return np.concatenate([[before], q_mb[:-1]]).T.copy()
