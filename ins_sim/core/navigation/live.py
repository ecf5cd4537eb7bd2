"""The strapdown on two live streams, IMU and truth."""

from ins_sim.core.streams.matching import MatchedStreams
from .navigator import InertialNavigator


class Navigator(MatchedStreams):
    """InertialNavigator on live IMU and truth; outputs are (t_ns, solution, errors)."""

    def begin(self):
        """Forget the solution."""
        self._navigator = InertialNavigator(self._settings)

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self._navigator.navigates

    def advance(self, t_ns, omega, f, truth):
        """Take matched samples; return the outputs."""
        errors = self._navigator.step(t_ns, omega, f, truth)
        return [] if errors is None else [(t_ns, self._navigator.solution, errors)]
