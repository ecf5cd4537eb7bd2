"""Compiled copies of plain functions, and the messages if they cannot be made."""

import logging
import os
import subprocess
import sys

from ins_sim.core.attitude import quaternion
from ins_sim.core.navigation import increments, mechanization
from ins_sim.core.numerics import compilation, compile_cache
import numpy as np
import pytest

RNG = np.random.default_rng(3)


@pytest.fixture
def numba():
    found = compilation.numba()
    if found is None:
        pytest.skip('Numba is not installed')
    return found


def python(script, **environment):
    """Return the standard error and output of a new Python process."""
    done = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True,
                          env={**os.environ, **environment}, check=False)
    assert done.returncode == 0, done.stderr
    return done.stderr, done.stdout


HIDDEN = "import sys; sys.modules['numba'] = None\n"
RUN = '''
import numpy as np
from ins_sim.core.numerics import compilation
from ins_sim.core.attitude import quaternion
for k in range(2):
    f = compilation.compiled(quaternion.exponential)
    print(f((0.1, 0.2, 0.3)) if f else None)
'''


def test_a_copy_and_what_it_calls_give_the_bits_of_the_source(numba):
    """A compiled copy, with the functions it calls, has the bits of plain Python."""
    fast = compilation.compiled(increments.two_sample_increments)
    for _ in range(200):
        vectors = [tuple(v) for v in (RNG.normal(size=(4, 3)) * 0.1).tolist()]
        assert fast(*vectors) == increments.two_sample_increments(*vectors)


def test_the_source_stays_plain(numba):
    """Compiling leaves the function itself in plain Python and makes one copy only."""
    compilation.compiled(quaternion.multiply)
    assert type(quaternion.multiply).__name__ == 'function'
    assert compilation.compiled(quaternion.multiply) is compilation.compiled(quaternion.multiply)


def test_without_numba_it_is_said_once():
    """Without Numba one message names the extra to install, and plain Python is used."""
    said, printed = python(HIDDEN + RUN)
    assert printed.split() == ['None', 'None']
    assert said.count('Numba') == 1 and "pip install 'ins_sim[fast]'" in said


def test_a_numba_of_another_version_is_said_once(tmp_path):
    """A Numba that cannot be imported gives one message with its cause."""
    (tmp_path / 'numba').mkdir()
    (tmp_path / 'numba' / '__init__.py').write_text(
        "raise ImportError('Numba needs NumPy 1.9 or less')\n")
    said, printed = python(RUN, PYTHONPATH=os.pathsep.join(
        filter(None, (str(tmp_path), os.environ.get('PYTHONPATH')))))
    assert printed.split() == ['None', 'None']
    assert said.count('Numba cannot be used here') == 1 and 'NumPy 1.9' in said


def test_compiling_is_said_and_kept(numba, tmp_path):
    """Compiling is logged once; the next process uses the cache without a message."""
    said, first = python(RUN, XDG_CACHE_HOME=str(tmp_path))
    assert said.count('compiling exponential') == 1
    assert any(path.suffix == '.nbc' for path in tmp_path.rglob('*'))
    said, second = python(RUN, XDG_CACHE_HOME=str(tmp_path))
    assert said == '' and second == first


@pytest.mark.skipif(os.geteuid() == 0, reason='root may write everywhere')
def test_a_cache_folder_that_cannot_be_written(numba, tmp_path):
    """If the cache folder is read-only, one message states it and functions are compiled."""
    tmp_path.chmod(0o500)
    said, printed = python(RUN, XDG_CACHE_HOME=str(tmp_path), HOME=str(tmp_path))
    assert 'no cache folder can be written' in said and 'None' not in printed


def test_a_cache_folder_that_is_a_file(numba, tmp_path):
    """If the cache folder is a file, one message states it and functions are compiled."""
    file = tmp_path / 'file'
    file.write_text('')
    said, printed = python(RUN, XDG_CACHE_HOME=str(file), HOME=str(file))
    assert said.count('no cache folder can be written') == 1 and 'None' not in printed


def test_another_source_has_another_folder(numba, tmp_path, monkeypatch):
    """A changed constant changes the digest, and with it the cache folder."""
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    digests = []
    for value in (1.0, 2.0):
        monkeypatch.setattr(quaternion, 'IDENTITY', value)
        graph = compilation._Graph(numba)
        graph._copied(value, ())
        digests.append(graph._digest.hexdigest())
    assert digests[0] != digests[1]
    assert compile_cache.cache_folder(digests[0]).parent == tmp_path / 'ins_sim'


def fill(first, values, out):
    """Compute cumulative sums: out[k] = first + values[0] + ... + values[k]."""
    for k in range(len(values)):
        first = first + values[k]
        out[k] = first
    return first


def test_a_loop_has_the_same_bits_compiled_and_plain(numba, monkeypatch):
    """``run`` gives equal bits in plain Python and compiled."""
    monkeypatch.setattr(fill, '__module__', mechanization.__name__)
    values = RNG.normal(size=100)
    found = {}
    for most in (10 ** 9, 0):
        monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', most)
        out = np.empty(100)
        found[most] = compilation.run(fill, 100, (0.5, values), out), out.tolist()
    assert found[0] == found[10 ** 9]


def test_what_numba_cannot_compile_runs_plainly(numba, monkeypatch, caplog):
    """A loop that Numba cannot compile runs in plain Python, with one warning."""
    def loop(values, out):
        out[0] = sum(v for v in values)

    monkeypatch.setattr(loop, '__module__', mechanization.__name__)
    monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', 0)
    out = np.empty(1)
    with caplog.at_level(logging.WARNING, 'ins_sim'):
        for _ in range(2):
            compilation.run(loop, 1, (np.array([0.25]),), out)
    assert out[0] == 0.25
    assert sum('cannot be used' in r.getMessage() for r in caplog.records) == 1
