"""The strapdown on two live streams, IMU and truth."""

from ins_sim.core.streams.matching import MatchedStreams
from .strapdown import Strapdown


class Navigator(MatchedStreams):
    """A Strapdown on two live streams, IMU and truth; outputs are (t_ns, solution, errors)."""

    def begin(self):
        """Forget the solution."""
        self._strapdown = Strapdown(self._settings)

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self._strapdown.state is not None

    def advance(self, t_ns, omega, f, truth):
        """Take matched samples; return the outputs."""
        if not self._strapdown.step(t_ns, omega, f, truth):
            return []
        return [(t_ns, self._strapdown.solution(t_ns), self._strapdown.errors(t_ns, truth))]
