"""
Plausibility limits of readings, poses and fixes, for all sources alike.

The limits lie far beyond what any vehicle does and far below where arithmetic overflows. A value
beyond them is a mistake, and a single one would spoil a solution permanently.
"""

SECOND = 1_000_000_000
# Largest norm of each quantity.
RATE_RAD_S = 1e4
FORCE_M_S2 = 1e6
SPEED_M_S = 1e5
PLACE_M = 1e8
QUATERNION = 1e4
# Largest height above the surface of the Earth, and largest depth below it.
HEIGHT_M = 1e7
# Limits of standard deviations; the square of a smaller one cannot be used as a divisor.
LEAST_SIGMA, MOST_SIGMA = 1e-9, 1e9
# Limits of stamps: jitter may put the first readings of a run before 0, and 32 bits hold the rest.
EARLIEST_NS, LATEST_NS = -SECOND, 2**31 * SECOND
# Longest time from the instant of a fix to its arrival; more than any latency that can be set.
LATENCY_NS = 86_400 * SECOND


def is_sigma(value):
    """Return whether a number is a possible standard deviation."""
    return LEAST_SIGMA <= value <= MOST_SIGMA
