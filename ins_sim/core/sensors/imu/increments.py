"""
The increments of one sampling interval, and loops over the intervals of a block.

The functions take floats, or arrays as components to process many intervals together. A function
``..._rows`` loops over flat rows and is meant to be compiled; its counterpart ``..._arrays`` does
the same with NumPy and gives the same bits. Axes m are those of the map frame, b those of the
body, i those of inertial space.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion

# Gauss-Legendre quadrature with three points on [0, 1].
NODES = (0.5 - math.sqrt(0.15), 0.5, 0.5 + math.sqrt(0.15))
WEIGHTS = (5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0)


def rotation_increment(q_start, q_end, dq_earth):
    """
    Return the rotation vector from the inertial attitude at the start to that at the end, rad.

    Parameters
    ----------
    q_start, q_end : q_mb at the start and end of the interval
    dq_earth : rotation of m relative to i over the interval
    """
    return quaternion.logarithm(quaternion.multiply(quaternion.conjugate(q_start),
                                                    quaternion.multiply(dq_earth, q_end)))


def mean_force(forces_m, node_rotations):
    """
    Return the mean specific force over the interval, in the inertial axes that m has at its start.

    Parameters
    ----------
    forces_m : specific force in m at the three Gauss nodes, m/s^2
    node_rotations : rotations of m relative to i from the start to each node
    """
    (w1, w2, w3), (f1, f2, f3), (r1, r2, r3) = WEIGHTS, forces_m, node_rotations
    a, b, c = quaternion.rotate(r1, f1), quaternion.rotate(r2, f2), quaternion.rotate(r3, f3)
    return (w1 * a[0] + w2 * b[0] + w3 * c[0], w1 * a[1] + w2 * b[1] + w3 * c[1],
            w1 * a[2] + w2 * b[2] + w3 * c[2])


def velocity_increment(q_start, forces_m, node_rotations):
    """
    Return the mean specific force over the interval in the body axes at its start, m/s^2.

    This is Q_ib(start)^-1 times the mean of Q_ib f_b; for the arguments see ``mean_force``.
    """
    return quaternion.rotate_back(q_start, mean_force(forces_m, node_rotations))


def rotation_rows(before, q_mb, dq_earth, out):
    """
    Write the rotation increments between consecutive attitudes into out, rad.

    Parameters
    ----------
    before : q_mb at the start of the first interval
    q_mb : flat (4 n,) q_mb at the ends of the intervals
    dq_earth : rotation of m relative to i over one interval
    out : flat (3 n,)
    """
    for k in range(len(q_mb) // 4):
        i, j = 4 * k, 3 * k
        q = q_mb[i], q_mb[i + 1], q_mb[i + 2], q_mb[i + 3]
        out[j], out[j + 1], out[j + 2] = rotation_increment(before, q, dq_earth)
        before = q


def rotation_arrays(before, q_mb, dq_earth, out):
    """Do the same as ``rotation_rows`` with q_mb (n, 4) and out (n, 3)."""
    starts = _starts(before, q_mb)
    out[:] = np.stack(rotation_increment(starts, np.ascontiguousarray(q_mb.T), dq_earth), axis=-1)


def force_rows(before, q_mb, mean, out):
    """
    Write mean specific forces, resolved in the body axes at the interval starts, into out.

    Parameters
    ----------
    before, q_mb : as in ``rotation_rows``
    mean : flat (3 n,) mean specific forces in m, m/s^2
    out : flat (3 n,)
    """
    for k in range(len(q_mb) // 4):
        i, j = 4 * k, 3 * k
        f = mean[j], mean[j + 1], mean[j + 2]
        out[j], out[j + 1], out[j + 2] = quaternion.rotate_back(before, f)
        before = q_mb[i], q_mb[i + 1], q_mb[i + 2], q_mb[i + 3]


def force_arrays(before, q_mb, mean, out):
    """Do the same as ``force_rows`` with q_mb (n, 4), mean and out (n, 3)."""
    out[:] = np.stack(quaternion.rotate_back(_starts(before, q_mb), mean.T), axis=-1)


def turned_rows(q_mn, q_nb, out):
    """Write the products of q_mn, constant, and q_nb (flat, 4 n) into out (flat, 4 n)."""
    for k in range(len(q_nb) // 4):
        i = 4 * k
        q = q_nb[i], q_nb[i + 1], q_nb[i + 2], q_nb[i + 3]
        out[i], out[i + 1], out[i + 2], out[i + 3] = quaternion.multiply(q_mn, q)


def turned_arrays(q_mn, q_nb, out):
    """Do the same as ``turned_rows`` with arrays (n, 4); q_mn may be four arrays as well."""
    out[:] = np.stack(quaternion.multiply(q_mn, np.ascontiguousarray(q_nb.T)), axis=-1)


def _starts(before, q_mb):
    """Return the attitudes, as four arrays, at the starts of the intervals that end at q_mb."""
    return np.concatenate([[before], q_mb[:-1]]).T.copy()
