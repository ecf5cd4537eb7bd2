"""
Truncated Taylor series in time: exact derivatives of closed-form motions.

A motion is written once, as a pose; velocities, accelerations and rates follow from the series.
Recurrences: Griewank and Walther, "Evaluating Derivatives", 2nd ed., table 13.1-13.2.
"""

import numpy as np

from . import elementary, elementwise
from .compilation import REPLACED


class Series:
    """
    Taylor coefficients c[k] = f^(k)/k! of a function of time at n instants.

    Operations truncate to the lower order of the two operands.

    Attributes
    ----------
    c : (order + 1, n)
    """

    __slots__ = ('c',)
    __array_ufunc__ = None

    def __init__(self, c):
        self.c = c

    @classmethod
    def time(cls, t, order):
        """Return the series of t itself at the instants t (n,), s."""
        c = np.zeros((order + 1, len(t)))
        c[0] = t
        if order:
            c[1] = 1.0
        return cls(c)

    def constant(self, value):
        """Return the series of a constant at the same instants and order."""
        c = np.zeros_like(self.c)
        c[0] = value
        return Series(c)

    def to_order(self, order):
        """Return the series truncated to a lower order."""
        return type(self)(self.c[:order + 1])

    @property
    def value(self):
        """Return f, shape (n,)."""
        return self.c[0]

    def derivative(self):
        """Return the series of f', one order lower."""
        k = np.arange(1, len(self.c))[:, None]
        return Series(self.c[1:] * k)

    def integral(self, value):
        """Return the integral of the series, with the given value (n,) at the instants."""
        k = np.arange(1, len(self.c) + 1)[:, None]
        first = np.broadcast_to(value, (1,) + self.c.shape[1:])
        return Series(np.concatenate([first, self.c / k]))

    def __neg__(self):
        return Series(-self.c)

    def __add__(self, other):
        if isinstance(other, Series):
            n = min(len(self.c), len(other.c))
            return Series(self.c[:n] + other.c[:n])
        c = self.c.copy()
        c[0] += other
        return Series(c)

    __radd__ = __add__

    def __sub__(self, other):
        return self + (-other)

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        if not isinstance(other, Series):
            return Series(self.c * other)
        n = min(len(self.c), len(other.c))
        product = np.empty((n,) + self.c.shape[1:])
        for k in range(n):
            product[k] = _cauchy(self.c, other.c, k, 0)
        return Series(product)

    __rmul__ = __mul__

    def __truediv__(self, other):
        if not isinstance(other, Series):
            return Series(self.c / other)
        n = min(len(self.c), len(other.c))
        q = np.empty((n,) + self.c.shape[1:])
        for k in range(n):
            q[k] = (self.c[k] - _cauchy(other.c, q, k, 1)) / other.c[0]
        return Series(q)

    def __rtruediv__(self, other):
        return self.constant(other) / self

    def __pow__(self, exponent):
        if exponent == 0.5:
            return sqrt(self)
        raise ValueError(f'Series has no power {exponent}, only 0.5')


