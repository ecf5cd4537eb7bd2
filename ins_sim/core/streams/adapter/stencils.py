"""Derivatives of samples at uneven instants, by the polynomial through some of them."""

from functools import lru_cache

# Samples of a symmetric stencil, and the number of the one in the middle.
POINTS, MIDDLE = 5, 2


def weights(steps_ns, node):
    """
    Return the weights of the first and of the second derivative at one of some samples.

    steps_ns: the steps between the samples, ns, numbers or arrays; node: number of the sample. A
    derivative is the sum of weight times (value - value at the node), per s and per s^2. Source:
    Berrut and Trefethen, SIAM Review 46, 2004, section 9.3 (differentiation of interpolants).
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


# Of steps that are numbers, which are the same again and again.
stencil = lru_cache(maxsize=256)(weights)


def weighted(factors, vectors, origin):
    """Return the sum of factors times (vector - origin), a tuple of three floats."""
    x = y = z = 0.0
    a, b, c = origin
    for factor, (d, e, f) in zip(factors, vectors):
        x, y, z = x + factor * (d - a), y + factor * (e - b), z + factor * (f - c)
    return x, y, z
