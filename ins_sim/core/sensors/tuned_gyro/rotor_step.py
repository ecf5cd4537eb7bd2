"""
The arithmetic of one step of a tuned gyro, on floats.

A complex number is stored as two floats, real part first, and products are written out, so that
plain Python and the compiled loop give the same bits. The arguments have the same meaning in all
functions:

x : state (theta, v) or, in closed loop, (theta, v, integral): four or six floats
u : rates u_y + j u_z of the case at start, middle and end of the step, rad/s: six floats
d : moment, tilt and jump of a disturbance (`TunedGyro.step_disturbed`): six floats
gains : rows of the matrix of the step, the row of the mean reading last (``step_matrices``)
added : rows of the matrix of the disturbances (``step_matrices``)
"""


def row_two(g, x, u):
    """Return the product of a row of five complex gains with (x, u), for two states."""
    ar, ai, br, bi, cr, ci, dr, di, er, ei = g
    x0, y0, x1, y1 = x
    u0, v0, u1, v1, u2, v2 = u
    return ((ar * x0 - ai * y0) + (br * x1 - bi * y1) + (cr * u0 - ci * v0)
            + (dr * u1 - di * v1) + (er * u2 - ei * v2),
            (ar * y0 + ai * x0) + (br * y1 + bi * x1) + (cr * v0 + ci * u0)
            + (dr * v1 + di * u1) + (er * v2 + ei * u2))


def row_three(g, x, u):
    """Return the product of a row of six complex gains with (x, u), for three states."""
    ar, ai, br, bi, cr, ci, dr, di, er, ei, fr, fi = g
    x0, y0, x1, y1, x2, y2 = x
    u0, v0, u1, v1, u2, v2 = u
    return ((ar * x0 - ai * y0) + (br * x1 - bi * y1) + (cr * x2 - ci * y2)
            + (dr * u0 - di * v0) + (er * u1 - ei * v1) + (fr * u2 - fi * v2),
            (ar * y0 + ai * x0) + (br * y1 + bi * x1) + (cr * y2 + ci * x2)
            + (dr * v0 + di * u0) + (er * v1 + ei * u1) + (fr * v2 + fi * u2))


def row_of_disturbance(g, d):
    """Return the product of a row of three complex gains with d."""
    ar, ai, br, bi, cr, ci = g
    m, n, t, s, j, k = d
    return ((ar * m - ai * n) + (br * t - bi * s) + (cr * j - ci * k),
            (ar * n + ai * m) + (br * s + bi * t) + (cr * k + ci * j))


def rotor_step(gains, x, u):
    """Return the state at the end of a step, and the mean reading over it, rad/s."""
    if len(x) == 4:
        a, b, mean = gains
        x0, y0 = row_two(a, x, u)
        x1, y1 = row_two(b, x, u)
        return (x0, y0, x1, y1), row_two(mean, x, u)
    a, b, c, mean = gains
    x0, y0 = row_three(a, x, u)
    x1, y1 = row_three(b, x, u)
    x2, y2 = row_three(c, x, u)
    return (x0, y0, x1, y1, x2, y2), row_three(mean, x, u)


def disturbed_step(gains, added, x, u, d):
    """Return the results of ``rotor_step`` under the disturbance d."""
    if len(x) == 4:
        (x0, y0, x1, y1), (y, z) = rotor_step(gains, x, u)
        a, b, mean = added
        p, q = row_of_disturbance(a, d)
        r, s = row_of_disturbance(b, d)
        m, n = row_of_disturbance(mean, d)
        return (x0 + p, y0 + q, x1 + r, y1 + s), (y + m, z + n)
    (x0, y0, x1, y1, x2, y2), (y, z) = rotor_step(gains, x, u)
    a, b, c, mean = added
    p, q = row_of_disturbance(a, d)
    r, s = row_of_disturbance(b, d)
    t, w = row_of_disturbance(c, d)
    m, n = row_of_disturbance(mean, d)
    return (x0 + p, y0 + q, x1 + r, y1 + s, x2 + t, y2 + w), (y + m, z + n)


def rotor_stages(stages, x, u):
    """Return the readings at the four stages of an RK4 step from state x, two floats each."""
    a, b, c, d = stages
    if len(x) == 4:
        return row_two(a, x, u), row_two(b, x, u), row_two(c, x, u), row_two(d, x, u)
    return row_three(a, x, u), row_three(b, x, u), row_three(c, x, u), row_three(d, x, u)


def run_rotor(count, gains, added, x, u, d, out):
    """
    Take ``count`` steps from state x and return the state after them.

    Parameters
    ----------
    count : number of steps
    gains, added, x : see the module docstring
    u, d : flat (6 count,) inputs of the steps; d is None for an undisturbed rotor
    out : flat (2 count,) that receives the mean readings
    """
    for k in range(count):
        i = 6 * k
        rates = u[i], u[i + 1], u[i + 2], u[i + 3], u[i + 4], u[i + 5]
        if d is None:
            x, mean = rotor_step(gains, x, rates)
        else:
            x, mean = disturbed_step(
                gains, added, x, rates, (d[i], d[i + 1], d[i + 2], d[i + 3], d[i + 4], d[i + 5]))
        out[2 * k], out[2 * k + 1] = mean
    return x
