"""
The readings of one triad in 16 runs, in lanes.

If a triad has only constant errors, white noise and processes, one compiled loop makes the
readings of all runs, with the operations of ``TriadErrors``. Anything else is computed run by run.
"""

import numpy as np

from ins_sim.core.numerics import compilation, normals
from ins_sim.core.numerics.noise import BLOCK, cut
from ins_sim.core.sensors.imu.triad_reading import respond, three_of
from .lanes import LANES


class SensedTriad:
    """
    One triad of a group of runs.

    Parameters
    ----------
    triads : TriadErrors of each run
    column : 0 for gyros, 3 for accelerometers
    """

    def __init__(self, triads, column):
        self._triads, self._column = triads, column
        self._constants = None
        found = [triad.at_once for triad in triads]
        if None not in found:
            self._constants = _constants(found)
            self._processes = [noise.processes for _, _, noise in found]

    def read(self, first, values, forces, t_s, readings):
        """
        Write the readings of n consecutive samples.

        Parameters
        ----------
        first : index of the first sample
        values, forces : (n, 3), see ``TriadErrors.advance``
        t_s : (n,) motion times, s
        readings : (n, 6, LANES)
        """
        if self._constants is None:
            self._read_each(first, values, forces, t_s, readings)
            return
        others = None
        if any(self._processes):
            others = np.zeros((LANES, len(self._processes[0]), len(values), 3))
            for lane, processes in enumerate(self._processes):
                for k, process in enumerate(processes):
                    others[lane, k] = cut(process, BLOCK, first, len(values))

        def plain(*_):
            self._read_each(first, values, forces, t_s, readings)

        compilation.run(read_lanes, LANES * len(values),
                        (self._column, first, values, *self._constants, others), readings, plain)

    def _read_each(self, first, values, forces, t_s, readings):
        """Compute the readings run by run."""
        for lane, triad in enumerate(self._triads):
            readings[:, self._column:self._column + 3, lane] = triad.advance(first, values,
                                                                             forces, t_s)


def _constants(found):
    """Return the constants of ``read_lanes``, or None if the runs have different terms."""
    geometry, response, noise = zip(*found)
    if len({(g is None, r is None) for g, r in zip(geometry, response)}) > 1:
        return None
    count = len(found)
    fixed, keys = np.zeros((LANES, 3)), np.zeros((LANES, 2), dtype=np.uint64)
    fixed[:count] = [n.fixed for n in noise]
    white = noise[0].white
    if white is not None:
        keys[:count] = [n.stream.key for n in noise]
    return fixed, white, keys, _filled(geometry), _filled(response)


def _filled(terms):
    """Return the terms of all lanes as a flat array, or None."""
    if terms[0] is None:
        return None
    rows = np.array([np.ravel(term) for term in terms])
    return np.concatenate([rows, np.zeros((LANES - len(rows), rows.shape[1]))])


def read_lanes(column, first, values, fixed, white, keys, geometry, response, others, out):
    """
    Write the readings of 16 runs; for compiled code only, see ``normals.fill``.

    Parameters
    ----------
    column : first of the three rows of out that are written
    first : index of the first sample
    values : flat, three per sample
    fixed : flat, three biases per lane
    white : three standard deviations, or None
    keys : flat, key of the white noise of each lane, two words
    geometry, response : flat, 9 and 12 numbers per lane, see ``respond``; or None
    others : flat, per lane and process three numbers for each sample; or None
    out : flat, six rows of LANES per sample
    """
    count, done = len(values) // 3, 0
    row = 3 * BLOCK
    z, z_of_lane = np.zeros(LANES * row), np.empty(row)
    while done < count:
        block = (first + done) // BLOCK
        skipped = first + done - block * BLOCK
        end = min(count, done + BLOCK - skipped)
        for lane in range(LANES):
            if white is not None:
                normals.fill(keys[2 * lane], keys[2 * lane + 1], normals.ZERO, block, 1, row,
                             z_of_lane)
                for i in range(row):
                    z[lane * row + i] = z_of_lane[i]
        for k in range(done, end):
            value = three_of(values, 3 * k)
            for lane in range(LANES):
                turn, scale = nine_of(geometry, 9 * lane), twelve_of(response, 12 * lane)
                bias = fixed[3 * lane], fixed[3 * lane + 1], fixed[3 * lane + 2]
                x, y, w = respond(turn, scale, None, None, value, None, None)
                a, b, c = with_white(white, bias, z, lane * row + 3 * (k - done + skipped))
                a, b, c = with_others(others, a, b, c, lane, k, count)
                i = (6 * k + column) * LANES + lane
                out[i], out[i + LANES], out[i + 2 * LANES] = x + a, y + b, w + c
        done = end


def with_white(white, bias, z, i):
    """Return a bias plus white noise, if any."""
    if white is None:
        return bias
    return bias[0] + white[0] * z[i], bias[1] + white[1] * z[i + 1], bias[2] + white[2] * z[i + 2]


def with_others(others, a, b, c, lane, k, count):
    """Return noise plus the processes of a lane, if any, added one after the other."""
    if others is None:
        return a, b, c
    number = len(others) // (3 * count * LANES)
    for p in range(number):
        i = 3 * (count * (number * lane + p) + k)
        a, b, c = a + others[i], b + others[i + 1], c + others[i + 2]
    return a, b, c


def nine_of(rows, i):
    """Return nine entries of a flat sequence from index i; None if rows is None."""
    if rows is None:
        return None
    return (rows[i], rows[i + 1], rows[i + 2], rows[i + 3], rows[i + 4], rows[i + 5], rows[i + 6],
            rows[i + 7], rows[i + 8])


def twelve_of(rows, i):
    """Return twelve entries of a flat sequence from index i, in threes; None if rows is None."""
    if rows is None:
        return None
    return (three_of(rows, i), three_of(rows, i + 3), three_of(rows, i + 6),
            three_of(rows, i + 9))
