"""Instants are integer nanoseconds; so is the period between them."""


def period_ns(rate_hz):
    """Return the sampling period of a rate, rounded to one nanosecond."""
    return round(1e9 / rate_hz)
