"""Elementary functions: accuracy against mpmath; same bits for floats, arrays, compiled code."""

import math

from ins_sim.core.numerics import compilation, elementary, elementwise
import mpmath
import numpy as np
import pytest

COUNT = 4000
RNG = np.random.default_rng(12)
SMALL = 10.0 ** RNG.uniform(-12.0, 0.0, COUNT)


def both(low, high):
    return RNG.uniform(low, high, COUNT)


# Function, range of arguments, greatest error in units in the last place.
CASES = {
    'sin': ('sin', both(-10.0, 10.0), 1.5),
    'cos': ('cos', both(-10.0, 10.0), 1.5),
    'sin of many turns': ('sin', both(-1.6e6, 1.6e6), 2.5),
    'cos of many turns': ('cos', both(-1.6e6, 1.6e6), 2.5),
    'sin of small': ('sin', SMALL, 1.5),
    'exp': ('exp', both(-700.0, 700.0), 1.5),
    'expm1': ('expm1', both(-30.0, 30.0), 2.0),
    'expm1 of small': ('expm1', -SMALL, 2.0),
    'tanh': ('tanh', both(-40.0, 40.0), 3.0),
    'tanh of small': ('tanh', SMALL, 3.0),
    'log': ('log', 10.0 ** both(-300.0, 300.0), 1.5),
    'log near one': ('log', both(0.5, 2.0), 1.5),
    'log1p': ('log1p', SMALL, 1.5)}


def ulps(value, exact):
    return float(abs(mpmath.mpf(value) - exact) / mpmath.mpf(math.ulp(float(exact))))


@pytest.fixture(autouse=True)
def _precision():
    with mpmath.workprec(160):
        yield


@pytest.mark.parametrize('case', CASES)
def test_accuracy(case):
    """Each function errs by at most its bound, 1.5 to 3 ulp, compared with mpmath."""
    name, arguments, bound = CASES[case]
    function, exact = getattr(elementary, name), getattr(mpmath, name)
    assert max(ulps(function(x), exact(mpmath.mpf(x))) for x in arguments.tolist()) <= bound


def points():
    y = RNG.normal(size=COUNT) * 10.0 ** RNG.uniform(-8.0, 8.0, COUNT)
    return y, RNG.normal(size=COUNT)


def test_accuracy_of_atan2():
    """atan2 errs by at most 1.5 ulp, compared with mpmath."""
    pairs = list(zip(*(a.tolist() for a in points())))
    assert max(ulps(elementary.atan2(y, x), mpmath.atan2(y, x)) for y, x in pairs) <= 1.5


@pytest.mark.parametrize('y, x, angle', [
    (0.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, -2.0, math.pi), (3.0, 0.0, 0.5 * math.pi),
    (-3.0, 0.0, -0.5 * math.pi), (1.0, 1.0, 0.25 * math.pi), (-1.0, -1.0, -0.75 * math.pi)])
def test_angles_on_the_axes(y, x, angle):
    """atan2 is exact on the axes and the diagonals."""
    assert elementary.atan2(y, x) == angle


@pytest.mark.parametrize('case', CASES)
def test_an_array_has_the_bits_of_floats(case):
    """A function of an array has the bits of the function of its elements."""
    name, arguments, _ = CASES[case]
    function = getattr(elementary, name)
    assert function(arguments).tolist() == [function(x) for x in arguments.tolist()]


def test_an_array_of_points_has_the_bits_of_floats():
    """atan2 of arrays has the bits of atan2 of their elements."""
    y, x = points()
    assert elementary.atan2(y, x).tolist() == [
        elementary.atan2(*p) for p in zip(y.tolist(), x.tolist())]


@pytest.mark.parametrize('x', [0.0, -0.0, 0.3, -0.784999, 0.785, 0.7853981633974483, 1e-300])
def test_the_short_way_has_the_bits_of_the_long_one(x):
    """The shortcut for small angles has the bits of the general function and its signs of zero."""
    assert repr(elementary.sincos(x)) == repr(elementary.general_sincos(x))
    for y in (0.0, 0.1, 0.66 * x, 2.0 * x, -x):
        for point in ((y, x), (x, y)):
            assert repr(elementary.atan2(*point)) == repr(elementary.general_atan2(*point))


@pytest.mark.parametrize('name', ['sin', 'cos', 'atan2'])
def test_compiled_functions_have_the_bits_of_plain_ones(name):
    """Compiled sin, cos and atan2 have the bits of plain Python."""
    plain = getattr(elementary, name)
    fast = compilation.compiled(plain)
    if fast is None:
        pytest.skip('Numba is not installed')
    arguments = zip(*(a.tolist() for a in points())) if name == 'atan2' else (
        (x,) for x in CASES['sin of many turns'][1].tolist())
    for words in arguments:
        assert fast(*words) == plain(*words)


@pytest.mark.parametrize('name', ['sin', 'cos', 'tanh', 'exp'])
def test_no_number_stays_no_number(name):
    """A function of NaN is NaN, also within an array."""
    function = getattr(elementary, name)
    assert math.isnan(function(math.nan))
    assert np.isnan(function(np.array([math.nan, 1.0]))).tolist() == [True, False]


def test_a_turn_is_taken_off():
    """``shorter_turn`` adds or subtracts one or two whole turns of 2 pi."""
    assert elementary.shorter_turn(1.0) == 1.0
    assert elementary.shorter_turn(4.0) == 4.0 - 2.0 * math.pi
    assert elementary.shorter_turn(-4.0 - 2.0 * math.pi) == -4.0 - 2.0 * math.pi + 4.0 * math.pi


@pytest.mark.parametrize('name', ['sincos', 'tanh', 'atan2', 'log1p'])
def test_long_arrays_have_the_bits_of_floats(name, monkeypatch):
    """Long arrays in compiled loops have the bits of single floats."""
    monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', -1)
    arguments = points() if name == 'atan2' else (np.abs(points()[1]),)
    if name == 'log1p':
        arguments = (arguments[0] / arguments[0].max(),)
    found = np.asarray(getattr(elementwise, name)(*arguments))
    expected = [getattr(elementary, name)(*p) for p in zip(*(a.tolist() for a in arguments))]
    assert found.tolist() == np.moveaxis(np.array(expected), 0, -1).tolist()
