"""Rotation matrices: conversion from and to quaternions, and the cross-product matrix."""

import math

import numpy as np


def dcm_of(q):
    """Return C_nb as nine floats, row by row, given a unit quaternion q_nb."""
    x, y, z, w = q
    return (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
            2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
            2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))


def quaternion_of(c):
    """Return the unit quaternion, given C_nb as nine floats, row by row (Shepperd 1978)."""
    trace = c[0] + c[4] + c[8]
    x2, y2, z2 = 1.0 + 2.0 * c[0] - trace, 1.0 + 2.0 * c[4] - trace, 1.0 + 2.0 * c[8] - trace
    w2 = 1.0 + trace
    if x2 >= y2 and x2 >= z2 and x2 >= w2:
        q = (x2, c[1] + c[3], c[2] + c[6], c[7] - c[5])
    elif y2 >= z2 and y2 >= w2:
        q = (c[1] + c[3], y2, c[5] + c[7], c[2] - c[6])
    elif z2 >= w2:
        q = (c[2] + c[6], c[5] + c[7], z2, c[3] - c[1])
    else:
        q = (c[7] - c[5], c[2] - c[6], c[3] - c[1], w2)
    norm = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm


def turned_back(c, m):
    """
    Return C' M C, nine numbers, for C and a symmetric M, both nine numbers row by row.

    With C = C_nb it converts a covariance M in n to b. The numbers may be floats or arrays.
    """
    a, b, d, e, f, g, h, i, j = c
    xx, xy, xz, _, yy, yz, _, _, zz = m
    # Columns of M C.
    ux, vx, wx = (xx * a + xy * e) + xz * h, (xy * a + yy * e) + yz * h, (xz * a + yz * e) + zz * h
    uy, vy, wy = (xx * b + xy * f) + xz * i, (xy * b + yy * f) + yz * i, (xz * b + yz * f) + zz * i
    uz, vz, wz = (xx * d + xy * g) + xz * j, (xy * d + yy * g) + yz * j, (xz * d + yz * g) + zz * j
    pq, pr, qr = (a * uy + e * vy) + h * wy, (a * uz + e * vz) + h * wz, (b * uz + f * vz) + i * wz
    return ((a * ux + e * vx) + h * wx, pq, pr, pq, (b * uy + f * vy) + i * wy, qr, pr, qr,
            (d * uz + g * vz) + j * wz)


def skew(v):
    """Return the matrix (3, 3) of the cross product v x."""
    x, y, z = v
    return np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))


def attitude_matrix(q_nb):
    """Return C_nb (3, 3), given q_nb."""
    return np.array(dcm_of(q_nb)).reshape(3, 3)
