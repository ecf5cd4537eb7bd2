"""
Linear growth of the errors of position, velocity and attitude, shared by all error models.

The first nine states are the errors of ``errors.level_errors``, each east, north, up: position
(m), velocity (m/s), and attitude phi (rad; computed and true attitude each relative to the level
frame at its own position). The next six states are the biases of the accelerometers (m/s^2) and
of the gyros (rad/s), by body axis; a bias is the value to subtract from the readings.
"""

from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import product

# Number of states with rows in F: the first nine. All other states of a model are constant.
GROWING = 9


def inertial_rows(lat, height, v, c, f_n, spin):
    """
    Return the nine rows, with 15 columns, of F in x' = F x.

    The change of the radii of curvature and of gravity with latitude is neglected: parts in 100 of
    the smallest terms. Source: Groves, 2nd ed., section 14.2.4.

    Parameters
    ----------
    lat, height : latitude (rad) and height (m), floats or arrays, as all that follow
    v : (3,) velocity east, north, up, m/s
    c : C_nb, nine numbers row by row
    f_n : (3,) specific force in n, m/s^2
    spin : rotation rate of the Earth, rad/s

    Returns
    -------
    tuple of nine tuples of 15 numbers

    """
    v_e, v_n, v_u = v
    f_e, f_n, f_u = f_n
    c_ex, c_ey, c_ez, c_nx, c_ny, c_nz, c_ux, c_uy, c_uz = c
    sin, cos = elementary.sincos(lat)
    tan = sin / cos
    r_n, r_e = ellipsoid.radii(sin)
    r_n, r_e = r_n + height, r_e + height
    # Derivatives of the Earth rate (o) and of the transport rate (t). The first index is the axis
    # (e, n, u), the second the cause: n for northward position, u for height, both per m. by_e,
    # by_n and up_by_e: derivatives of the transport rate with velocity, per m/s.
    o_un, o_nn = spin * cos / r_n, -spin * sin / r_n
    t_eu, t_nu = v_n / (r_n * r_n), -v_e / (r_e * r_e)
    t_un, t_uu = v_e / (r_e * cos * cos * r_n), -v_e * tan / (r_e * r_e)
    by_e, by_n = 1.0 / r_e, 1.0 / r_n
    up_by_e = tan / r_e
    # w: rate of n in inertial space. x: the same plus the rate of the Earth once more.
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
    Return N = exp(F dt) - 1 to second order in dt.

    Evaluated with F at mid-interval, the remaining error is of order dt^3.

    Parameters
    ----------
    f : the given rows of F; the first GROWING rows must belong to the first GROWING columns,
        because only those states have rows that the second-order term needs
    dt : length of the interval, s

    Returns
    -------
    N, in the same rows and columns as f

    """
    a = f * dt
    return a + 0.5 * product(a[:, :GROWING], a[:GROWING])


def turn_by_position(lat, height):
    """
    Return the rotation of the computed level frame n caused by a position error, rad/m.

    Returns a, b, c, where (a p_N, b p_E, c p_E) is the rotation about east, north, up for the
    position error (p_E, p_N). Added to phi it gives the inertial attitude error: the attitude
    error in a frame fixed to the Earth.
    """
    sin, cos = elementary.sincos(lat)
    r_n, r_e = ellipsoid.radii(sin)
    by_e = 1.0 / (r_e + height)
    return -1.0 / (r_n + height), by_e, by_e * (sin / cos)
