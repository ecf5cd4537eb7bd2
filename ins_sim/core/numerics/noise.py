"""
Random numbers as pure functions of (seed, run, name) and the sample's index.

A stream holds normals and uniforms by index, in blocks of a counter-based generator (Philox;
Salmon et al., SC11, 2011), so that the number of a sample does not depend on what was asked
before: not on cutting, loss, restart, worker, nor on other streams.  ``processes`` makes
Gauss-Markov processes and random walks of them.
"""

from hashlib import blake2b

import numpy as np

from . import normals
from .compilation import run

BLOCK = 256
# So many normal numbers in plain Python take as long as one sample of a loop.
SAMPLE = 64
# So many numbers are made faster by floats than by arrays.
FEW = 64
NORMAL, _UNIFORM = np.uint64(0), np.uint64(1)
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
        check_block(first)
        whole = whole_counters(self._count)
        made = np.empty((blocks, whole))
        run(normals.fill, made.size // SAMPLE, (self.key[0], self.key[1], NORMAL, first, blocks,
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
        check_block(first)
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


def whole_counters(count):
    """Return how many numbers whole counters make, four each, for so many."""
    return -(-count // 4) * 4


def check_block(block):
    """Raise ValueError for a block of samples before the first."""
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
