"""Instants in integer nanoseconds: the period of a rate, and an instant as text."""


def period_ns(rate_hz):
    """Return the sampling period of a rate, rounded to one nanosecond."""
    return round(1e9 / rate_hz)


def seconds(t_ns):
    """Return an instant in seconds as exact text."""
    sign, t_ns = ('-', -t_ns) if t_ns < 0 else ('', t_ns)
    whole, fraction = divmod(int(t_ns), 1_000_000_000)
    return f'{sign}{whole}.{fraction:09d} s'
