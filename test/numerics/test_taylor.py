"""Taylor series compared with closed forms."""

import numpy as np

from ins_sim.core.numerics import taylor


def test_taylor_series_against_closed_forms():
    """Derivatives of a composed function up to third order equal the closed forms."""
    t = np.array([0.3, -1.2, 2.5])
    x = taylor.Series.time(t, 3)
    s = taylor.sin(x * 2.0) * taylor.tanh(x) / taylor.sqrt(x * x + 1.0)
    h = 1e-3

    def f(t):
        return np.sin(2 * t) * np.tanh(t) / np.sqrt(t * t + 1)

    np.testing.assert_allclose(s.value, f(t), rtol=1e-15)
    np.testing.assert_allclose(s.derivative().value,
                               (f(t - 2 * h) - 8 * f(t - h) + 8 * f(t + h) - f(t + 2 * h))
                               / (12 * h), rtol=1e-9)
    np.testing.assert_allclose(s.derivative().derivative().value,
                               (f(t + h) - 2 * f(t) + f(t - h)) / h ** 2, rtol=1e-4)
    angle = taylor.atan2(taylor.sin(x), taylor.sincos(x)[1])
    np.testing.assert_allclose(angle.derivative().c, [[1.0] * 3, [0.0] * 3, [0.0] * 3], atol=1e-14)
    soft = taylor.log_cosh(x * 1000.0)
    np.testing.assert_allclose(soft.value, np.abs(1000 * t) - np.log(2), rtol=1e-12)
