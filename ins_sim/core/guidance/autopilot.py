"""The interface of the autopilots, which users can extend, and the lookup of their classes."""

from ins_sim.core.numerics.located import located
from ins_sim.settings.guidance import AUTOPILOTS


class Autopilot:
    """
    Base class of the autopilots: estimated offset in, commanded sideslip out.

    ``Steering`` makes one object for a run. It calls ``reset`` when the autopilot is engaged and
    after every turn, and then ``command`` once for each control period. It limits the command,
    and it does not call the autopilot in turns or without a solution. An autopilot may keep any
    state between calls; successive calls are one control period apart.

    Parameters
    ----------
    settings : GuidanceSettings
    """

    def __init__(self, settings):
        self.settings = settings

    def reset(self):
        """Restart: the next call of ``command`` is the first."""

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
            Positive: track to the right of the nose, a force to the left.
        """
        raise NotImplementedError

    def gains(self):
        """Return the gains of z, rad/m, and v_z, rad s/m; None if the autopilot is not linear."""
        return None


def make_autopilot(settings):
    """Return the Autopilot that GuidanceSettings name."""
    name = settings.autopilot
    return located(AUTOPILOTS[name].location, f'autopilot {name}')(settings)
