"""
Compiled copies of plain functions, made by Numba where it is installed.

The sources stay plain Python: ``compiled`` copies a function and every function of the package
that it calls, found through the names it uses, and compiles the copies. Fast mathematics is never
enabled, so a compiled function gives the same bits as the plain one.

Compiled code is kept in the user's cache folder. Numba alone would not notice that a function in
another file has changed, so the folder is named by a digest of everything that is compiled.
"""

from contextlib import contextmanager
from contextvars import ContextVar
import dis
from functools import lru_cache
from hashlib import blake2b
from importlib.util import find_spec
import logging
import math
import sys
from threading import RLock
from types import CodeType, FunctionType, ModuleType

import numpy as np

from . import elementary
from .compile_cache import cache_folder

LOG = logging.getLogger('ins_sim')
PACKAGE = __name__.partition('.')[0]
# {function of floats, arrays and Series: function of floats that a compiled copy calls instead}
REPLACED = {elementary.sqrt: math.sqrt, elementary.parts: math.frexp,
            elementary.as_number: elementary.float_as_number,
            elementary.times_power_of_two: elementary.float_times_power_of_two,
            elementary.sincos: elementary.general_sincos,
            elementary.atan2: elementary.general_atan2}
# A loop runs in plain Python until it has processed this many samples in this process: loading
# Numba and compiled code takes as long as that.
PLAIN_SAMPLES = 8192
# If Numba is already loaded, the threshold for one more loop is this fraction of PLAIN_SAMPLES.
PART_OF_CODE = 0.125
_taken, _broken = {}, set()
# Lock: Numba's cache folder, a setting of the whole process, is changed while a copy is made.
_copying = RLock()
_plain_only = ContextVar('plain_only', default=False)


def run(loop, count, inputs, out, plain=None):
    """
    Run a loop over count samples, compiled if that pays, and return its result.

    Parameters
    ----------
    loop : function ``(*inputs, out)`` of a module of this package
        It reads its array inputs and writes out by index, as flat sequences. Plain Python passes
        lists, the compiled copy flat views; the bits are the same.
    count : number of samples
    inputs : tuple of arrays, tuples, numbers and None
    out : C-contiguous array of float
    plain : function ``(*inputs, out)`` of whole arrays with the same bits, to be used instead of
        the loop if that is not compiled

    """
    fast = compiled_if_it_pays(loop, count)
    if fast is not None:
        return fast(*(a.ravel() if isinstance(a, np.ndarray) else a for a in inputs),
                    out.reshape(-1))
    if plain is not None:
        return plain(*inputs, out)
    rows = [0.0] * out.size
    carry = loop(*(a.ravel().tolist() if isinstance(a, np.ndarray) else a for a in inputs), rows)
    out.reshape(-1)[:] = rows
    return carry


def with_globals(loop, name, **others):
    """Return a copy of a loop with a new name, in which some functions are replaced by others."""
    copy = FunctionType(loop.__code__, {**loop.__globals__, **others}, name, loop.__defaults__)
    copy.__module__, copy.__qualname__ = loop.__module__, name
    return copy


def compiled_if_it_pays(loop, count):
    """
    Return the compiled copy of a loop that has count more samples to process, or None.

    If compilation fails later, the loop itself is called, which accepts arrays as well.
    """
    _taken[loop] = _taken.get(loop, 0) + count
    enough = PLAIN_SAMPLES * (PART_OF_CODE if 'numba' in sys.modules else 1.0)
    if _taken[loop] <= enough or _plain_only.get():
        return None
    fast = compiled(loop)
    if fast is None:
        return None

    def guarded(*inputs):
        try:
            return fast(*inputs)
        except numba().core.errors.NumbaError as error:
            _say_plain(error)
            _broken.add(loop)
            return loop(*inputs)

    return guarded


@contextmanager
def plain_only():
    """Keep ``run`` in plain Python within this context: a live node must not stop to compile."""
    token = _plain_only.set(True)
    try:
        yield
    finally:
        _plain_only.reset(token)


def compiled(function):
    """
    Return the compiled copy of a function of a module of this package, or None without Numba.

    The functions that it calls must belong to modules of this package too, and take floats, tuples
    and arrays. A copy is compiled at its first call with new types, and cached on disk.
    """
    with _copying:
        if numba() is None or function in _broken:
            return None
        return _compiled(function)


@lru_cache(maxsize=None)
def _compiled(function):
    return _Graph(numba()).copy(function, entry=True)


