"""Normal numbers from Philox words: the words of NumPy, equal bits, right distribution."""

import math

from ins_sim.core.numerics import compilation, normals
from ins_sim.core.numerics.noise import indexed_noise, key_of
import numpy as np
import pytest
from scipy import stats

KEY = key_of(12, 3, 'gyro.white')


def words(block, count, kind=0):
    return np.random.Philox(key=KEY, counter=[0, block, kind, 0]).random_raw(count)


def test_arrays_and_floats_have_the_same_bits():
    """Normal numbers made from arrays and from floats have the same bits."""
    drawn = words(5, 400)
    assert normals.of_words(drawn).tolist() == normals.of_word_list(drawn.tolist())


@pytest.mark.parametrize('count', [4, 12, 768])
def test_compiled_numbers_have_the_bits_of_those_of_numpy(count):
    """Compiled code computes the words itself and gives the bits of those from NumPy."""
    fast = compilation.compiled(normals.fill)
    if fast is None:
        pytest.skip('Numba is not installed')
    out = np.empty((3, count))
    fast(KEY[0], KEY[1], np.uint64(0), 2 ** 31 - 1, 3, count, out.reshape(-1))
    for row, block in zip(out, range(2 ** 31 - 1, 2 ** 31 + 2)):
        assert row.tolist() == normals.of_words(words(block, count)).tolist()


def test_one_counter_makes_the_words_of_numpy():
    """Philox in plain Python gives the words of NumPy, also where the counter wraps around."""
    with np.errstate(over='ignore'):
        found = normals.philox(normals.U64(7), normals.U64(11), normals.U64(1), *KEY)
    assert [int(w) for w in found] == words(11, 28, kind=1)[24:].tolist()


def test_the_numbers_are_normal():
    """1.2 million numbers pass Kolmogorov-Smirnov at 1e-6; moments and tails are in 5 sigma."""
    z = indexed_noise(1, 0, 'x', 3).normals(0, 400_000).ravel()
    n, tail = len(z), 2.0 * stats.norm.sf(4.0)
    figures = stats.kstest(z, 'norm').pvalue, stats.skew(z), stats.kurtosis(z), np.sum(abs(z) > 4)
    print('\np {:.2f}, skew {:.1e}, excess kurtosis {:.1e}, {} beyond 4 sigma'.format(*figures),
          f'({n * tail:.0f} expected)')
    p, skew, excess, beyond = figures
    assert p > 1e-6 and abs(z.mean()) < 5.0 / math.sqrt(n)
    assert abs(skew) < 5.0 * math.sqrt(6.0 / n) and abs(excess) < 5.0 * math.sqrt(24.0 / n)
    assert abs(beyond - n * tail) < 5.0 * math.sqrt(n * tail)


def test_the_ends_of_the_uniform_numbers_are_finite():
    """The smallest and the largest word give finite normal numbers."""
    ends = np.array([0, 0, 2 ** 64 - 1, 2 ** 64 - 1], dtype=np.uint64)
    found = normals.of_words(ends)
    assert np.isfinite(found).all() and found[:2].tolist() == [0.0, 0.0]
    # The largest radius: 1 - u is 2^-52.
    assert math.hypot(*found[2:]) == pytest.approx(math.sqrt(2.0 * 52.0 * math.log(2.0)))
