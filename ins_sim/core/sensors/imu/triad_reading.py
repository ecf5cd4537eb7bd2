"""
What a triad makes of its input: the step of its errors, a pure function, and loops over it.

Terms that are off are None.  In the order of the signal: ``respond`` has the terms that act at
once, ``remember`` those that need the samples before: lags and pulses, and between them noise and
range.
"""

import math

import numpy as np

ZERO = (0.0, 0.0, 0.0)
# What the lags carry where nothing is carried yet.
AT_REST = ((0.0, 0.0),) * 3
# Floats from here on are whole numbers.
WHOLE = 4503599627370496.0


def read(geometry, response, by_force, by_temperature, lags, noise, most, quantum, dt, per_dt,
         following, lagged, carried, value, force, warm):
    """
    Return the reading of one sample, and what the lags and the pulses carry on.

    Parameters
    ----------
    geometry, response, by_force, by_temperature, warm : as of ``respond``
    lags, noise, most, quantum, dt, per_dt, following, lagged, carried : as of ``remember``
    value : mean input over the sampling interval by body axis, rad/s or m/s^2
    force : specific force by body axis, m/s^2
    """
    driven = respond(geometry, response, by_force, by_temperature, value, force, warm)
    return remember(lags, noise, most, quantum, dt, per_dt, following, lagged, carried, driven)


def respond(geometry, response, by_force, by_temperature, value, force, warm):
    """
    Return the input with the errors that follow at once; components are floats or arrays.

    Parameters
    ----------
    geometry : nine elements that take body axes to the sensitive ones
    response : by axis, errors of scale factor: linear, of the absolute value, quadratic, cubic
    by_force : by axis, coefficients of specific force and of its square
    by_temperature : by axis, bias and scale factor per kelvin
    value, force : as of ``read``
    warm : temperature less that of the calibration, K
    """
    x, y, z = value
    if geometry is not None:
        a, b, c, d, e, f, g, h, i = geometry
        x, y, z = a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z
    x0, y0, z0 = x, y, z
    if response is not None:
        (sx, sy, sz), (ax, ay, az), (bx, by, bz), (cx, cy, cz) = response
        x = x + (x0 * (sx + x0 * (bx + x0 * cx)) + abs(x0) * ax)
        y = y + (y0 * (sy + y0 * (by + y0 * cy)) + abs(y0) * ay)
        z = z + (z0 * (sz + z0 * (bz + z0 * cz)) + abs(z0) * az)
    if by_force is not None:
        (lx, ly, lz), (qx, qy, qz) = by_force
        fx, fy, fz = force
        x = x + fx * (lx + fx * qx)
        y = y + fy * (ly + fy * qy)
        z = z + fz * (lz + fz * qz)
    if by_temperature is not None:
        (bx, by, bz), (sx, sy, sz) = by_temperature
        x = x + warm * (bx + x0 * sx)
        y = y + warm * (by + y0 * sy)
        z = z + warm * (bz + z0 * sz)
    return x, y, z


def remember(lags, noise, most, quantum, dt, per_dt, following, lagged, carried, driven):
    """
    Return the reading of an input, and what the lags and the pulses carry on; floats.

    Parameters
    ----------
    lags : by axis, the six numbers of ``pass_lag``
    noise : additive errors of this sample by axis
    most : by axis, the greatest value that is read
    quantum : by axis, the weight of a pulse times s; 0 = none
    dt, per_dt : sampling period, s, and its reciprocal
    following : whether this sample follows the last one; if not, lags are settled and no
        remainder of pulses is left
    lagged : by axis, the output of the lag and its rate at the end of the sample before
    carried : by axis, what remained of the pulses of the sample before
    driven : the input of the lags by axis
    """
    x, y, z = driven
    if lags is not None:
        mx, my, mz = lags
        lx, ly, lz = lagged if following else ((x, 0.0), (y, 0.0), (z, 0.0))
        x, lx = pass_lag(mx, lx, x)
        y, ly = pass_lag(my, ly, y)
        z, lz = pass_lag(mz, lz, z)
        lagged = lx, ly, lz
    if noise is not None:
        nx, ny, nz = noise
        x, y, z = x + nx, y + ny, z + nz
    if most is not None:
        rx, ry, rz = most
        x = rx if x > rx else -rx if x < -rx else x
        y = ry if y > ry else -ry if y < -ry else y
        z = rz if z > rz else -rz if z < -rz else z
    if quantum is not None:
        qx, qy, qz = quantum
        rx, ry, rz = carried if following else ZERO
        if qx:
            x, rx = count_pulses(x * dt + rx, qx, per_dt)
        if qy:
            y, ry = count_pulses(y * dt + ry, qy, per_dt)
        if qz:
            z, rz = count_pulses(z * dt + rz, qz, per_dt)
        carried = rx, ry, rz
    return (x, y, z), lagged, carried


def read_rows(geometry, response, by_force, by_temperature, lags, noise, most, quantum, dt,
              per_dt, following, lagged, carried, values, forces, warm, out):
    """
    Write the readings of consecutive samples into out; return what is carried behind the last.

    noise, values, forces, out: rows of three, one behind the other; warm: one a sample, or None.
    The rest is as of ``read``, which this repeats.
    """
    for i in range(0, len(values), 3):
        reading, lagged, carried = read(
            geometry, response, by_force, by_temperature, lags, three_of(noise, i), most, quantum,
            dt, per_dt, following, lagged, carried, three_of(values, i), three_of(forces, i),
            one_of(warm, i // 3))
        out[i], out[i + 1], out[i + 2] = reading
        following = True
    return lagged, carried


def read_arrays(geometry, response, by_force, by_temperature, lags, noise, most, quantum, dt,
                per_dt, following, lagged, carried, values, forces, warm, out):
    """Do what ``read_rows`` does with arrays (n, 3), sample by sample only what needs it."""
    out[:] = np.stack(respond(geometry, response, by_force, by_temperature, values.T, forces.T,
                              warm), axis=-1)
    if lags is None and quantum is None:
        if noise is not None:
            out += noise
        if most is not None:
            out[:] = np.minimum(np.maximum(out, np.negative(most)), most)
        return lagged, carried
    noises = [None] * len(out) if noise is None else noise.tolist()
    readings = []
    for driven, added in zip(out.tolist(), noises):
        reading, lagged, carried = remember(lags, added, most, quantum, dt, per_dt, following,
                                            lagged, carried, driven)
        readings.append(reading)
        following = True
    out[:] = readings
    return lagged, carried


def three_of(row, i):
    """Return three entries of a flat sequence from index i; None if row is None."""
    if row is None:
        return None
    return row[i], row[i + 1], row[i + 2]


def one_of(row, i):
    """Return entry i of a sequence; None if row is None."""
    if row is None:
        return None
    return row[i]


def pass_lag(lag, start, u):
    """
    Return the mean output over an interval of input u, and (output, its rate) at the end.

    lag: of ``discrete_lag``; start: output and its rate at the start of the interval.
    """
    a, b, c, d, m, n = lag
    x, v = start
    e = x - u
    return u + (m * e + n * v), (u + (a * e + b * v), c * e + d * v)


def count_pulses(increment, quantum, per_dt):
    """Return the reading of the whole pulses in an increment, and what remains."""
    pulses = increment / quantum + 0.5
    if abs(pulses) < WHOLE:
        pulses = math.floor(pulses) * 1.0
    pulses = pulses * quantum
    return pulses * per_dt, increment - pulses
