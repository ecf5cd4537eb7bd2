"""
Random numbers as pure functions of (seed, run, name) and the sample's index.

A stream holds normals and uniforms by index, in blocks of a counter-based generator (Philox;
Salmon et al., SC11, 2011), so that the number of a sample does not depend on what was asked
before: not on cutting, loss, restart, worker, nor on other streams.  ``Processes`` makes
Gauss-Markov processes and random walks of a stream in the same way: a value depends on its index
alone.
"""

from functools import lru_cache
from hashlib import blake2b
import math

import numpy as np

BLOCK = 256
# Processes live on the indices 0 to 2**LEVELS: 600 days at 20 kHz.
LEVELS = 40
_BLOCK_LEVELS = BLOCK.bit_length() - 1
_NORMAL, _UNIFORM = 0, 1


def indexed_noise(seed, run, name, width=None, block=BLOCK):
    """Return the Stream of that name; different names, runs and seeds are independent."""
    return IndexedNoise(seed, run, name, width, block)


class IndexedNoise:
    """
    Standard normals and uniforms by sample index.

    width: how many numbers a sample has: None for one float, else a list of that length.  block:
    samples computed at once; numbers depend on it, so one name has one width and one block.
    """

    def __init__(self, seed, run, name, width=None, block=BLOCK):
        digest = blake2b(repr((int(seed), int(run), str(name))).encode(), digest_size=16).digest()
        self._philox = np.random.Philox(key=np.frombuffer(digest, '<u8'))
        self._state = self._philox.state
        self._generator = np.random.Generator(self._philox)
        self._shape = block if width is None else (block, width)
        self._block = block
        self._normals_of = self._uniforms_of = None
        self._normals = self._uniforms = ()

    def normal(self, index):
        """Return the standard normal number, or the list of them, of a sample."""
        block, row = divmod(index, self._block)
        if block != self._normals_of:
            self._normals = self.normal_block(block).tolist()
            self._normals_of = block
        return self._normals[row]

    def uniform(self, index):
        """Return the number in [0, 1), or the list of them, of a sample."""
        block, row = divmod(index, self._block)
        if block != self._uniforms_of:
            self._uniforms = self.uniform_block(block).tolist()
            self._uniforms_of = block
        return self._uniforms[row]

    def normals(self, first, count):
        """Return the normals of the samples first to first + count - 1, (count, ...)."""
        return _cut(self.normal_block, self._block, first, count)

    def uniforms(self, first, count):
        """Return the uniforms of the samples first to first + count - 1, (count, ...)."""
        return _cut(self.uniform_block, self._block, first, count)

    def normal_block(self, block):
        """Return the normals of one block, (block,) or (block, width)."""
        self._seek(block, _NORMAL)
        return self._generator.standard_normal(self._shape)

    def uniform_block(self, block):
        """Return the uniforms of one block, (block,) or (block, width)."""
        self._seek(block, _UNIFORM)
        return self._generator.random(self._shape)

    def _seek(self, block, kind):
        """Go to the counter of a block; its low word counts inside the block."""
        if block < 0:
            raise ValueError(f'the sample index lies in block {block}; expected an index >= 0')
        counter = self._state['state']['counter']
        counter[0], counter[1], counter[2] = 0, block, kind
        self._philox.state = self._state


def _cut(block_of, length, first, count):
    blocks = range(first // length, (first + count - 1) // length + 1)
    start = first - blocks[0] * length
    return np.concatenate([block_of(b) for b in blocks])[start:start + count]


class Processes:
    """
    Gauss-Markov processes and random walks, each a column, as functions of the sample's index.

    sigma, time_s, (m,): standard deviation and correlation time of stationary Gauss-Markov
    processes; where time_s is infinite a random walk from 0 at index 0, sigma being its standard
    deviation after one second.  dt_s: sampling period.

    Not by recursion, which would need every sample before, but by bisection (Levy's construction
    of Brownian motion): x_0 and x_N, N = 2**LEVELS, are drawn, and then with d the lowest set bit
    of k, h = d dt and n_k the normal numbers of index k,

        x_k = c_d (x_{k-d} + x_{k+d}) + s_d n_k

    Gauss-Markov: c_d = 1/(2 cosh(h/T)), s_d = sigma sqrt(tanh(h/T)); random walk: c_d = 1/2,
    s_d = sigma sqrt(h/2).  The joint distribution of all samples is the exact one.
    """

    def __init__(self, seed, run, name, sigma, time_s, dt_s):
        sigma, time_s = np.asarray(sigma, dtype=float), np.asarray(time_s, dtype=float)
        pairs = list(zip(sigma.tolist(), time_s.tolist()))
        steps = [math.ldexp(dt_s, level) for level in range(LEVELS)]
        self._c = np.array([[_weight(h, t) for _, t in pairs] for h in steps])
        self._s = np.array([[_spread(h, s, t) for s, t in pairs] for h in steps])
        width = len(pairs)
        self._inner = IndexedNoise(seed, run, name, width)
        # the knots, every 256th sample, are called for here and there: one to a block
        knots = IndexedNoise(seed, run, f'{name}.knots', width, 1)
        ends = knots.normal_block(0)[0], knots.normal_block(1 << (LEVELS - _BLOCK_LEVELS))[0]
        walk = np.isinf(time_s)
        span = math.ldexp(dt_s, LEVELS)
        first = np.where(walk, 0.0, sigma * ends[0])
        kept = np.exp(-span / time_s)
        last = np.where(walk, sigma * math.sqrt(span),
                        sigma * np.sqrt(1.0 - kept * kept)) * ends[1] + kept * first

        @lru_cache(maxsize=256)
        def knot(b):
            """Return the values (m,) at sample b * BLOCK."""
            if b == 0 or b == 1 << (LEVELS - _BLOCK_LEVELS):
                return last if b else first
            d = b & -b
            level = d.bit_length() - 1 + _BLOCK_LEVELS
            return (self._c[level] * (knot(b - d) + knot(b + d))
                    + self._s[level] * knots.normal_block(b)[0])

        self._knot = knot

    def block(self, b):
        """Return the values at the samples b * BLOCK to b * BLOCK + BLOCK - 1, (BLOCK, m)."""
        normals = self._inner.normal_block(b)
        x = np.empty((BLOCK + 1, normals.shape[1]))
        x[0], x[BLOCK] = self._knot(b), self._knot(b + 1)
        for level in range(_BLOCK_LEVELS - 1, -1, -1):
            d = 1 << level
            x[d::2 * d] = (self._c[level] * (x[0:BLOCK:2 * d] + x[2 * d::2 * d])
                           + self._s[level] * normals[d::2 * d])
        return x[:BLOCK]

    def values(self, first, count):
        """Return the values at the samples first to first + count - 1, (count, m)."""
        return _cut(self.block, BLOCK, first, count)


def _weight(h, time_s):
    """Return c of a half interval h, s; of a random walk exactly 1/2."""
    if math.isinf(time_s):
        return 0.5
    kept = math.exp(-h / time_s)
    return kept / (1.0 + kept * kept)


def _spread(h, sigma, time_s):
    """Return s of a half interval h, s."""
    if math.isinf(time_s):
        return sigma * math.sqrt(0.5 * h)
    return sigma * math.sqrt(math.tanh(h / time_s))
