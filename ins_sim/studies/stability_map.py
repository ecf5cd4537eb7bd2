"""Stability of the closed loop over k_z and the gain: by the linear theory, and by flights."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.guidance.error_loop import fly_reduced, ReducedCases
from ins_sim.core.guidance.linear_loop import Aiding, limits

MOST_K_Z = 1.0
# Number of values of k_z in the first search, and in the second one between two of them.
STEPS, STAGES = 32, 2
# A flight does not decay if the range in its last quarter exceeds this fraction of that in the
# quarter before, unless it is smaller than this, rad.
DECAYS, QUIET_RAD = 0.99, 1e-7
STARTS_M = (1.0, 100.0)


@dataclass(frozen=True)
class MapPanel:
    """
    A filter of the map.

    Attributes
    ----------
    kind : see ``linear_loop.Aiding``
    cycles : N, number of cycles of a window
    slides : whether a window ends every cycle
    least, most : range of the gains, K_v in 1/s for sliding windows
    """

    kind: str
    cycles: int
    slides: bool
    least: float
    most: float

    @property
    def label(self):
        """Return a label with filter and N."""
        return f'{"sliding conventional" if self.slides else self.kind}, N {self.cycles}'

    def gains(self, count):
        """Return gains over the range (count,)."""
        return np.geomspace(self.least, self.most, count)

    def aiding(self, gain, period_s):
        """Return the Aiding for a gain."""
        step = 1 if self.slides else self.cycles
        return Aiding(self.kind, self.cycles, step, gain * period_s if self.slides else gain)


PANELS = (*(MapPanel('conventional', n, True, 0.1, 20.0) for n in (10, 100, 1000)),
          *(MapPanel('paper_corrected', n, False, 0.05, 1.9) for n in (100, 1000)),
          MapPanel('conventional', 100, False, 0.02, 1.0))


@dataclass(frozen=True)
class MapCurves:
    """
    Limits of k_z over the gains (n,) of a MapPanel.

    linear (n,): by the linear theory; flown {z at the start, m: (n,)}: by reduced flights. Both
    are at most MOST_K_Z, and 0 if the loop is unstable without any error.
    """

    gains: np.ndarray
    linear: np.ndarray
    flown: dict


def map_curves(loop, panel, count, most_rad):
    """Return the MapCurves of a LateralLoop with a command limit of +-most_rad."""
    gains = panel.gains(count)
    linear = [_linear(limits(loop, panel.aiding(gain, loop.period_s))) for gain in gains.tolist()]
    return MapCurves(gains, np.array(linear), {
        start: flown_limits(loop, panel, gains, start, most_rad) for start in STARTS_M})


def _linear(found):
    if found.unstable:
        return 0.0
    return MOST_K_Z if found.positive is None else min(MOST_K_Z, found.positive.k_z)


def flown_limits(loop, panel, gains, start_m, most_rad):
    """
    Return the smallest k_z (n,) for which reduced flights from an offset do not decay.

    0: none decays; MOST_K_Z: all decay.
    """
    low, width = np.zeros(len(gains)), MOST_K_Z
    for stage in range(STAGES):
        width /= STEPS
        # The flight at the first value of the second search is known to decay, at the last not.
        k_z = low + width * np.arange(STEPS + 1)[:, None]
        restless = _restless(loop, panel, np.tile(gains, STEPS + 1), k_z.ravel(), start_m,
                             most_rad).reshape(k_z.shape)
        first = np.where(restless.any(axis=0), restless.argmax(axis=0), STEPS + 1)
        if stage == 0:
            always, never = first == 0, first == STEPS + 1
        low = low + width * (np.clip(first, 1, STEPS) - 1)
    return np.where(always, 0.0, np.where(never, MOST_K_Z, low + 0.5 * width))


def _restless(loop, panel, gains, k_z, start_m, most_rad):
    """Return whether flights do not decay (n,)."""
    aiding = panel.aiding(1.0, loop.period_s)
    cases = ReducedCases(gains * aiding.gain, k_z, np.full(len(gains), start_m))
    # Two periods of the slowest mode in a quarter of the flight.
    duration_s = 300.0 + 30.0 * aiding.cycles * loop.period_s
    beta = fly_reduced(loop, aiding, cases, duration_s, most_rad).beta
    quarter = len(beta) // 4
    before, last = (np.ptp(part, axis=0) for part in (beta[-2 * quarter:-quarter],
                                                      beta[-quarter:]))
    return (last > DECAYS * before) & (last > QUIET_RAD)
