"""Compose the responses of successive intervals to covariances and means of a whole run."""

import numpy as np

from ins_sim.core.navigation.error_dynamics import GROWING, turn_by_position
from ins_sim.core.numerics.fixed_order import product
from .sources import sources_of

# The axes on which an initial standard deviation or error acts: those of position, velocity and
# attitude.
START_AXES = {'position': (0, 1, 2), 'velocity': (3, 4, 5), 'attitude': (6, 7, 8),
              'tilt': (6, 7), 'azimuth': (8,)}


def level_turn(lat, height):
    """
    Return the matrix (9, 9) from the attitude error of the level frame to the inertial one.

    The computed level frame rotates with the position error (``turn_by_position``).
    """
    turn = np.eye(GROWING)
    turn[6, 1], turn[7, 0], turn[8, 0] = turn_by_position(lat, height)
    return turn


def start_columns(lat, height, held):
    """Return the initial errors (9, 9) due to units of the inertial errors at the start."""
    back = 2.0 * np.eye(GROWING) - level_turn(lat, height)
    if held:
        back[:, [2, 5]] = 0.0
    return back


class NoiseErrors:
    """
    Covariances of the noises of one triad, by source and axis.

    Parameters
    ----------
    markov : MarkovProcesses
    walk_s : time for which the random walks have run at the start, s

    Attributes
    ----------
    sources : the ErrorSources of the processes
    white, walk : (9, 9, 3) for a density of one
    markov : (sources, 9, 9, 3) for units of the sources
    """

    def __init__(self, markov, walk_s):
        self.sources = sources = sources_of(markov)
        self._of = [sources.index(process.source) for process in markov]
        self._variances = [np.array(process.variance) for process in markov]
        self.white = np.zeros((GROWING, GROWING, 3))
        self.walk = np.zeros_like(self.white)
        self.markov = np.zeros((len(sources), *self.white.shape))
        self._with = np.zeros((len(markov), GROWING, 3))
        self._with_walk, self._walk_variance = np.zeros((GROWING, 3)), walk_s

    def advance(self, transition, noise, bias, length_s, lane):
        """
        Advance by one interval.

        transition: (9, 9); noise: TriadNoise; bias: response to constant errors (9, 3); length_s:
        length of the interval, s; lane: its number in the noise.
        """
        ahead = moved(transition, self._with)
        cross = ahead[:, :, np.newaxis] * noise.start[:, np.newaxis, :, :, lane]
        self.markov = _carried(transition, self.markov) + noise.markov[..., lane]
        for k, (source, variance) in enumerate(zip(self._of, self._variances)):
            self.markov[source] += variance * (cross[k] + np.swapaxes(cross[k], 0, 1))
        self._with = (noise.kept[:, np.newaxis, :, lane] * ahead + noise.end[..., lane])
        self.white = _carried(transition, self.white[np.newaxis])[0] + noise.white[..., lane]
        ahead = moved(transition, self._with_walk[np.newaxis])[0]
        cross = ahead[:, np.newaxis] * bias
        self.walk = (_carried(transition, self.walk[np.newaxis])[0] + noise.walk[..., lane]
                     + (cross + np.swapaxes(cross, 0, 1))
                     + self._walk_variance * (bias[:, np.newaxis] * bias))
        self._with_walk = ahead + self._walk_variance * bias + noise.walk_end[..., lane]
        self._walk_variance += length_s


def moved(transition, columns):
    """Return the transition matrix times columns (m, 9, ...)."""
    rows = np.moveaxis(columns, 1, 0)
    return np.moveaxis(product(transition, rows.reshape(GROWING, -1)).reshape(rows.shape), 0, 1)


def _carried(transition, p):
    """Return F P F' for covariances (m, 9, 9, 3)."""
    return moved(transition, np.swapaxes(moved(transition, p), 1, 2))
