"""
How the errors of position, velocity and attitude grow: the rows that all error models share.

The errors are those of ``errors.level_errors``, East, North, Up: position (m), velocity (m/s), and
attitude phi (rad), each in its own n.  The columns behind them are the biases of accelerometers
and gyros, as what is to be taken off the readings (m/s^2, rad/s, by body axis).
"""

from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import product

# How many errors have rows, the first ones; the others of a model are constant.
GROWING = 9


def inertial_rows(lat, height, v, c, f_n, spin):
    """
    Return nine rows of 15 numbers of F of x' = F x.

    lat rad, height m, v (3,) m/s ENU; c: C_nb, nine floats; f_n (3,) specific force in n, m/s^2;
    all floats or arrays; spin: rate of the Earth, rad/s.  The change of the radii with latitude
    and that of gravity with latitude are left out, parts in 100 of the smallest terms.  Groves
    section 14.2.4.
    """
    v_e, v_n, v_u = v
    f_e, f_n, f_u = f_n
    c_ex, c_ey, c_ez, c_nx, c_ny, c_nz, c_ux, c_uy, c_uz = c
    sin, cos = elementary.sincos(lat)
    tan = sin / cos
    r_n, r_e = ellipsoid.radii(sin)
    r_n, r_e = r_n + height, r_e + height
    # How the rates of the Earth (o) and of transport (t) change with position (n: with that to
    # the north, u: up), per m, and the latter with velocity, per m/s.
    o_un, o_nn = spin * cos / r_n, -spin * sin / r_n
    t_eu, t_nu = v_n / (r_n * r_n), -v_e / (r_e * r_e)
    t_un, t_uu = v_e / (r_e * cos * cos * r_n), -v_e * tan / (r_e * r_e)
    by_e, by_n = 1.0 / r_e, 1.0 / r_n
    up_by_e = tan / r_e
    # Rate of n in inertial space, and the same with that of the Earth twice.
    w_e, w_n, w_u = -v_n / r_n, spin * cos + v_e / r_e, spin * sin + v_e * tan / r_e
    x_n, x_u = w_n + spin * cos, w_u + spin * sin
    d_nn, d_un = 2.0 * o_nn, 2.0 * o_un + t_un
    gradient = 2.0 * ellipsoid.GRAVITY_EQUATOR / ellipsoid.SEMI_MAJOR
    return (
        (v_u / r_e - tan * v_n / r_n, v_e * tan / r_n, -v_e / r_e,
         1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, v_u / r_n, -v_n / r_n,
         0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, v_n * d_un - v_u * d_nn, v_n * t_uu - v_u * t_nu,
         v_n * up_by_e - v_u * by_e, x_u, -x_n,
         0.0, f_u, -f_n, -c_ex, -c_ey, -c_ez, 0.0, 0.0, 0.0),
        (0.0, -v_e * d_un, v_u * t_eu - v_e * t_uu,
         -v_e * up_by_e - x_u, -v_u * by_n, w_e,
         -f_u, 0.0, f_e, -c_nx, -c_ny, -c_nz, 0.0, 0.0, 0.0),
        (0.0, v_e * d_nn, v_e * t_nu - v_n * t_eu + gradient,
         v_e * by_e + x_n, v_n * by_n - w_e, 0.0,
         f_n, -f_e, 0.0, -c_ux, -c_uy, -c_uz, 0.0, 0.0, 0.0),
        (0.0, 0.0, -t_eu, 0.0, by_n, 0.0,
         0.0, w_u, -w_n, 0.0, 0.0, 0.0, -c_ex, -c_ey, -c_ez),
        (0.0, -o_nn, -t_nu, -by_e, 0.0, 0.0,
         -w_u, 0.0, w_e, 0.0, 0.0, 0.0, -c_nx, -c_ny, -c_nz),
        (0.0, -o_un - t_un, -t_uu, -up_by_e, 0.0, 0.0,
         w_n, -w_e, 0.0, 0.0, 0.0, 0.0, -c_ux, -c_uy, -c_uz))


def change(f, dt):
    """
    Return exp(F dt) less 1 to second order, in the rows and columns of F that are given.

    f: rows of F, the first GROWING of which are those of the first columns; only these columns
    have rows that a change to second order needs.  F being that of mid-interval, what is left out
    is of the order dt^3.
    """
    a = f * dt
    return a + 0.5 * product(a[:, :GROWING], a[:GROWING])


def turn_by_position(lat, height):
    """
    Return the turn of the computed n by an error of the position, rad/m, as three numbers.

    The turn is (a p_N, b p_E, c p_E) about East, North, Up; with the attitude error phi it is
    the inertial attitude error, that of the attitude in a frame fixed to the Earth.
    """
    sin, cos = elementary.sincos(lat)
    r_n, r_e = ellipsoid.radii(sin)
    by_e = 1.0 / (r_e + height)
    return -1.0 / (r_n + height), by_e, by_e * (sin / cos)
