"""The motion over many intervals side by side, and the inputs of the error model in each step."""

import numpy as np

from ins_sim.core.attitude.matrix import dcm_of
from ins_sim.core.earth.rates import rate_of_n
from ins_sim.core.timeseries.histories import Truth
from ..drift import drift_density

# Number of instants at which the motion is evaluated together.
AT_ONCE = 16384


class TimeLanes:
    """
    The truth over n intervals of equal steps, at the ends and middles of the steps.

    motion : Motion
    edges_s : (n + 1,) motion times that bound the intervals, s
    steps : number of steps of each interval
    earth_rotation : whether the Earth rotates

    Attributes
    ----------
    h : (n,) length of the steps of each interval, s
    truth : Truth at the (2 steps + 1) n instants; the k-th instants of all intervals are adjacent
    t_s : (2 steps + 1, n) motion times, s
    c : C_nb, nine arrays of the shape of t_s
    """

    def __init__(self, motion, edges_s, steps, earth_rotation):
        self.steps = steps
        self.h = np.diff(edges_s) / steps
        self.t_s = edges_s[:-1] + 0.5 * self.h * np.arange(2 * steps + 1)[:, np.newaxis]
        t_ns = np.round(1e9 * self.t_s).astype(np.int64).ravel()
        self.truth = Truth.concatenate([motion.at(t_ns[first:first + AT_ONCE])
                                        for first in range(0, len(t_ns), AT_ONCE)])
        self._rotation, self._omega_in = earth_rotation, None
        self.c = [x.reshape(self.t_s.shape) for x in dcm_of(tuple(self.truth.q_nb.T))]

    def columns(self, vectors):
        """Return the three components of vectors, one per instant, as arrays like t_s."""
        return [x.reshape(self.t_s.shape) for x in vectors.T]

    def means(self, values):
        """
        Return the means over the steps (steps, n) of an array of the shape of t_s, by Simpson's
        rule.
        """
        return (values[:-1:2] + 4.0 * values[1::2] + values[2::2]) / 6.0

    def means_in_n(self, components):
        """Return the means (steps, 3, n), in n, of vectors given in b."""
        x, y, z = components
        c = self.c
        return np.stack([self.means(c[k] * x + c[k + 1] * y + c[k + 2] * z) for k in (0, 3, 6)],
                        axis=1)

    def late_means_in_n(self, late):
        """
        Return the means (steps, 3, n), in n, of the errors of a triad with lag.

        late: the part of the integral of the input that has not been read yet, in b, one vector
        per instant. The error of the reading is minus its derivative (``drift_density``).
        """
        if self._omega_in is None:
            truth = self.truth
            self._omega_in = rate_of_n(truth.lat, truth.height, truth.v_n, self._rotation)
        density, behind = map(self.columns, drift_density(self.truth, self._omega_in, late))
        return np.stack([self.means(d) - (b[2::2] - b[:-1:2]) / self.h
                         for d, b in zip(density, behind)], axis=1)

    def slopes(self, vectors):
        """Return the time derivatives of vectors, one per instant."""
        values = np.reshape(vectors, (*self.t_s.shape, 3))
        per_step = np.gradient(values, axis=0, edge_order=2)
        return np.reshape(per_step / (0.5 * self.h)[:, np.newaxis], (-1, 3))

    def by_error(self, reading):
        """
        Return the means (steps, 3, 9, n), in n, of the errors caused by unit constant errors.

        reading: components of the input of a triad in b.  The nine columns are biases, scale
        factors and misalignments (rotations from the body axes to those of the triad) of the axes
        x, y, z.
        """
        x, y, z = reading
        c = self.c
        found = np.empty((self.steps, 3, 9, len(self.h)))
        for row in range(3):
            p, q, r = c[3 * row:3 * row + 3]
            for k, value in enumerate((p, q, r, p * x, q * y, r * z,
                                       q * z - r * y, r * x - p * z, p * y - q * x)):
                found[:, row, k] = self.means(value)
        return found

    def middle(self, step):
        """
        Return the arguments for the coefficients of a step, all arrays (n,).

        They are lat, height, velocity in n (3), C_nb (9) and specific force in n (3); the last is
        a mean over the step.
        """
        truth, width = self.truth, len(self.h)
        part = slice((2 * step + 1) * width, (2 * step + 2) * width)
        return (truth.lat[part], truth.height[part], tuple(truth.v_n[part].T),
                [x[2 * step + 1] for x in self.c])
