"""The strapdown on two live streams, IMU and truth."""

import math

from ins_sim.core.numerics.instants import seconds
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.streams.matching import MatchedStreams
from .navigator import InertialNavigator


class Navigator(MatchedStreams):
    """
    InertialNavigator on live IMU and truth; outputs are (t_ns, solution, errors).

    covariance: a FreeCovariance kept beside it, or None; settings, waiting_limit: as of
    MatchedStreams.
    """

    def __init__(self, settings, waiting_limit, covariance=None):
        self.covariance = covariance
        super().__init__(settings, waiting_limit)

    def begin(self):
        """Forget the solution."""
        self._navigator = InertialNavigator(self._settings, self.covariance)

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self._navigator.navigates

    def advance(self, t_ns, omega, f, truth):
        """Take matched samples; return the outputs."""
        errors = self._navigator.step(t_ns, omega, f, truth)
        if errors is None:
            return []
        solution = self._navigator.solution
        lat, lon, height, v, q = solution
        # a sum is finite only if all of it is
        if not math.isfinite(lat + lon + height + v[0] + v[1] + v[2] + q[0] + q[1] + q[2] + q[3]):
            raise StreamFault(f'the solution at {seconds(t_ns)} is no number any more; expected '
                              'finite readings', restart=True)
        return [(t_ns, solution, errors)]
