"""The limits of the velocity meter: height, speed, and direction of the velocity."""

from ins_sim.core.timeseries.fixes import VALID


def why_not_measurable(limits, v, height):
    """
    Return VALID if the instrument can measure, otherwise the reason why it cannot.

    Parameters
    ----------
    limits : settings
    v : V_x1, V_y1, V_z1 in the axes of the antennas, m/s
    height : above the ground, m
    """
    if not limits.height_min_m <= height <= limits.height_max_m:
        return 'height outside the limits'
    if not limits.speed_min_m_s <= v[0] <= limits.speed_max_m_s:
        return 'speed outside the limits'
    if abs(v[2]) > v[0] or abs(v[1]) > v[0]:
        return 'sideslip or angle of attack beyond 45 deg'
    return VALID


def all_measurable(limits, v, height):
    """Return whether the instrument can measure at all instants; v (3, n), height (n,)."""
    return bool(((limits.height_min_m <= height) & (height <= limits.height_max_m)
                 & (limits.speed_min_m_s <= v[0]) & (v[0] <= limits.speed_max_m_s)
                 & (abs(v[2]) <= v[0]) & (abs(v[1]) <= v[0])).all())
