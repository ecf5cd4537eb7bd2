"""Fourier coefficients of a sampled period by real arithmetic in a fixed order."""

import numpy as np

from ins_sim.core.numerics import elementary


def fourier_coefficients(samples):
    """
    Return the Fourier coefficients of a period and their harmonics.

    The signal is the sum of c_k exp(j 2 pi k t/T). The transform is the self-sorting one of
    Stockham with radix two, in additions and products of real arrays, so that its bits depend
    neither on the processor nor on a library.

    samples (n, m): n a power of two.  Return the real and imaginary parts (n, m) and the harmonics
    (n,): k = 0, 1, ..., n/2 - 1, -n/2, ..., -1.
    """
    count = len(samples)
    re, im = samples.reshape(count, 1, -1), np.zeros((count, 1, samples[0].size))
    while len(re) > 1:
        half = len(re) // 2
        s, c = elementary.sincos(np.pi / half * np.arange(half))
        s, c = s[:, None, None], c[:, None, None]
        off_re, off_im = re[:half] - re[half:], im[:half] - im[half:]
        re = np.concatenate([re[:half] + re[half:], off_re * c + off_im * s], axis=1)
        im = np.concatenate([im[:half] + im[half:], off_im * c - off_re * s], axis=1)
    harmonics = np.arange(count)
    harmonics[count // 2:] -= count
    return re.reshape(samples.shape) / count, im.reshape(samples.shape) / count, harmonics
