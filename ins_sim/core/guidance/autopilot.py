"""The interface of the autopilots, a public point of extension, and their look-up by name."""

from ins_sim.core.numerics.located import located
from ins_sim.settings.guidance import AUTOPILOTS


class Autopilot:
    """
    Base class of the autopilots: from the estimated offset to the commanded sideslip.

    ``Steering`` creates one object for a run. It calls ``reset`` when the autopilot is engaged and
    after every turn, and then ``command`` once per control period. It limits the command, and it
    does not call the autopilot in turns or without a solution. An autopilot may keep any state
    between the calls, which follow each other at the control period.

    Parameters
    ----------
    settings : GuidanceSettings
    """

    def __init__(self, settings):
        self.settings = settings

    def reset(self):
        """Start anew: the next command is the first."""

    def command(self, t_ns, z, v_z):
        """
        Return the sideslip to fly at the end of the next control period, rad.

        Parameters
        ----------
        t_ns : int
            Motion time now, ns.
        z : float
            Estimated offset to the right of the leg, m.
        v_z : float
            Its estimated rate, m/s.

        Returns
        -------
        float
            Positive: the track is to the right of the nose, the side force acts to the left.
        """
        raise NotImplementedError

    def gains(self):
        """Return the gains of z (rad/m) and v_z (rad s/m) of a linear autopilot, or None."""
        return None


def make_autopilot(settings):
    """Return the Autopilot named by GuidanceSettings."""
    name = settings.autopilot
    return located(AUTOPILOTS[name].location, f'autopilot {name}')(settings)
