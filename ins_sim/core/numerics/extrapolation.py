"""One step of an ordinary differential equation by extrapolation, in a fixed order of sums."""

# How often the step is divided; the order is twice as many.
DIVISIONS = (2, 4, 6, 8)


def extrapolated_step(rates, t, y, h):
    """
    Return the state a step later, of eighth order.

    Modified midpoint rule over 2, 4, 6 and 8 parts, extrapolated in the square of their length
    (Gragg 1965; Hairer, Norsett and Wanner, "Solving Ordinary Differential Equations I",
    section II.9).

    rates: function of t and y that returns y', floats; t: start; y: tuple of floats; h: step.
    """
    start, rows = rates(t, y), []
    for n in DIVISIONS:
        rows.append(_midpoint(rates, t, y, start, h, n))
    # Neville's scheme, in place: rows[k] is what the divisions up to k say together.
    for order in range(1, len(rows)):
        for k in range(len(rows) - 1, order - 1, -1):
            ratio = DIVISIONS[k] / DIVISIONS[k - order]
            part = 1.0 / (ratio * ratio - 1.0)
            rows[k] = tuple(a + part * (a - b) for a, b in zip(rows[k], rows[k - 1]))
    return rows[-1]


def _midpoint(rates, t, y, start, h, n):
    """Return the state after n steps of the midpoint rule, smoothed; start: y' at t."""
    d = h / n
    last, now = y, tuple(a + d * r for a, r in zip(y, start))
    for k in range(1, n):
        last, now = now, tuple(a + 2.0 * d * r for a, r in zip(last, rates(t + k * d, now)))
    return tuple(0.5 * (a + b + d * r) for a, b, r in zip(last, now, rates(t + h, now)))