@lru_cache(maxsize=None)
def numba():
    """Return the module Numba; if it is missing or unusable, warn once and return None."""
    try:
        import numba as found
        from numba.core import event
    except ModuleNotFoundError as error:
        if error.name == 'numba':
            LOG.warning('Numba is not installed: loops run in plain Python, slower but with the '
                        "same numbers (pip install 'ins_sim[fast]')")
        else:
            _say_plain(error)
        return None
    except Exception as error:  # noqa: B902 - an import of another version may raise anything
        _say_plain(error)
        return None
    event.register('numba:compile', _announcer(event))
    _spare_linear_algebra()
    return found


def _spare_linear_algebra():
    """
    Load Numba's array functions without SciPy's linear algebra, which would take 0.2 s.

    Numba imports SciPy's linear algebra only to find out whether it exists. Compiled code that
    needs it imports it later.
    """
    name = 'scipy.linalg.cython_blas'
    if name in sys.modules or 'numba.np.arraymath' in sys.modules:
        return
    sys.modules[name] = None
    try:
        from numba.np import arraymath
        arraymath._HAVE_BLAS = find_spec('scipy') is not None
    except Exception:  # noqa: B902 - Numba of another version loads it later, in its own way
        LOG.debug('the array functions of Numba cannot be loaded ahead', exc_info=True)
    finally:
        del sys.modules[name]


def _say_plain(error):
    first = (str(error).strip().splitlines() or [''])[0]
    LOG.warning('Numba cannot be used here (%s: %s): loops run in plain Python, slower but with '
                'the same numbers', type(error).__name__, first)


def _announcer(event):
    """Return a listener that logs the compilation of functions of this package."""
    class Announcer(event.Listener):
        depth = 0

        def on_start(self, started):
            function = started.data['dispatcher'].py_func
            if self.depth == 0 and _ours(function.__module__):
                LOG.warning('compiling %s: once for this version on this machine, a few seconds',
                            function.__name__)
            self.depth += 1

        def on_end(self, ended):
            self.depth -= 1

    return Announcer()


class _Graph:
    """The copies of a function and of all functions that it calls."""

    def __init__(self, jit):
        self._jit, self._copies = jit, {}
        self._digest = blake2b(repr((jit.__version__, np.__version__,
                                     sys.version_info[:3])).encode(), digest_size=8)

    def copy(self, function, entry=False):
        """Return the compiled copy of a function; with entry its code is cached on disk."""
        function = REPLACED.get(function, function)
        if not isinstance(function, FunctionType):
            return function
        if function not in self._copies:
            code = function.__code__
            names = {'__name__': function.__module__, '__builtins__': __builtins__}
            for name, attributes in _references(code).items():
                if name in function.__globals__:
                    names[name] = self._copied(function.__globals__[name], attributes)
            plain = FunctionType(code, names, function.__name__, function.__defaults__)
            plain.__module__, plain.__qualname__ = function.__module__, function.__qualname__
            self._digest.update(repr((plain.__module__, plain.__qualname__, _written(code),
                                      function.__defaults__)).encode())
            self._copies[function] = self._jitted(plain, entry)
        return self._copies[function]

    def _copied(self, value, attributes):
        """Return what a copy uses in place of a global; attributes: those of it that it uses."""
        if isinstance(value, FunctionType) and _ours(value.__module__):
            return self.copy(value)
        if isinstance(value, ModuleType) and _ours(value.__name__):
            shadow = ModuleType(value.__name__)
            for name in sorted(attributes):
                setattr(shadow, name, self._copied(getattr(value, name), ()))
            return shadow
        if isinstance(value, (bool, int, float, tuple, np.generic)):
            self._digest.update(repr(value).encode())
        return value

    def _jitted(self, plain, entry):
        options = {'error_model': 'numpy', 'nogil': True}
        if not entry:
            return self._jit.njit(plain, forceinline=True, **options)
        folder = cache_folder(self._digest.hexdigest())
        if folder is None:
            return self._jit.njit(plain, **options)
        before = self._jit.config.CACHE_DIR
        self._jit.config.CACHE_DIR = str(folder)
        try:
            return self._jit.njit(plain, cache=True, **options)
        finally:
            self._jit.config.CACHE_DIR = before


def _ours(name):
    return name.partition('.')[0] == PACKAGE


def _references(code):
    """Return {global name: set of the attributes used of it} for a code object."""
    found, last = {}, None
    for instruction in dis.get_instructions(code):
        if instruction.opname == 'LOAD_GLOBAL':
            last = instruction.argval
            found.setdefault(last, set())
            continue
        if last is not None and instruction.opname in ('LOAD_ATTR', 'LOAD_METHOD'):
            found[last].add(instruction.argval)
        if instruction.opname != 'CACHE':
            last = None
    return dict(sorted(found.items()))


def _written(code):
    """Return everything in a code object that determines its behaviour."""
    return (code.co_code, code.co_names, code.co_varnames,
            [_written(c) if isinstance(c, CodeType) else c for c in code.co_consts])
