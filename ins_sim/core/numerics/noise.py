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

from . import elementary, normals
from .compilation import run

BLOCK = 256
# Processes live on the indices 0 to 2**LEVELS: 600 days at 20 kHz.
LEVELS = 40
# Of so many knots in a row the normal numbers are made at once.
KNOTS = 16
# After so many correlation times nothing is left of a process.
GONE = 700.0
_BLOCK_LEVELS = BLOCK.bit_length() - 1
# So many normal numbers in plain Python take as long as one sample of a loop.
SAMPLE = 64
# So many numbers are made faster by floats than by arrays.
FEW = 64
_NORMAL, _UNIFORM = np.uint64(0), np.uint64(1)
# The generator of the normal numbers, named in the manifest of a run: other numbers, other name.
NOISE = 'philox4x64-10 box-muller, version 2'


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
        self.key = key_of(seed, run, name)
        self._philox = np.random.Philox(key=self.key)
        self._state = self._philox.state
        self._shape = (block,) if width is None else (block, width)
        self._block = block
        self._count = block * (width or 1)
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
        return cut(self.normal_blocks, self._block, first, count)

    def uniforms(self, first, count):
        """Return the uniforms of the samples first to first + count - 1, (count, ...)."""
        return cut(self._uniform_blocks, self._block, first, count)

    def normal_block(self, block):
        """Return the normals of one block, (block,) or (block, width)."""
        return self.normal_blocks(block, 1)

    def normal_blocks(self, first, blocks):
        """Return the normals of blocks from first, (blocks * block,) or with width columns."""
        _check(first)
        # the words of a counter make four numbers
        whole = -(-self._count // 4) * 4
        made = np.empty((blocks, whole))
        run(normals.fill, made.size // SAMPLE, (self.key[0], self.key[1], _NORMAL, first, blocks,
                                                whole), made, self._fill)
        return made[:, :self._count].reshape(blocks * self._block, *self._shape[1:])

    def _fill(self, _, __, kind, first, blocks, count, out):
        """Write what ``normals.fill`` writes, by operations on arrays, or on a few floats."""
        words = np.stack([self._words(first + b, int(kind), count) for b in range(blocks)])
        if out.size <= FEW:
            out[:] = np.reshape(normals.of_word_list(words.ravel().tolist()), out.shape)
        else:
            out[:] = normals.of_words(words)

    def uniform_block(self, block):
        """Return the uniforms of one block, (block,) or (block, width)."""
        return self._uniform_blocks(block, 1)

    def _uniform_blocks(self, first, blocks):
        _check(first)
        words = np.concatenate([self._words(first + b, int(_UNIFORM), self._count)
                                for b in range(blocks)])
        # the upper 53 bits, as NumPy does
        uniforms = (words >> np.uint64(11)).astype(np.float64) * 2.0 ** -53
        return uniforms.reshape(blocks * self._block, *self._shape[1:])

    def _words(self, block, kind, count):
        """Return count words; the low word of the counter counts inside the block."""
        counter = self._state['state']['counter']
        counter[0], counter[1], counter[2] = 0, block, kind
        self._philox.state = self._state
        return self._philox.random_raw(count)


def key_of(seed, run_number, name):
    """Return the key of a stream, two words uint64."""
    text = repr((int(seed), int(run_number), str(name)))
    return np.frombuffer(blake2b(text.encode(), digest_size=16).digest(), '<u8')


def _check(block):
    if block < 0:
        raise ValueError(f'the sample index lies in block {block}; expected an index >= 0')


