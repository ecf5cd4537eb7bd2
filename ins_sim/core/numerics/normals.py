"""
Standard normal numbers of a counter-based generator, with the same bits on every machine.

The random words are those of Philox4x64-10 (Salmon et al., "Parallel Random Numbers: As Easy as 1,
2, 3", SC11, 2011), the same as numpy.random.Philox gives. Words 2 j and 2 j + 1 of a block give
the normal numbers 2 j and 2 j + 1 (Box and Muller 1958), by the elementary functions of this
package. Array operations take the words from NumPy; compiled loops compute them.
"""

import numpy as np

from . import elementary

# 2^-52, which maps the upper 52 bits of a word to [0, 1).
UNIT = 2.220446049250313e-16
U64 = np.uint64
S12, S32, S52, M32 = U64(12), U64(32), U64(52), U64(0xFFFFFFFF)
# Bits of a float: mask of the mantissa, and the exponents of 1 and of 1/2.
MANTISSA, ONE, HALF = U64(0xFFFFFFFFFFFFF), U64(0x3FF0000000000000), U64(0x3FE0000000000000)
# Multipliers of the two products of a round, whole and in halves, and the increments of the key.
A0, A1 = U64(0xD2E7470EE14C6C93), U64(0xCA5A826395121157)
A0_LOW, A0_HIGH = U64(0xE14C6C93), U64(0xD2E7470E)
A1_LOW, A1_HIGH = U64(0x95121157), U64(0xCA5A8263)
K0, K1 = U64(0x9E3779B97F4A7C15), U64(0xBB67AE8584CAA73B)
ZERO = U64(0)
ROUNDS = 10


def normal_pair(radius, angle):
    """
    Return two independent normal numbers from two uniform ones, floats or arrays (Box-Muller).

    Parameters
    ----------
    radius : in [0, 1); gives r = sqrt(-2 ln(1 - radius))
    angle : in [0, 1), a fraction of a turn
    """
    r = elementary.sqrt(-2.0 * elementary.log(1.0 - radius))
    s, c = elementary.sincos_of_quarters(4.0 * angle)
    return r * c, r * s


def of_words(words):
    """Return the normal numbers (..., n) from words (..., n) uint64, n even."""
    uniform = (words >> S12).astype(np.float64) * UNIT
    normals = np.empty(words.shape)
    normals[..., 0::2], normals[..., 1::2] = normal_pair(uniform[..., 0::2], uniform[..., 1::2])
    return normals


def of_word_list(words):
    """Return a list of normal numbers from a list of words (integers) of even length."""
    found = []
    for radius, angle in zip(words[0::2], words[1::2]):
        found.extend(normal_pair((radius >> 12) * UNIT, (angle >> 12) * UNIT))
    return found


def upper_half(a, low, high):
    """Return the upper 64 bits of the product of a word and a multiplier given in two halves."""
    a_low, a_high = a & M32, a >> S32
    t = a_high * low + ((a_low * low) >> S32)
    return a_high * high + (t >> S32) + ((a_low * high + (t & M32)) >> S32)


def philox(c0, c1, c2, k0, k1):
    """Return the four words for a counter (fourth word zero) and a key; all are uint64."""
    c3 = ZERO
    for _ in range(ROUNDS):
        h0, h1 = upper_half(c0, A0_LOW, A0_HIGH), upper_half(c2, A1_LOW, A1_HIGH)
        c0, c1, c2, c3 = h1 ^ c1 ^ k0, c2 * A1, h0 ^ c3 ^ k1, c0 * A0
        k0, k1 = k0 + K0, k1 + K1
    return c0, c1, c2, c3


def fill(k0, k1, kind, first, blocks, count, out):
    """
    Write the normal numbers of consecutive blocks into out.

    For compiled code only, because it reads and writes the bits of floats; ``of_words`` does the
    same with array operations. Each pass is short, so that the compiler can vectorise it.

    Parameters
    ----------
    k0, k1 : key
    kind : third word of the counter
    first, blocks : first block and number of blocks
    count : numbers per block, a multiple of four
    out : flat (blocks * count,)
    """
    quarter, half = count // 4, count // 2
    words, r, x, y = np.empty(count, U64), np.empty(half), np.empty(half), np.empty(half)
    uniform, r_bits, x_bits = words.view(np.float64), r.view(U64), x.view(U64)
    for b in range(blocks):
        for i in range(quarter):
            w0, w1, w2, w3 = philox(U64(i + 1), U64(first + b), kind, k0, k1)
            words[i], words[quarter + i] = w0, w2
            words[half + i], words[half + quarter + i] = w1, w3
        for i in range(count):
            # A float from 1 to 2.
            words[i] = (words[i] >> S12) | ONE
        for i in range(half):
            r[i] = 2.0 - uniform[i]
        for i in range(half):
            x_bits[i] = (r_bits[i] & MANTISSA) | HALF
            y[i] = float(np.int64(r_bits[i] >> S52)) - 1022.0
        for i in range(half):
            r[i] = elementary.sqrt(-2.0 * elementary.log_of_parts(x[i], y[i]))
        for i in range(half):
            s, c = elementary.sincos_of_quarters(4.0 * (uniform[half + i] - 1.0))
            x[i], y[i] = r[i] * c, r[i] * s
        j = b * count
        for i in range(quarter):
            k = j + 4 * i
            out[k], out[k + 1] = x[i], y[i]
            out[k + 2], out[k + 3] = x[quarter + i], y[quarter + i]
