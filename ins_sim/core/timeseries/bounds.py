"""
What readings, poses and fixes may be, whoever sends them: the one table of plausibility.

The bounds lie far beyond what any vehicle does, and far below where arithmetic overflows: a number
beyond them comes from a mistake, and one of them would spoil a solution for good.
"""

SECOND = 1_000_000_000
# Below which the norm of each quantity stays.
RATE_RAD_S = 1e4
FORCE_M_S2 = 1e6
SPEED_M_S = 1e5
PLACE_M = 1e8
QUATERNION = 1e4
# Above the surface of the Earth, and below it.
HEIGHT_M = 1e7
# Of standard deviations: the square of a smaller one is no divisor any more.
LEAST_SIGMA, MOST_SIGMA = 1e-9, 1e9
# Stamps: jitter may put the first readings of a run before 0, and 32 bits hold the rest.
EARLIEST_NS, LATEST_NS = -SECOND, 2**31 * SECOND
# How long after its instant a fix may be there: more than any latency that can be set.
LATENCY_NS = 86_400 * SECOND


def is_sigma(value):
    """Return whether a number may be a standard deviation."""
    return LEAST_SIGMA <= value <= MOST_SIGMA
