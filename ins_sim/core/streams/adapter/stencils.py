"""Derivatives of unevenly spaced samples, from the polynomial through several of them."""

from functools import lru_cache

# Number of samples of a symmetric stencil, and index of the middle one.
POINTS, MIDDLE = 5, 2


def weights(steps_ns, node):
    """
    Return the weights of the first and second derivative at one of several samples.

    A derivative is the sum of weight times (value - value at the node), per s and per s^2. Source:
    Berrut and Trefethen, SIAM Review 46, 2004, section 9.3 (differentiation of interpolants).

    Parameters
    ----------
    steps_ns : steps between the samples, numbers or arrays, ns
    node : index of the sample at which the derivatives are taken
    """
    at = [0]
    for step in steps_ns:
        at.append(at[-1] + step)
    x = [(t - at[node]) * 1e-9 for t in at]
    others = [k for k in range(len(x)) if k != node]
    inverse_sum = 0.0
    for k in others:
        inverse_sum = inverse_sum - 1.0 / x[k]
    first, second = [0.0] * len(x), [0.0] * len(x)
    for k in others:
        above = below = 1.0
        for m in range(len(x)):
            if m not in (k, node):
                above = above * -x[m]
            if m != k:
                below = below * (x[k] - x[m])
        first[k] = above / below
        second[k] = 2.0 * first[k] * (inverse_sum + 1.0 / x[k])
    return tuple(first), tuple(second)


# Cached variant for steps that are numbers: the same steps occur again and again.
stencil = lru_cache(maxsize=256)(weights)


def weighted(factors, vectors, origin):
    """Return the sum of factors times (vector - origin), a tuple of three floats."""
    x = y = z = 0.0
    a, b, c = origin
    for factor, (d, e, f) in zip(factors, vectors):
        x, y, z = x + factor * (d - a), y + factor * (e - b), z + factor * (f - c)
    return x, y, z
