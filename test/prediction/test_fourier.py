"""The Fourier coefficients computed with real arithmetic agree with those of NumPy."""

import numpy as np
import pytest

from ins_sim.core.prediction.fourier import fourier_coefficients


@pytest.mark.parametrize('count', [2, 4, 64, 4096])
def test_coefficients_are_those_of_numpy(count):
    """Coefficients agree with numpy.fft within rounding, with harmonics in the same order."""
    samples = np.random.default_rng(count).normal(size=(count, 3))
    real, imaginary, harmonics = fourier_coefficients(samples)
    expected = np.fft.fft(samples, axis=0) / count
    np.testing.assert_allclose(real + 1j * imaginary, expected, rtol=0.0, atol=1e-15)
    np.testing.assert_array_equal(harmonics, np.fft.fftfreq(count, 1.0 / count))
