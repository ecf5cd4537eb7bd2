"""The strapdown on two live streams, IMU and truth."""

import math

from ins_sim.core.numerics.instants import seconds
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.streams.matching import MatchedStreams, TRUTH_LENGTH
from .navigator import InertialNavigator


class Navigator(MatchedStreams):
    """
    InertialNavigator on live IMU and truth; outputs are (t_ns, solution, errors, shown).

    settings, truth_length: as of MatchedStreams; covariance: a FreeCovariance kept beside it,
    whose ``shown`` of the instant is given with each output, or None.
    """

    def __init__(self, settings, truth_length=TRUTH_LENGTH, covariance=None):
        self._covariance = covariance
        super().__init__(settings, truth_length)

    def begin(self):
        """Forget the solution."""
        self._navigator = InertialNavigator(self._settings, self._covariance)

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
        return [(t_ns, solution, errors, self._covariance and self._covariance.shown)]
