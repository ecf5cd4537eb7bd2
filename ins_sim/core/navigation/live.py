"""The strapdown on two live streams: IMU and truth."""

import math

from ins_sim.core.numerics.instants import seconds
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.streams.matching import MatchedStreams, TRUTH_LENGTH
from .navigator import InertialNavigator


class Navigator(MatchedStreams):
    """
    Runs an InertialNavigator on live IMU and truth; outputs are (t_ns, solution, errors, shown).

    settings, truth_length: see MatchedStreams.  covariance: a FreeCovariance to propagate together
    with the navigator, or None; ``shown`` is its current ``shown``.
    """

    def __init__(self, settings, truth_length=TRUTH_LENGTH, covariance=None):
        self._covariance = covariance
        super().__init__(settings, truth_length)

    def begin(self):
        """Discard the solution and start anew."""
        self._navigator = InertialNavigator(self._settings, self._covariance)

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self._navigator.navigates

    def advance(self, t_ns, omega, f, truth):
        """Process matched samples; return the outputs."""
        errors = self._navigator.step(t_ns, omega, f, truth)
        if errors is None:
            return []
        solution = self._navigator.solution
        lat, lon, height, v, q = solution
        # One sum tests all values together: it is finite only if every term is.
        if not math.isfinite(lat + lon + height + v[0] + v[1] + v[2] + q[0] + q[1] + q[2] + q[3]):
            raise StreamFault(f'the solution at {seconds(t_ns)} is not finite; expected '
                              'finite readings', restart=True)
        return [(t_ns, solution, errors, self._covariance and self._covariance.shown)]
