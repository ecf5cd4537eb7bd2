"""
Gauss-Markov processes and random walks as functions of the sample index.

They are built from the numbers of ``noise`` by bisection, so a value depends on its index alone.
"""

from functools import lru_cache
import math

import numpy as np

from . import elementary, normals
from .compilation import run
from .noise import BLOCK, check_block, cut, IndexedNoise, NORMAL, whole_counters

# Processes are defined on the indices 0 to 2**LEVELS: 600 days at 20 kHz.
LEVELS = 40
# After this many correlation times the correlation is zero.
GONE = 700.0
# Number of knots computed together; there is one knot per block.
KNOTS = 16
_BLOCK_LEVELS = BLOCK.bit_length() - 1


class Processes:
    """
    Gauss-Markov processes and random walks, one per column, as functions of the sample index.

    A recursion would need every earlier sample. Instead bisection is used (Levy's construction of
    Brownian motion): x_0 and x_N, N = 2**LEVELS, are drawn. Then, with d the lowest set bit of k,
    h = d dt and n_k the normal number of index k,

        x_k = c_d (x_{k-d} + x_{k+d}) + s_d n_k

    Gauss-Markov: c_d = 1/(2 cosh(h/T)), s_d = sigma sqrt(tanh(h/T)); random walk: c_d = 1/2,
    s_d = sigma sqrt(h/2). The joint distribution of all samples is exact.

    Parameters
    ----------
    seed, run, name : identify the stream
    sigma : (m,) standard deviation of a stationary process; of a random walk after one second
    time_s : (m,) correlation time, s; infinite for a random walk, which is 0 at index 0
    dt_s : sampling period, s
    """

    def __init__(self, seed, run, name, sigma, time_s, dt_s):
        sigma, time_s = np.asarray(sigma, dtype=float), np.asarray(time_s, dtype=float)
        half = np.ldexp(dt_s, np.arange(LEVELS))[:, np.newaxis]
        kept = _kept(half, time_s)
        self._c, self._s = kept / (1.0 + kept * kept), _spread(half, sigma, time_s)
        width = len(sigma)
        self._inner = IndexedNoise(seed, run, name, width)
        # The knots, every 256th sample, are needed out of order: one sample per block.
        knots = IndexedNoise(seed, run, f'{name}.knots', width, 1)
        ends = knots.normal_block(0)[0], knots.normal_block(1 << (LEVELS - _BLOCK_LEVELS))[0]
        walk = np.isinf(time_s)
        span = math.ldexp(dt_s, LEVELS)
        first = np.where(walk, 0.0, sigma * ends[0])
        kept = _kept(span, time_s)
        last = np.where(walk, sigma * math.sqrt(span),
                        sigma * np.sqrt(1.0 - kept * kept)) * ends[1] + kept * first

        @lru_cache(maxsize=256)
        def far(b):
            """Return the values (m,) at sample b * BLOCK, b a multiple of KNOTS."""
            if b == 0 or b == 1 << (LEVELS - _BLOCK_LEVELS):
                return last if b else first
            d = b & -b
            level = d.bit_length() - 1 + _BLOCK_LEVELS
            return (self._c[level] * (far(b - d) + far(b + d))
                    + self._s[level] * knots.normal_block(b)[0])

        @lru_cache(maxsize=4)
        def row(b):
            """Return the values (KNOTS, m) of the knots from b on, b a multiple of KNOTS."""
            return between(self._c[_BLOCK_LEVELS:], self._s[_BLOCK_LEVELS:],
                           np.stack([far(b), far(b + KNOTS)]),
                           knots.normal_blocks(b, KNOTS)[np.newaxis])[0]

        self._far, self._row = far, row

    def _ends(self, first, count):
        """Return the values (count + 1, m) at the starts of the blocks and after the last one."""
        def rows(group, groups):
            return np.concatenate([self._row(KNOTS * k) for k in range(group, group + groups)])

        b = first + count
        behind = self._row(b - b % KNOTS)[b % KNOTS] if b % KNOTS else self._far(b)
        return np.concatenate([cut(rows, KNOTS, first, count), behind[np.newaxis]])

    def block(self, b):
        """Return the values at the samples b * BLOCK to b * BLOCK + BLOCK - 1, (BLOCK, m)."""
        return self.blocks(b, 1)

    def blocks(self, first, count):
        """Return the values of ``count`` blocks from first on, (count * BLOCK, m)."""
        return self.sums(first, count, self._c.shape[1])

    def sums(self, first, count, every):
        """
        Return sums of processes over ``count`` blocks from first on, (count * BLOCK, every).

        Column k is the sum of the processes k, k + every, k + 2 every and so on, in that order.
        """
        check_block(first)
        found = np.empty((count * BLOCK, every))
        key = self._inner.key
        run(bisect, len(found), (self._c, self._s, self._ends(first, count), key[0], key[1], first,
                                 count, self._c.shape[1], every), found, self._bisect_arrays)
        return found

    def _bisect_arrays(self, c, s, ends, _, __, first, count, width, every, out):
        """Do the same as ``bisect`` with array operations."""
        numbers = self._inner.normal_blocks(first, count).reshape(count, BLOCK, width)
        values = between(c, s, ends, numbers).reshape(count * BLOCK, width)
        total = values[:, 0:every]
        for k in range(every, width, every):
            total = total + values[:, k:k + every]
        out[:] = total

    def values(self, first, count):
        """Return the values at the samples first to first + count - 1, (count, m)."""
        return cut(self.blocks, BLOCK, first, count)


