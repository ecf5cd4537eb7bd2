"""Elementary functions of long arrays, by compiled loops where that pays; the same bits."""

import numpy as np

from . import elementary
from .compilation import run

# Number of values that NumPy processes in the time of one loop sample in plain Python.
SAMPLE = 64


def sincos(x):
    """Return sin x and cos x of an array."""
    found = np.empty((2, *x.shape))
    run(fill_sincos, x.size // SAMPLE, (x,), found, _stacked_sincos)
    return found[0], found[1]


def tanh(x):
    """Return tanh x of an array."""
    return _filled(fill_tanh, (x,), _arrays_of(elementary.tanh))


def atan2(y, x):
    """Return the angles of the points (x, y), arrays."""
    return _filled(fill_atan2, (y, x), _arrays_of(elementary.atan2))


def log1p(x):
    """Return ln(1 + x) of an array of values from 0 to 1."""
    return _filled(fill_log1p, (x,), _arrays_of(elementary.log1p))


def fill_sincos(x, out):
    """Write the sines of x into the first half of out, the cosines into the second."""
    for k in range(len(x)):
        out[k], out[len(x) + k] = elementary.sincos(x[k])


def fill_tanh(x, out):
    """Write the hyperbolic tangents of x into out."""
    for k in range(len(x)):
        out[k] = elementary.tanh(x[k])


def fill_atan2(y, x, out):
    """Write the angles of the points (x, y) into out."""
    for k in range(len(x)):
        out[k] = elementary.atan2(y[k], x[k])


def fill_log1p(x, out):
    """Write ln(1 + x) into out."""
    for k in range(len(x)):
        out[k] = elementary.log1p(x[k])


def _filled(loop, inputs, plain):
    found = np.empty(inputs[0].shape)
    run(loop, found.size // SAMPLE, inputs, found, plain)
    return found


def _stacked_sincos(x, out):
    out[0], out[1] = elementary.sincos(x)


def _arrays_of(function):
    def plain(*inputs):
        *arrays, out = inputs
        out[...] = function(*arrays)

    return plain