class InstantSeries(Series):
    """
    A Series at one instant, of order 2 at most; c is a tuple of floats.

    The operations are those of Series in the same order, so the bits are the same. Arrays with one
    element would take ten times as long.
    """

    __slots__ = ()

    def constant(self, value):
        """Return the series of a constant of the same order."""
        return InstantSeries((value, 0.0, 0.0)[:len(self.c)])

    def derivative(self):
        """Return the series of f', one order lower."""
        c = self.c
        return InstantSeries((c[1], c[2] * 2) if len(c) == 3 else c[1:])

    def integral(self, value):
        """Return the integral of the series, with the given value, a float, at the instant."""
        c = self.c
        return InstantSeries((value, c[0], c[1] / 2) if len(c) > 1 else (value, *c))

    def __neg__(self):
        return InstantSeries(tuple([-x for x in self.c]))

    def __add__(self, other):
        a = self.c
        if isinstance(other, Series):
            b = other.c
            if len(a) == len(b) == 2:
                return InstantSeries((a[0] + b[0], a[1] + b[1]))
            return InstantSeries(tuple([x + y for x, y in zip(a, b)]))
        return InstantSeries((a[0] + other, *a[1:]))

    __radd__ = __add__

    def __sub__(self, other):
        if isinstance(other, Series):
            return InstantSeries(tuple([x - y for x, y in zip(self.c, other.c)]))
        return self + (-other)

    def __mul__(self, other):
        a = self.c
        if isinstance(other, Series):
            b = other.c
            if len(a) == 3 == len(b):
                return InstantSeries((a[0] * b[0], a[0] * b[1] + a[1] * b[0],
                                      a[0] * b[2] + a[1] * b[1] + a[2] * b[0]))
            if len(a) > 1 < len(b):
                return InstantSeries((a[0] * b[0], a[0] * b[1] + a[1] * b[0]))
            return InstantSeries((a[0] * b[0],))
        if len(a) == 2:
            return InstantSeries((a[0] * other, a[1] * other))
        return InstantSeries(tuple([x * other for x in a]))

    __rmul__ = __mul__

    def __truediv__(self, other):
        a = self.c
        if not isinstance(other, Series):
            return InstantSeries(tuple([x / other for x in a]))
        b, q = other.c, []
        for k in range(min(len(a), len(b))):
            q.append((a[k] - _cauchy(b, q, k, 1)) / b[0])
        return InstantSeries(tuple(q))

    def sincos(self):
        """Return sin and cos of the series."""
        u = self.c
        s, c = elementary.sincos(u[0])
        if len(u) == 1:
            return InstantSeries((s,)), InstantSeries((c,))
        s1, c1 = u[1] * c, -(u[1] * s)
        if len(u) == 2:
            return InstantSeries((s, s1)), InstantSeries((c, c1))
        twice = u[2] * 2
        return (InstantSeries((s, s1, (u[1] * c1 + twice * c) / 2)),
                InstantSeries((c, c1, -(u[1] * s1 + twice * s) / 2)))

    def sqrt(self):
        """Return the square root of the series, which is positive."""
        r = []
        for k, x in enumerate(self.c):
            r.append((x - _cauchy(r[1:], r[1:], k - 2, 0)) / (2.0 * r[0]) if r
                     else elementary.sqrt(x))
        return InstantSeries(tuple(r))


def _cauchy(a, b, k, first):
    """Return sum over j = first..k of a[j] b[k - j]."""
    total = a[first] * b[k - first] if first <= k else 0.0
    for j in range(first + 1, k + 1):
        total = total + a[j] * b[k - j]
    return total


def sincos(u):
    """Return sin u and cos u of a series, or of a float or an array."""
    if isinstance(u, InstantSeries):
        return u.sincos()
    if not isinstance(u, Series):
        return elementwise.sincos(u) if isinstance(u, np.ndarray) else elementary.sincos(u)
    s, c = np.empty_like(u.c), np.empty_like(u.c)
    s[0], c[0] = elementwise.sincos(u.c[0])
    w = u.derivative().c
    for k in range(1, len(u.c)):
        s[k] = _cauchy(w, c, k - 1, 0) / k
        c[k] = -_cauchy(w, s, k - 1, 0) / k
    return Series(s), Series(c)


def sin(u):
    """Return the series of sin u."""
    return sincos(u)[0]


def tanh(u):
    """Return the series of tanh u, from T' = (1 - T^2) u'."""
    t, v = np.empty_like(u.c), np.empty_like(u.c)
    t[0] = elementwise.tanh(u.c[0])
    v[0] = 1.0 - t[0] * t[0]
    w = u.derivative().c
    for k in range(1, len(u.c)):
        t[k] = _cauchy(w, v, k - 1, 0) / k
        v[k] = -_cauchy(t, t, k, 0)
    return Series(t)


def sqrt(u):
    """Return the series of the square root of u > 0."""
    if isinstance(u, InstantSeries):
        return u.sqrt()
    r = np.empty_like(u.c)
    r[0] = np.sqrt(u.c[0])
    for k in range(1, len(u.c)):
        inner = _cauchy(r[1:], r[1:], k - 2, 0)
        r[k] = (u.c[k] - inner) / (2.0 * r[0])
    return Series(r)


def atan2(y, x):
    """Return the series of the angle of (x, y), from a' = (x y' - y x') / (x^2 + y^2)."""
    rate = (x * y.derivative() - y * x.derivative()) / (x * x + y * y)
    if isinstance(rate, InstantSeries):
        return rate.integral(elementary.atan2(y.c[0], x.c[0]))
    return rate.integral(elementwise.atan2(y.c[0], x.c[0]))


def log_cosh(u):
    """
    Return the series of ln cosh u without overflow, from its derivative tanh(u) u'.

    ln cosh a = a - ln(1 + tanh a).
    """
    slope = tanh(u)
    value = np.abs(u.c[0]) - elementwise.log1p(np.abs(slope.c[0]))
    return (slope * u.derivative()).integral(value)


# Compiled loops use floats only.
REPLACED[sincos] = elementary.general_sincos
