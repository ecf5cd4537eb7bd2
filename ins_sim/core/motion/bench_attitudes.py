"""
The attitudes of the bench motions: pure functions ``(constants, t) -> q_nb``.

t is a float, an array, or a Taylor series, s; the bits are the same, so that the truth, which
needs derivatives, and compiled loops share one source. A function ``..._rows`` is the loop over
the instants t: it writes rows of four into the flat sequence out.

Constants are tuples of floats: ``base`` is an attitude, ``axis`` a unit vector, w an angular
frequency in rad/s; angles and phases are in rad.
"""

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import from_angles
from ins_sim.core.numerics import taylor


def about(axis, angle):
    """Return the rotation by an angle about a unit vector."""
    s, c = taylor.sincos(angle * 0.5)
    return s * axis[0], s * axis[1], s * axis[2], c


def wave(amplitude, w, phase, t):
    """Return amplitude sin(w t + phase)."""
    return taylor.sincos(t * w + phase)[0] * amplitude


def static(constants, t):
    """Return the base at all times; constants: base."""
    x, y, z, w = constants
    none = t * 0.0
    return none + x, none + y, none + z, none + w


def rocking_left(constants, t):
    """Rock about a fixed axis of the local level frame; constants: base, axis, amplitude, w."""
    base, axis, amplitude, w = constants
    return quaternion.multiply(about(axis, wave(amplitude, w, 0.0, t)), base)


def rocking_right(constants, t):
    """Rock about an axis of the body; constants: base, axis, amplitude, w."""
    base, axis, amplitude, w = constants
    return quaternion.multiply(base, about(axis, wave(amplitude, w, 0.0, t)))


def two_axis(constants, t):
    """Turn in psi and gamma; constants: rate and start of psi, theta, rate and start of gamma."""
    psi_rate, psi, theta, gamma_rate, gamma = constants
    return from_angles(t * psi_rate + psi, theta, t * gamma_rate + gamma)


def coning(constants, t):
    """
    Let an axis of the body describe a cone.

    The rotation vector is A (u cos w t + v sin w t); constants: base, u, v, sine and cosine of
    A / 2, w.
    """
    base, u, v, sine, cosine, w = constants
    s, c = taylor.sincos(t * w)
    s, c = s * sine, c * sine
    cone = (c * u[0] + s * v[0], c * u[1] + s * v[1], c * u[2] + s * v[2], s * 0.0 + cosine)
    return quaternion.multiply(base, cone)


def sinusoids(constants, t):
    """Let the angles swing; constants: of each angle mean, amplitude, w, phase."""
    (a, b, c, d), (e, f, g, h), (i, j, k, m) = constants
    return from_angles(wave(b, c, d, t) + a, wave(f, g, h, t) + e, wave(j, k, m, t) + i)


def harmonics(constants, t):
    """Sum harmonics; constants: w of the first, of each angle mean, amplitudes, phases."""
    w, psi, theta, gamma = constants
    return from_angles(series(psi, w, t), series(theta, w, t), series(gamma, w, t))


def series(angle, w, t):
    """Return the mean and the harmonics of one angle."""
    mean, amplitudes, phases = angle
    total = t * 0.0 + mean
    for k in range(len(amplitudes)):
        total = total + wave(amplitudes[k], w * (k + 1), phases[k], t)
    return total


def static_rows(constants, t, out):
    """Write the attitudes of ``static``."""
    for k in range(len(t)):
        i = 4 * k
        out[i], out[i + 1], out[i + 2], out[i + 3] = static(constants, t[k])


def rocking_left_rows(constants, t, out):
    """Write the attitudes of ``rocking_left``."""
    for k in range(len(t)):
        i = 4 * k
        out[i], out[i + 1], out[i + 2], out[i + 3] = rocking_left(constants, t[k])


def rocking_right_rows(constants, t, out):
    """Write the attitudes of ``rocking_right``."""
    for k in range(len(t)):
        i = 4 * k
        out[i], out[i + 1], out[i + 2], out[i + 3] = rocking_right(constants, t[k])


def two_axis_rows(constants, t, out):
    """Write the attitudes of ``two_axis``."""
    for k in range(len(t)):
        i = 4 * k
        out[i], out[i + 1], out[i + 2], out[i + 3] = two_axis(constants, t[k])


def coning_rows(constants, t, out):
    """Write the attitudes of ``coning``."""
    for k in range(len(t)):
        i = 4 * k
        out[i], out[i + 1], out[i + 2], out[i + 3] = coning(constants, t[k])


def sinusoids_rows(constants, t, out):
    """Write the attitudes of ``sinusoids``."""
    for k in range(len(t)):
        i = 4 * k
        out[i], out[i + 1], out[i + 2], out[i + 3] = sinusoids(constants, t[k])


def harmonics_rows(constants, t, out):
    """Write the attitudes of ``harmonics``."""
    for k in range(len(t)):
        i = 4 * k
        out[i], out[i + 1], out[i + 2], out[i + 3] = harmonics(constants, t[k])


ROWS = {static: static_rows, rocking_left: rocking_left_rows, rocking_right: rocking_right_rows,
        two_axis: two_axis_rows, coning: coning_rows, sinusoids: sinusoids_rows,
        harmonics: harmonics_rows}
