"""Parts of Numba that are skipped at start can still be loaded later."""

import subprocess
import sys

import pytest

CODE = '''
import sys
import numpy as np
from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics import compilation
compilation.compiled(quaternion.multiply)((0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.6, 0.8))
print('scipy.linalg' in sys.modules)
import numba
product = numba.njit(lambda a, b: np.linalg.inv(a) @ b)
print(product(np.diag([2.0, 4.0]), np.eye(2)).tolist())
print(numba.njit(lambda a, b: np.correlate(a, b))(np.ones(3), np.ones(2)).tolist())
'''


def test_linear_algebra_is_loaded_where_it_is_compiled():
    """A caller's compiled code can use the products of SciPy, although our loops skip them."""
    pytest.importorskip('numba', reason='Numba is not installed')
    run = subprocess.run([sys.executable, '-c', CODE], capture_output=True, text=True, check=True)
    assert run.stdout.split('\n')[:3] == ['False', '[[0.5, 0.0], [0.0, 0.25]]', '[2.0, 2.0]']