def cut(blocks_of, length, first, count):
    """
    Return the samples first to first + count - 1 out of blocks.

    blocks_of: function (first block, blocks) -> samples; length: samples of a block.
    """
    block = first // length
    samples = blocks_of(block, (first + count - 1) // length + 1 - block)
    return samples[first - block * length:][:count]


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
        kept = np.array([_kept(span, t) for t in time_s.tolist()])
        last = np.where(walk, sigma * math.sqrt(span),
                        sigma * np.sqrt(1.0 - kept * kept)) * ends[1] + kept * first

        @lru_cache(maxsize=4)
        def numbers(group):
            """Return the normal numbers of so many knots in a row."""
            return knots.normal_blocks(group * KNOTS, KNOTS)

        @lru_cache(maxsize=256)
        def knot(b):
            """Return the values (m,) at sample b * BLOCK."""
            if b == 0 or b == 1 << (LEVELS - _BLOCK_LEVELS):
                return last if b else first
            d = b & -b
            level = d.bit_length() - 1 + _BLOCK_LEVELS
            return (self._c[level] * (knot(b - d) + knot(b + d))
                    + self._s[level] * (numbers(b // KNOTS)[b % KNOTS] if b % KNOTS
                                        else knots.normal_block(b)[0]))

        self._knot = knot

    def block(self, b):
        """Return the values at the samples b * BLOCK to b * BLOCK + BLOCK - 1, (BLOCK, m)."""
        return self.blocks(b, 1)

    def blocks(self, first, count):
        """Return the values of blocks from first, (count * BLOCK, m)."""
        width = self._c.shape[1]
        ends = np.stack([self._knot(b) for b in range(first, first + count + 1)])
        found = np.empty((count * BLOCK, width))
        run(bisect, len(found), (self._c, self._s, ends, self._inner.normal_blocks(first, count),
                                 count, width), found, bisect_arrays)
        return found

    def values(self, first, count):
        """Return the values at the samples first to first + count - 1, (count, m)."""
        return cut(self.blocks, BLOCK, first, count)


def bisect(c, s, ends, numbers, count, width, out):
    """
    Write the values of Processes between knots, rows of width.

    c, s: of each level, rows of width; ends: rows of the knots at the starts of count blocks and
    behind the last; numbers: of each sample a row of normal numbers.
    """
    for b in range(count):
        begin, knot = b * BLOCK * width, b * width
        for m in range(width):
            out[begin + m] = ends[knot + m]
        for step in range(_BLOCK_LEVELS):
            level = _BLOCK_LEVELS - 1 - step
            d = 1 << level
            for k in range(d, BLOCK, 2 * d):
                i, off = begin + k * width, d * width
                for m in range(width):
                    right = ends[knot + width + m] if k + d == BLOCK else out[i + off + m]
                    out[i + m] = (c[level * width + m] * (out[i - off + m] + right)
                                  + s[level * width + m] * numbers[i + m])


def bisect_arrays(c, s, ends, numbers, count, width, out):
    """Write what ``bisect`` writes, by operations on arrays."""
    numbers = numbers.reshape(count, BLOCK, width)
    x = np.empty((count, BLOCK + 1, width))
    x[:, 0], x[:, BLOCK] = ends[:-1], ends[1:]
    for level in range(_BLOCK_LEVELS - 1, -1, -1):
        d = 1 << level
        x[:, d::2 * d] = (c[level] * (x[:, 0:BLOCK:2 * d] + x[:, 2 * d::2 * d])
                          + s[level] * numbers[:, d::2 * d])
    out[:] = x[:, :BLOCK].reshape(count * BLOCK, width)


def _weight(h, time_s):
    """Return c of a half interval h, s; of a random walk exactly 1/2."""
    if math.isinf(time_s):
        return 0.5
    kept = _kept(h, time_s)
    return kept / (1.0 + kept * kept)


def _kept(h, time_s):
    """Return what is left of a process after h, s: exp(-h / T)."""
    return elementary.exp(-h / time_s) if h < GONE * time_s else 0.0


def _spread(h, sigma, time_s):
    """Return s of a half interval h, s."""
    if math.isinf(time_s):
        return sigma * math.sqrt(0.5 * h)
    return sigma * math.sqrt(elementary.tanh(h / time_s))