def bisect(c, s, ends, k0, k1, first, count, width, every, out):
    """
    Write sums of processes between knots into out; for compiled code only, see ``normals.fill``.

    Parameters
    ----------
    c, s : flat coefficients of each level, ``width`` per level
    ends : flat values of the knots at the starts of the blocks and after the last one
    k0, k1 : key of the normal numbers
    first, count : first block and number of blocks
    width : number of processes
    every : number of columns of the sums, see ``Processes.sums``
    out : flat (count * BLOCK * every,)
    """
    size = BLOCK * width
    z, x = np.empty(whole_counters(size)), np.empty(size + width)
    for b in range(count):
        normals.fill(k0, k1, NORMAL, first + b, 1, len(z), z)
        knots = ends[b * width:]
        for m in range(width):
            x[m], x[size + m] = knots[m], knots[width + m]
        for step in range(_BLOCK_LEVELS):
            level = _BLOCK_LEVELS - 1 - step
            weight, spread = c[level * width:], s[level * width:]
            d = width << level
            for k in range(d, size, 2 * d):
                left, at, right, own = x[k - d:], x[k:], x[k + d:], z[k:]
                for m in range(width):
                    at[m] = weight[m] * (left[m] + right[m]) + spread[m] * own[m]
        for k in range(BLOCK):
            row, sums = x[k * width:], out[(b * BLOCK + k) * every:]
            for m in range(every):
                total = row[m]
                for j in range(m + every, width, every):
                    total = total + row[j]
                sums[m] = total


def between(c, s, ends, numbers):
    """
    Return the values at knots and between them, (count, length, m), by bisection.

    Parameters
    ----------
    c, s : coefficients of each level, beginning with the level of neighbouring samples
    ends : (count + 1, m) values at the knots
    numbers : (count, length, m) normal numbers; length must be a power of two
    """
    count, length, width = numbers.shape
    x = np.empty((count, length + 1, width))
    x[:, 0], x[:, length] = ends[:-1], ends[1:]
    for level in range(length.bit_length() - 2, -1, -1):
        d = 1 << level
        x[:, d::2 * d] = (c[level] * (x[:, 0:length:2 * d] + x[:, 2 * d::2 * d])
                          + s[level] * numbers[:, d::2 * d])
    return x[:, :length]


def _kept(h, time_s):
    """Return the correlation over h seconds: exp(-h / T), 1 for random walks."""
    return np.where(h < GONE * time_s, elementary.exp(-np.minimum(h / time_s, GONE)), 0.0)


def _spread(h, sigma, time_s):
    """Return the coefficient s for half intervals of h seconds."""
    return sigma * np.sqrt(np.where(np.isinf(time_s), 0.5 * h, elementary.tanh(h / time_s)))
