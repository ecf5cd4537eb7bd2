"""The autopilots of the lateral channel: return to the leg, or fly parallel to it."""

from .autopilot import Autopilot


def lateral_command(gains, z, v_z):
    """Return k1 z + k2 v_z, rad; gains: k1 (rad/m) and k2 (rad s/m)."""
    k1, k2 = gains
    return k1 * z + k2 * v_z


class LateralAutopilot(Autopilot):
    """Turn the nose so that the estimated offset from the leg goes to zero."""

    def __init__(self, settings):
        super().__init__(settings)
        lateral = settings.lateral
        self._gains = lateral.offset_gain_rad_m, lateral.rate_gain_rad_s_m

    def command(self, t_ns, z, v_z):
        """Return the commanded sideslip, rad."""
        return lateral_command(self._gains, z, v_z)

    def gains(self):
        """Return k1 and k2."""
        return self._gains


class CourseHold(LateralAutopilot):
    """Flies parallel to the leg at any offset: only the rate of the offset is controlled."""

    def __init__(self, settings):
        super().__init__(settings)
        self._gains = 0.0, settings.lateral.rate_gain_rad_s_m
