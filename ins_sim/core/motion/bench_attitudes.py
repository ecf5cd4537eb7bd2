"""
Attitudes of the bench motions: pure functions ``(constants, t) -> q_nb``.

t is the time in s: a float, an array, or a Taylor series. All three give the same bits, so that
the truth, which needs derivatives, and the compiled loops can share these functions. ROWS holds,
for each function, a loop over instants t that writes the four components of each quaternion into
the flat sequence out.

Constants are tuples of floats: ``base`` is an attitude, ``axis`` a unit vector, w an angular
frequency in rad/s; angles and phases are in rad.
"""

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import from_angles
from ins_sim.core.numerics import taylor
from ins_sim.core.numerics.compilation import with_globals


def about(axis, angle):
    """Return the rotation by an angle about a unit vector."""
    s, c = taylor.sincos(angle * 0.5)
    return s * axis[0], s * axis[1], s * axis[2], c


def wave(amplitude, w, phase, t):
    """Return amplitude sin(w t + phase)."""
    return taylor.sincos(t * w + phase)[0] * amplitude


def static(constants, t):
    """Return the same attitude at all times; constants: base."""
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
    Let a body axis describe a cone.

    The rotation vector is A (u cos w t + v sin w t), with unit vectors u and v at right angles to
    that axis and to each other; constants: base, u, v, sine and cosine of A / 2, w.
    """
    base, u, v, sine, cosine, w = constants
    s, c = taylor.sincos(t * w)
    s, c = s * sine, c * sine
    cone = (c * u[0] + s * v[0], c * u[1] + s * v[1], c * u[2] + s * v[2], s * 0.0 + cosine)
    return quaternion.multiply(base, cone)


def sinusoids(constants, t):
    """Oscillate each angle as a sinusoid; constants: for each angle mean, amplitude, w, phase."""
    (a, b, c, d), (e, f, g, h), (i, j, k, m) = constants
    return from_angles(wave(b, c, d, t) + a, wave(f, g, h, t) + e, wave(j, k, m, t) + i)


def harmonics(constants, t):
    """Sum harmonics; constants: fundamental w; for each angle mean, amplitudes, phases."""
    w, psi, theta, gamma = constants
    return from_angles(series(psi, w, t), series(theta, w, t), series(gamma, w, t))


def series(angle, w, t):
    """Return the sum of the mean and the harmonics of one angle."""
    mean, amplitudes, phases = angle
    total = t * 0.0 + mean
    for k in range(len(amplitudes)):
        total = total + wave(amplitudes[k], w * (k + 1), phases[k], t)
    return total


def static_rows(constants, t, out):
    """Write the attitudes of ``static``; ROWS holds this loop for every function."""
    for k in range(len(t)):
        i = 4 * k
        out[i], out[i + 1], out[i + 2], out[i + 3] = static(constants, t[k])


ROWS = {static: static_rows, **{
    attitude: with_globals(static_rows, f'{attitude.__name__}_rows', static=attitude)
    for attitude in (rocking_left, rocking_right, two_axis, coning, sinusoids, harmonics)}}
