"""The loop over runs computed side by side is compiled to vector instructions."""

import re

from ins_sim.core.earth.ellipsoid import GRAVITY_TERMS
from ins_sim.core.ensemble import lanes
from ins_sim.core.numerics import compilation
import numpy as np
import pytest

pytestmark = pytest.mark.skipif(compilation.numba() is None, reason='Numba is not installed')
# Patterns for x86-64 and aarch64.
PACKED = r'\bv?(?:mul|add|sub)pd\b|\bf(?:mul|add|sub)\s+v\d+\.2d'
SINGLE = r'\bv?(?:mul|add|sub)sd\b|\bf(?:mul|add|sub)\s+d\d+,'


@pytest.mark.parametrize('gravity', GRAVITY_TERMS.values(), ids=GRAVITY_TERMS)
def test_small_steps_are_packed(gravity):
    """Nearly all products and sums of a small step process several runs in one instruction."""
    jit = compilation.numba()
    steps = compilation.compiled(lanes.small_steps)
    alone = jit.njit(steps.py_func, error_model='numpy', nogil=True)
    alone(np.ones(lanes.NUMBERS * lanes.LANES), 0.01, 7e-5, 1, (0.0, 0.0, 0.0, 0.0, 0.0),
          gravity)
    text = '\n'.join(alone.inspect_asm().values())
    packed, single = len(re.findall(PACKED, text)), len(re.findall(SINGLE, text))
    assert packed > 100 and packed > 10 * single
