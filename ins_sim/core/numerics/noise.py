"""
Random numbers as pure functions of (seed, run, name) and the index of the sample.

A stream gives normal and uniform numbers by index. They are computed in blocks by a counter-based
generator (Philox; Salmon et al., SC11, 2011), so the numbers of a sample do not depend on earlier
calls or other streams: blocks of any length, losses, restarts and workers change nothing.
``processes`` makes Gauss-Markov processes and random walks from them.
"""

from hashlib import blake2b

import numpy as np

from . import normals
from .compilation import run

BLOCK = 256
# Number of normal numbers that take as long in plain Python as one sample of a loop.
SAMPLE = 64
# Up to this count, numbers are computed faster one by one than with arrays.
FEW = 64
NORMAL, _UNIFORM = np.uint64(0), np.uint64(1)
# Name of the generator in the manifest of a run; it changes whenever the numbers change.
NOISE = 'philox4x64-10 box-muller, version 2'


def indexed_noise(seed, run, name, width=None, block=BLOCK):
    """
    Return the IndexedNoise of a name; streams of other names, runs or seeds are independent.

    For the parameters see `IndexedNoise`.
    """
    return IndexedNoise(seed, run, name, width, block)


class IndexedNoise:
    """
    Standard normal and uniform numbers by sample index.

    Parameters
    ----------
    seed, run, name : identify the stream
    width : count of numbers per sample, returned as a list; None for a single float
    block : number of samples computed together; the numbers depend on it, so each name must always
        be used with the same width and block
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
        """Return the standard normal number of a sample, or the list of them."""
        block, row = divmod(index, self._block)
        if block != self._normals_of:
            self._normals = self.normal_block(block).tolist()
            self._normals_of = block
        return self._normals[row]

    def uniform(self, index):
        """Return the uniform number in [0, 1) of a sample, or the list of them."""
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
        """Return the normals of consecutive blocks from first on, (n,) or (n, width)."""
        check_block(first)
        whole = whole_counters(self._count)
        made = np.empty((blocks, whole))
        run(normals.fill, made.size // SAMPLE, (self.key[0], self.key[1], NORMAL, first, blocks,
                                                whole), made, self._fill)
        return made[:, :self._count].reshape(blocks * self._block, *self._shape[1:])

    def _fill(self, _, __, kind, first, blocks, count, out):
        """Do the same as ``normals.fill`` with arrays, or number by number for few numbers."""
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
        # The upper 53 bits, as NumPy uses them.
        uniforms = (words >> np.uint64(11)).astype(np.float64) * 2.0 ** -53
        return uniforms.reshape(blocks * self._block, *self._shape[1:])

    def _words(self, block, kind, count):
        """Return ``count`` random words; the lowest word of the counter counts within a block."""
        counter = self._state['state']['counter']
        counter[0], counter[1], counter[2] = 0, block, kind
        self._philox.state = self._state
        return self._philox.random_raw(count)


def key_of(seed, run_number, name):
    """Return the key of a stream, two uint64 words."""
    text = repr((int(seed), int(run_number), str(name)))
    return np.frombuffer(blake2b(text.encode(), digest_size=16).digest(), '<u8')


def whole_counters(count):
    """Return count rounded up to a multiple of four, the numbers that one counter gives."""
    return -(-count // 4) * 4


def check_block(block):
    """Raise ValueError for a block before sample 0."""
    if block < 0:
        raise ValueError(f'the sample index lies in block {block}; expected an index >= 0')


def cut(blocks_of, length, first, count):
    """
    Return the samples first to first + count - 1, cut out of blocks.

    Parameters
    ----------
    blocks_of : function (first block, number of blocks) -> samples
    length : number of samples in a block
    first, count : range of samples
    """
    block = first // length
    samples = blocks_of(block, (first + count - 1) // length + 1 - block)
    return samples[first - block * length:][:count]
