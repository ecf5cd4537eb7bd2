"""The vertical channel: taken from the truth, free, or damped by a reference height."""

from ins_sim.core.earth import ellipsoid

FROM_TRUTH, FREE, DAMPED = 0, 1, 2
# c1, c2, c3 of a channel without damping.
NO_DAMPING = (0.0, 0.0, 0.0)


def damped(height, v_u, bias, off, dt, c1, c2, c3):
    """Return height, vertical velocity and bias after damping the height error off (m) over dt."""
    return height - dt * c1 * off, v_u - dt * (c2 * off + bias), bias + dt * c3 * off


def damping(time_constant):
    """
    Return c1, c2, c3 of the vertical channel with a triple pole at -1 / time_constant (s).

    c2 compensates the gravity gradient 2 g / R (Kayton and Fried, "Avionics Navigation Systems",
    2nd ed., section 7.5.4).
    """
    r = 1.0 / time_constant
    return 3.0 * r, 3.0 * r * r + 2.0 * ellipsoid.GRAVITY_EQUATOR / ellipsoid.SEMI_MAJOR, r * r * r
