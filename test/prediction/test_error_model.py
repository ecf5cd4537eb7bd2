"""The loop of the error model has the same bits in single steps, plain loops, compiled loops."""

import numpy as np
import pytest

from ins_sim.core.numerics import compilation
from ins_sim.core.prediction import error_model

COUNT = 500
START = (0.0, 0.0, 0.0, 10.0, -20.0, 0.1, 0.2)
STEP_S = 0.1


def coefficients():
    """Return random means over the steps: omega_in, f_n, force, turn (n, 3) and pull (n, 2)."""
    rng = np.random.default_rng(7)
    scales = (7e-5, 3, 1.0), (10.0, 3, 0.0), (1e-4, 3, 0.0), (1e-9, 3, 0.0), (1.5e-6, 2, 1.0)
    return [scale * (shift + rng.normal(size=(COUNT, width))) for scale, width, shift in scales]


def through(run, cuts=()):
    """Return the states (n, 7) of the loop run in blocks."""
    columns, states = coefficients(), np.empty((COUNT, 7))
    state, ends = START, [*cuts, COUNT]
    for first, stop in zip([0, *cuts], ends):
        state = run(error_model.advance_through, stop - first, (
            state, STEP_S, stop - first, *(c[first:stop] for c in columns)), states[first:stop])
    return states


@pytest.fixture
def by_steps():
    """Return the states from single steps."""
    state, states = START, []
    for row in zip(*(c.tolist() for c in coefficients())):
        omega_in, f_n, force, turn, pull = map(tuple, row)
        state = error_model.advance_errors(state, omega_in, f_n, force[:2], turn, pull, STEP_S)
        states.append(state)
    return np.array(states)


@pytest.mark.parametrize('cuts', [(), (1, 2, 77, 400)])
def test_a_plain_loop_is_its_steps(by_steps, cuts, monkeypatch):
    """Blocks of any length equal single steps, in plain Python."""
    monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', float('inf'))
    np.testing.assert_array_equal(through(compilation.run, cuts), by_steps)


@pytest.mark.parametrize('cuts', [(), (1, 2, 77, 400)])
def test_a_compiled_loop_is_its_steps(by_steps, cuts, monkeypatch):
    """Blocks of any length equal single steps, compiled."""
    pytest.importorskip('numba', reason='Numba is not installed')
    monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', -1)
    assert compilation.compiled(error_model.advance_through) is not None
    np.testing.assert_array_equal(through(compilation.run, cuts), by_steps)
