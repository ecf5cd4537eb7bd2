"""Combine the responses of successive intervals into covariances and means of a whole run."""

import numpy as np

from ins_sim.core.navigation.error_dynamics import GROWING, turn_by_position
from ins_sim.core.numerics.fixed_order import product
from .sources import sources_of

# For each initial standard deviation or error: its states among the errors of position, velocity
# and attitude.
START_AXES = {'position': (0, 1, 2), 'velocity': (3, 4, 5), 'attitude': (6, 7, 8),
              'tilt': (6, 7), 'azimuth': (8,)}


def level_turn(lat, height):
    """
    Return the matrix (9, 9) that converts the inertial attitude error to that of the level frame.

    The computed level frame rotates with the position error (``turn_by_position``).
    """
    turn = np.eye(GROWING)
    turn[6, 1], turn[7, 0], turn[8, 0] = turn_by_position(lat, height)
    return turn


def start_columns(lat, height, held):
    """Return the initial nine errors (9, 9) for unit values of the inertial errors, by column."""
    back = 2.0 * np.eye(GROWING) - level_turn(lat, height)
    if held:
        back[:, [2, 5]] = 0.0
    return back


class NoiseErrors:
    """
    Covariances caused by the noises of one triad, by source and axis.

    Parameters
    ----------
    markov : MarkovProcesses
    walk_s : time for which the random walks have run before the start, s

    Attributes
    ----------
    sources : ErrorSources of the processes
    white, walk : (9, 9, 3) for unit density
    markov : (sources, 9, 9, 3) for unit values of the sources

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
        Propagate over one interval.

        Parameters
        ----------
        transition : (9, 9)
        noise : TriadNoise
        bias : (9, 3) response to constant errors
        length_s : length of the interval
        lane : index of the interval in noise

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
    """Return the product of the transition matrix and columns (m, 9, ...)."""
    rows = np.moveaxis(columns, 1, 0)
    return np.moveaxis(product(transition, rows.reshape(GROWING, -1)).reshape(rows.shape), 0, 1)


def _carried(transition, p):
    """Return F P F' for covariances (m, 9, 9, 3)."""
    return moved(transition, np.swapaxes(moved(transition, p), 1, 2))
