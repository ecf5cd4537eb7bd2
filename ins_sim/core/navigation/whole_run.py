"""
Strapdown loops over the samples of a block.

Each loop is a plain function of columns and calls the same functions as the live navigator.
``numerics.compilation.run`` executes it in plain Python or compiled, with identical bits.
"""

import numpy as np

from ins_sim.core.attitude import integration
from . import mechanization
from .errors import drift, inertial_errors
from .increments import fixed_rate_increments, integrals
from .strapdown import level_attitude

# Number of columns of a solution: lat, lon, height, v_n, q_ib.
SOLVED = 10
# Number of columns derived from it: q_nb; attitude, velocity and position errors.
JUDGED = 13


def solve(carry, spin, start_ns, channel, damping, gravity, integrated, t_ns, omega, f, height,
          v_u, out):
    """
    Advance the strapdown over samples; return the new carry.

    Parameters
    ----------
    carry : orientation, PLACE, integrals of the last sample, and its instant (ns)
    spin : rotation rate of the Earth, rad/s
    start_ns : start of the run, at which the axes e and i coincide, ns
    channel, damping, gravity : see ``strapdown.Strapdown``
    integrated : whether the readings are plain integrals
    t_ns : (n,) instants
    omega, f : (3 n,) readings, the three axes of each sample side by side, rad/s and m/s^2
    height, v_u : (n,) true height (m) and vertical velocity (m/s)
    out : (SOLVED n,) solutions, written sample by sample

    """
    orientation, place, last, last_ns = carry
    q = integration.quaternion_of_state(orientation)
    c1, c2, c3 = damping
    for k in range(len(t_ns)):
        now_ns, i, j = t_ns[k], 3 * k, SOLVED * k
        dt = (now_ns - last_ns) * 1e-9
        now = integrals((omega[i], omega[i + 1], omega[i + 2]), (f[i], f[i + 1], f[i + 2]), dt)
        phi, delta_v = fixed_rate_increments(integrated, now, last)
        place = mechanization.advance(place, q, delta_v, dt, spin,
                                      spin * ((last_ns - start_ns) * 1e-9), channel,
                                      (height[k], v_u[k], c1, c2, c3), gravity)
        orientation = integration.turned(orientation, phi, dt)
        last, last_ns = now, now_ns
        q = integration.quaternion_of_state(orientation)
        out[j], out[j + 1], out[j + 2] = place[0], place[1], place[2]
        out[j + 3], out[j + 4], out[j + 5] = place[3], place[4], place[5]
        out[j + 6], out[j + 7], out[j + 8], out[j + 9] = q
    return orientation, place, last, last_ns


def judge_one(spin, t_s, solved, truth):
    """
    Return q_nb and the attitude, velocity and position errors, of one sample or of arrays.

    Parameters
    ----------
    spin : rotation rate of the Earth, rad/s
    t_s : time since the start, s
    solved : (lat, lon, height, v_n, q_ib) of the solution, in rad, rad, m, m/s
    truth : (lat, lon, height, v_n, q_nb), in the same units

    Returns
    -------
    q_nb : attitude of the solution
    delta, velocity, position : see ``errors.inertial_errors``; rad, m/s and m

    """
    lat, lon, height, v, q_ib = solved
    earth_angle = spin * t_s
    delta, velocity, position = inertial_errors((q_ib, lat, lon, height, v), truth, earth_angle)
    return level_attitude(lat, lon, q_ib, earth_angle), delta, velocity, position


def judge(spin, t_s, solved, lat, lon, height, v, q, out):
    """Write the result of ``judge_one`` for each sample, JUDGED columns, to out."""
    for k in range(len(t_s)):
        i, j, m, n = 3 * k, SOLVED * k, 4 * k, JUDGED * k
        q_nb, delta, velocity, position = judge_one(
            spin, t_s[k],
            (solved[j], solved[j + 1], solved[j + 2], (solved[j + 3], solved[j + 4],
                                                       solved[j + 5]),
             (solved[j + 6], solved[j + 7], solved[j + 8], solved[j + 9])),
            (lat[k], lon[k], height[k], (v[i], v[i + 1], v[i + 2]),
             (q[m], q[m + 1], q[m + 2], q[m + 3])))
        out[n], out[n + 1], out[n + 2], out[n + 3] = q_nb
        out[n + 4], out[n + 5], out[n + 6] = delta
        out[n + 7], out[n + 8], out[n + 9] = velocity
        out[n + 10], out[n + 11], out[n + 12] = position


def drifts(carry, spin, t_s, lat, lon, judged, out):
    """Write the drift after each sample, three columns; return the carry of ``errors.drift``."""
    for k in range(len(t_s)):
        i, n = 3 * k, JUDGED * k
        carry, slope = drift(carry, t_s[k], lat[k], lon[k] + spin * t_s[k],
                             (judged[n + 4], judged[n + 5], judged[n + 6]))
        out[i], out[i + 1], out[i + 2] = slope
    return carry


def judge_arrays(spin, t_s, solved, lat, lon, height, v, q, out):
    """Write the same as ``judge`` to out, by operations on whole columns."""
    found = judge_one(spin, t_s, (*solved[:, 0:3].T, solved[:, 3:6].T, solved[:, 6:10].T),
                      (lat, lon, height, v.T, q.T))
    out[:] = np.stack([x for vector in found for x in vector], axis=1)
