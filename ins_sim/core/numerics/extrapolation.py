"""One step of an ordinary differential equation by extrapolation, with a fixed order of sums."""

# Numbers of parts into which the step is divided; the order is twice the count of them.
DIVISIONS = (2, 4, 6, 8)


def extrapolated_step(rates, t, y, h):
    """
    Return the state one step later, to eighth order.

    Modified midpoint rule over 2, 4, 6 and 8 parts, extrapolated in the square of their length
    (Gragg 1965; Hairer, Norsett and Wanner, "Solving Ordinary Differential Equations I",
    section II.9).

    Parameters
    ----------
    rates : function of t and y that returns y', a tuple of floats
    t : start of the step
    y : state at the start, a tuple of floats
    h : length of the step
    """
    start, rows = rates(t, y), []
    for n in DIVISIONS:
        rows.append(_midpoint(rates, t, y, start, h, n))
    # Neville's scheme, in place: rows[k] becomes the extrapolation from the divisions up to k.
    for order in range(1, len(rows)):
        for k in range(len(rows) - 1, order - 1, -1):
            ratio = DIVISIONS[k] / DIVISIONS[k - order]
            part = 1.0 / (ratio * ratio - 1.0)
            rows[k] = tuple(a + part * (a - b) for a, b in zip(rows[k], rows[k - 1]))
    return rows[-1]


def _midpoint(rates, t, y, start, h, n):
    """Return the smoothed state after n steps of the midpoint rule; start is y' at t."""
    d = h / n
    last, now = y, tuple(a + d * r for a, r in zip(y, start))
    for k in range(1, n):
        last, now = now, tuple(a + 2.0 * d * r for a, r in zip(last, rates(t + k * d, now)))
    return tuple(0.5 * (a + b + d * r) for a, b, r in zip(last, now, rates(t + h, now)))
