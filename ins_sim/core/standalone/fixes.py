"""The fixes of a live receiver: position of the vehicle, and its movement between fixes."""

from collections import deque
import math
from typing import NamedTuple

import numpy as np

from ins_sim.core.navigation.errors import position_error
from ins_sim.core.postprocessing.reference import LONGEST_STEP_S, SampledTrack

# Number of fixes kept; a standstill of the default length has far fewer.
MOST = 10_000
# Standard deviation of a fix with unknown covariance, m.
UNKNOWN_SIGMA_M = 5.0


class PlaceFix(NamedTuple):
    """
    A position fix.

    Attributes
    ----------
    t_ns : stamp, ns
    lat, lon, height : rad, rad, m
    sigma : standard deviation of the position, m, or None
    """

    t_ns: int
    lat: float
    lon: float
    height: float
    sigma: float | None = None

    @property
    def place(self):
        """Return latitude, longitude and height."""
        return self[1:4]


class FixTrack:
    """Fixes in the order of their stamps; a fix that is not newer than the last one is ignored."""

    def __init__(self):
        self.fixes, self._new = deque(maxlen=MOST), deque(maxlen=MOST)

    def push(self, fix):
        """Process a PlaceFix; return whether it was accepted."""
        if self.fixes:
            last = self.fixes[-1]
            if fix.t_ns <= last.t_ns:
                return False
            turns = round((fix.lon - last.lon) / (2.0 * math.pi))
            if turns:
                fix = fix._replace(lon=fix.lon - 2.0 * math.pi * turns)
            way = position_error(*fix.place, *last.place)[:2]
            self._new.append(((last.t_ns + fix.t_ns) // 2, way))
        self.fixes.append(fix)
        return True

    @property
    def newest_ns(self):
        """Return the stamp of the last fix, or None."""
        return self.fixes[-1].t_ns if self.fixes else None

    def take_ways(self):
        """
        Return the new displacements from fix to fix, and forget them.

        Each is a tuple of the stamp half-way in time (ns) and (east, north) (m).
        """
        ways = list(self._new)
        self._new.clear()
        return ways

    def forget_ways(self, t_ns):
        """Forget the movement before a stamp, such as that during a standstill."""
        while self._new and self._new[0][0] < t_ns:
            self._new.popleft()

    def covers(self, t_ns):
        """Return whether the position at a stamp is final, whatever fixes follow."""
        return bool(self.fixes) and self.fixes[-1].t_ns >= t_ns

    def _track(self, t_ns):
        around = [f for f in self.fixes if abs(f.t_ns - t_ns) <= 2e9 * LONGEST_STEP_S]
        if not around:
            return None
        return SampledTrack(np.array([f.t_ns for f in around], dtype=np.int64),
                            np.array([f.place for f in around]))

    def place(self, t_ns, near=False):
        """
        Return latitude (rad), longitude (rad) and height (m) at a stamp, or None.

        near: whether to use the nearest fix within LONGEST_STEP_S if one side has no fix.
        """
        track = self._track(t_ns)
        if track is None:
            return None
        found = track.near(t_ns) if near else track.at([t_ns])[0]
        return None if np.isnan(found).any() else tuple(found.tolist())

    def sigma(self, t_ns):
        """Return the standard deviation of the position at a stamp, m."""
        known = [f for f in self.fixes if f.sigma is not None]
        if not known:
            return UNKNOWN_SIGMA_M
        return min(known, key=lambda f: abs(f.t_ns - t_ns)).sigma

    def moved(self, start_ns, end_ns):
        """Return distance (m) and time (s) from the first to the last fix between two stamps."""
        inside = [f for f in self.fixes if start_ns <= f.t_ns <= end_ns]
        if len(inside) < 2:
            return 0.0, 0.0
        east, north, _ = position_error(*inside[-1].place, *inside[0].place)
        return (math.sqrt(east * east + north * north),
                1e-9 * (inside[-1].t_ns - inside[0].t_ns))
