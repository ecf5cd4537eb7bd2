"""Instants in integer nanoseconds: periods, text, and clocks that wrap around."""

import numpy as np


def period_ns(rate_hz):
    """Return the sampling period of a rate in Hz, ns, rounded to an integer."""
    return round(1e9 / rate_hz)


def seconds(t_ns):
    """Return an instant (ns) as exact text in seconds."""
    sign, t_ns = ('-', -t_ns) if t_ns < 0 else ('', t_ns)
    whole, fraction = divmod(int(t_ns), 1_000_000_000)
    return f'{sign}{whole}.{fraction:09d} s'


# 32-bit counters of ns, us and ms, and the time in ns after which they wrap around.
_WRAPS_NS = {f'32 bits of {unit}': 2 ** 32 * ns
             for unit, ns in (('ns', 1), ('us', 1_000), ('ms', 1_000_000))}
# After a wrap-around the stamps must continue within this many median steps.
_MOST_STEPS = 50.0


def unwrap_clock(t_ns):
    """
    Return stamps with the wrap-arounds of their clock removed, and a sentence, or ''.

    A jump back counts as a wrap-around only if it has the size of a 32-bit counter of ns, us or
    ms, and the stamps then continue as before. Smaller jumps back are stamps out of order.

    Parameters
    ----------
    t_ns : (n,) int64 stamps, ns
    """
    steps = np.diff(t_ns)
    back = np.flatnonzero(steps < 0)
    forward = steps[steps > 0]
    if not len(back) or not len(forward):
        return t_ns, ''
    usual = float(np.median(forward))
    for name, wrap in _WRAPS_NS.items():
        missed = steps[back] + wrap
        wrapped = back[(missed > 0) & (missed <= _MOST_STEPS * usual)]
        if len(wrapped) and wrap > 100.0 * usual:
            count = np.zeros(len(t_ns), dtype=np.int64)
            count[wrapped + 1] = 1
            return t_ns + np.cumsum(count) * wrap, (
                f'the clock ({name}) wraps around {len(wrapped)} times, first after '
                f'{seconds(t_ns[wrapped[0]])}: unwrapped')
    return t_ns, ''
