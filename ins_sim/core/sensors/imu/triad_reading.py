"""
The errors of a triad as pure functions: one sample, and loops over many.

The parameters of errors that are switched off are None. ``respond`` applies the errors that depend
on the present input only. ``remember`` then applies those that need earlier samples: lags and
pulses, and between them noise and range.
"""

import math

import numpy as np

ZERO = (0.0, 0.0, 0.0)
# Argument ``lagged`` before the first sample; it is not used, because the lags then start settled.
AT_REST = ((0.0, 0.0),) * 3
# Floats of at least this size (2^52) have no fractional part.
WHOLE = 4503599627370496.0


def read(geometry, response, by_force, by_temperature, lags, noise, most, quantum, dt, per_dt,
         following, lagged, carried, value, force, warm):
    """
    Return the reading of one sample, and the new states of the lags and of the pulses.

    Parameters
    ----------
    geometry, response, by_force, by_temperature, warm : see ``respond``
    lags, noise, most, quantum, dt, per_dt, following, lagged, carried : see ``remember``
    value : mean input over the sampling interval by body axis, rad/s or m/s^2
    force : specific force by body axis, m/s^2
    """
    driven = respond(geometry, response, by_force, by_temperature, value, force, warm)
    return remember(lags, noise, most, quantum, dt, per_dt, following, lagged, carried, driven)


def respond(geometry, response, by_force, by_temperature, value, force, warm):
    """
    Return the input with the errors that depend on the present input only.

    Components are floats or arrays.

    Parameters
    ----------
    geometry : nine elements of the matrix from body axes to sensitive axes
    response : errors of the scale factor, each by axis: linear, of the absolute value, quadratic,
        cubic
    by_force : coefficients of specific force and of its square, each by axis
    by_temperature : bias and scale factor per kelvin, each by axis
    value, force : see ``read``
    warm : temperature minus that of the calibration, K
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
    Return the reading of one sample, and the new states of the lags and of the pulses; floats.

    Parameters
    ----------
    lags : by axis, the six numbers that ``pass_lag`` takes
    noise : additive errors of this sample by axis
    most : by axis, the largest value that can be read
    quantum : by axis, the weight of a pulse (rad or m/s); 0 for no quantisation
    dt, per_dt : sampling period, s, and its reciprocal
    following : whether this sample directly follows the last one; if not, the lags start settled
        at the present input, and the remainders of the pulses start at zero
    lagged : by axis, output of the lag and its rate at the end of the sample before
    carried : by axis, remainder of the pulses of the sample before
    driven : input of the lags by axis
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
    Write the readings of consecutive samples into out; return the states after the last one.

    Parameters
    ----------
    noise, values, forces, out : flat (3 n,)
    warm : (n,), or None

    The other parameters are those of ``read``, which is called for each sample.
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
    """Do the same as ``read_rows`` with arrays (n, 3); only lags and pulses need a loop."""
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
    Return the mean output of a lag over an interval with input u, and its state at the end.

    Parameters
    ----------
    lag : six numbers of ``discrete_lag``
    start : output and its rate at the start of the interval
    u : input, constant over the interval
    """
    a, b, c, d, m, n = lag
    x, v = start
    e = x - u
    return u + (m * e + n * v), (u + (a * e + b * v), c * e + d * v)


def count_pulses(increment, quantum, per_dt):
    """
    Round an increment to whole pulses; return their reading and the remainder.

    Parameters
    ----------
    increment : integral of the input plus the last remainder, rad or m/s
    quantum : weight of a pulse, rad or m/s
    per_dt : reciprocal of the sampling period, 1/s
    """
    pulses = increment / quantum + 0.5
    if abs(pulses) < WHOLE:
        pulses = math.floor(pulses) * 1.0
    pulses = pulses * quantum
    return pulses * per_dt, increment - pulses
