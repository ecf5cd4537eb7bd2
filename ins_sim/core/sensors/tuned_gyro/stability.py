"""Stability of the numerical integration of a tuned gyro, and its gain to pick-off noise."""

import numpy as np

from ins_sim.core.numerics.fixed_order import magnitude, product

# Number of grid points of the searches, which bisection then refines to machine precision.
GRID = 4000


def bisect_condition(holds, inside, outside):
    """Return the boundary, between two floats, of the region in which a condition holds."""
    for _ in range(100):
        middle = 0.5 * (inside + outside)
        if middle in (inside, outside):
            break
        if holds(middle):
            inside = middle
        else:
            outside = middle
    return inside


def rk4_amplification(z):
    """Return the amplification factor of one RK4 step; z = root times step, floats or arrays."""
    return 1.0 + z * (1.0 + z * (0.5 + z * (1.0 / 6.0 + z / 24.0)))


def rk4_window(roots):
    """
    Return the shortest and longest step, s, for which RK4 is stable; None if no step is.

    The lower limit is 0 for a stable instrument. A slightly unstable one is damped by RK4 itself,
    by 1 - (w h)^6 / 144 per step, if the step h is long enough.

    Parameters
    ----------
    roots : characteristic roots, 1/s
    """
    roots = np.array(roots)
    fastest = magnitude(roots).max()

    def decays(h):
        return (magnitude(rk4_amplification(np.multiply.outer(h, roots))) < 1.0).all(axis=-1)

    # In the left half plane RK4 is unstable everywhere beyond |z| = 3.
    steps = np.linspace(0.0, 3.0, GRID + 1)[1:] / fastest
    inside = decays(steps)
    if not inside.any():
        return None
    first = int(inside.argmax())
    last = first + int(np.append(inside[first:], False).argmin())
    if first:
        low = bisect_condition(decays, steps[first], steps[first - 1])
    else:
        low = 0.0 if (roots.real < 0.0).all() else bisect_condition(decays, steps[0], 0.0)
    return float(low), float(bisect_condition(decays, steps[last - 1], steps[last]))


def pickoff_gain(rotor, dt_s):
    """
    Return the ratio of the variances of mean readings and pick-off noise, (rad/s)^2/rad^2.

    The noise is constant within an interval and independent between intervals. The result is the
    stationary solution of the discrete Lyapunov equation for the state and the last noise, found
    by Smith's doubling, which is insensitive to the scaling of the states.

    Parameters
    ----------
    rotor : TunedGyro
    dt_s : interval of the noise, s; a multiple of the step of the rotor
    """
    table, added = rotor.matrices
    n = len(added) - 1
    # Columns: state at the start of the interval, noise in it, jump of the noise at its start.
    x, read = np.eye(n, n + 2, dtype=complex), np.zeros(n + 2, dtype=complex)
    steps = round(dt_s / rotor.dt_s)
    for k in range(steps):
        push = np.zeros((n + 1, n + 2), dtype=complex)
        push[:, n] = added[:, 1]
        if k == 0:
            push[:, n + 1] = added[:, 2]
        push += product(table[:, :n], x)
        x = push[:n]
        read += push[n] / steps
    carry = np.zeros((n + 1, n + 1), dtype=complex)
    carry[:n, :n], carry[:n, n] = x[:, :n], -x[:, n + 1]
    drive = np.append(x[:, n] + x[:, n + 1], 1.0)[:, None]
    out = np.append(read[:n], -read[n + 1])[None]
    spread, power = product(drive, drive.conj().T), carry
    while power.any():
        spread = spread + product(product(power, spread), power.conj().T)
        power = product(power, power)
    last = read[n] + read[n + 1]
    return float(product(product(out, spread), out.conj().T)[0, 0].real
                 + last.real * last.real + last.imag * last.imag)
