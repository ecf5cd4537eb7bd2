"""The extrapolation step: its order, and its exactness for polynomials."""

import math

from ins_sim.core.numerics.extrapolation import extrapolated_step
import pytest


def test_the_order_is_eight():
    """Half the step leaves 2^-9 of the error of one step of an oscillator: order eight."""
    def rates(t, y):
        return y[1], -y[0]

    errors = []
    for h in (0.8, 0.4):
        x, v = extrapolated_step(rates, 0.0, (1.0, 0.0), h)
        errors.append(math.hypot(x - math.cos(h), v + math.sin(h)))
    print(f'errors {errors[0]:.2e}, {errors[1]:.2e}')
    assert 8.0 < math.log2(errors[0] / errors[1]) < 10.0


def test_polynomials_are_integrated_exactly():
    """Polynomials up to the seventh degree are integrated exactly, to rounding."""
    x, = extrapolated_step(lambda t, y: (8.0 * t ** 7 - 3.0 * t * t,), 1.0, (2.0,), 1.5)
    assert x == pytest.approx(2.0 + 2.5 ** 8 - 1.0 - 2.5 ** 3 + 1.0, rel=1e-14)
