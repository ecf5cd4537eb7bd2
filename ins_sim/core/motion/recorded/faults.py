"""Faults of a recording: gaps, stamps that do not advance, and impossible jumps."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.instants import seconds

# A missing row makes an interval of 2 medians; the remaining half median allows for jitter.
GAP_MEDIANS = 2.5
# The size of a position jump is the displacement in an interval dt minus that at the median
# velocity of the five intervals around it. A jump is impossible if it exceeds JUMP_M_S2 dt^2 or
# JUMP_M_S dt, whichever is less: no aircraft accelerates with 50 g or changes its velocity by 1000
# m/s in one interval. Below 20 m it is treated as the correction step of an on-board filter, which
# ``recording_quality`` reports.
JUMP_M = 20.0
JUMP_M_S2 = 500.0
JUMP_M_S = 1000.0
# An attitude jump is impossible if its rate exceeds that of its neighbours by 400 deg/s (the
# fastest aerobatic roll is about 420); below 45 deg it is treated as a correction step. A rotation
# beyond 120 deg from row to row is always a jump, because its direction is ambiguous.
TURN_DEG_S = 400.0
TURN_DEG = 45.0
AMBIGUOUS_DEG = 120.0
NAMED_AT_MOST = 8


@dataclass(frozen=True)
class Fault:
    """A fault between the rows index and index + 1; kind: stamps, gaps or jumps; what: details."""

    index: int
    kind: str
    what: str


def step_displacements(lat, lon, height):
    """Return the displacements east, north, up from row to row, (n - 1, 3) m; lat, lon in rad."""
    mean = 0.5 * (lat[1:] + lat[:-1])
    east, north = ellipsoid.level_metres(np.diff(lat), np.diff(lon), np.sin(mean), np.cos(mean),
                                         0.5 * (height[1:] + height[:-1]))
    return np.stack([east, north, np.diff(height)], axis=-1)


def step_excess(steps, dt):
    """
    Return how far each step is from that at the median rate of the five steps around it, (n,).

    The median is that of each component. A jump, or a spike of up to two intervals, stands out; of
    a smooth motion only its third derivative contributes.

    Parameters
    ----------
    steps : (n, 3) displacements or rotation vectors
    dt : (n,) lengths of the intervals, s
    """
    from scipy.ndimage import median_filter
    rate = steps / dt[:, None]
    if len(dt) < 5:
        usual = np.median(rate, axis=0) if len(dt) > 2 else rate
    else:
        # Near each end use the median of three, extrapolated linearly to the outermost interval.
        usual = median_filter(rate, size=(5, 1))
        usual[1], usual[-2] = np.median(rate[:3], axis=0), np.median(rate[-3:], axis=0)
        usual[0], usual[-1] = 2.0 * usual[1] - usual[2], 2.0 * usual[-2] - usual[-3]
    return np.sqrt((((rate - usual) * dt[:, None]) ** 2).sum(axis=1))


def median_interval(dt):
    """Return the median of the intervals that advance in time, s; 0 if there are none."""
    return float(np.median(dt[dt > 0.0])) if np.any(dt > 0.0) else 0.0


def find_faults(rows, turns):
    """
    Return the Faults of RecordedRows in the order of the rows.

    turns (n - 1, 3): rotation vectors from row to row, rad.
    """
    dt = np.diff(rows.t_ns) * 1e-9
    faults, median = [], median_interval(dt)
    for k in np.flatnonzero(dt <= 0.0).tolist():
        what = 'repeated' if dt[k] == 0.0 else f'{seconds(rows.t_ns[k])} goes back to'
        faults.append(Fault(k, 'stamps', f'{what} {seconds(rows.t_ns[k + 1])}'))
    for k in np.flatnonzero(dt > GAP_MEDIANS * median).tolist():
        faults.append(Fault(k, 'gaps', f'{seconds(rows.t_ns[k])} ({dt[k]:.3g} s long)'))
    steps = step_displacements(np.radians(rows.lat_deg), np.radians(rows.lon_deg), rows.height_m)
    angle = np.degrees(np.sqrt((turns ** 2).sum(axis=1)))
    for first, last in _between([fault.index for fault in faults], len(dt)):
        part = slice(first, last)
        faults += _jumps(rows.t_ns, first, dt[part], step_excess(steps[part], dt[part]),
                         np.degrees(step_excess(turns[part], dt[part])), angle[part])
    return sorted(faults, key=lambda fault: fault.index)


def _between(indices, n):
    """Return the (first, last) ranges of the n intervals that contain none of the indices."""
    bounds = [-1, *sorted(set(indices)), n]
    return [(a + 1, b) for a, b in zip(bounds, bounds[1:]) if b > a + 1]


def _jumps(t_ns, first, dt, far, turned, angle):
    """Return the jumps among contiguous intervals; first: index of the first interval."""
    far_limit = np.maximum(JUMP_M, np.minimum(JUMP_M_S2 * dt * dt, JUMP_M_S * dt))
    jumped = far > far_limit
    spun = (turned > np.maximum(TURN_DEG, TURN_DEG_S * dt)) | (angle > AMBIGUOUS_DEG)
    faults = []
    for k in np.flatnonzero(jumped | spun).tolist():
        size = (f'{far[k]:.3g} m beyond its neighbours' if jumped[k] else
                f'{angle[k]:.3g} deg of rotation')
        faults.append(Fault(first + k, 'jumps',
                            f'{seconds(t_ns[first + k])} ({size}, in {dt[k]:.3g} s)'))
    return faults


def describe_faults(faults, median_s):
    """Return a clause that lists the faults by kind, at most NAMED_AT_MOST of each with times."""
    titles = {'stamps': 'stamps that do not advance (',
              'gaps': f'gaps over {GAP_MEDIANS:g} times the median interval of {median_s:.4g} s '
                      '(after t_s = ',
              'jumps': 'impossible jumps (after t_s = '}
    clauses = []
    for kind, title in titles.items():
        named = [fault.what for fault in faults if fault.kind == kind]
        if named:
            more = len(named) - NAMED_AT_MOST
            clauses.append(f'{len(named)} {title}' + ', '.join(named[:NAMED_AT_MOST])
                           + (f' and {more} more' if more > 0 else '') + ')')
    return ' and '.join(clauses)


def unbroken_part(rows, turns, start_s, on_gap):
    """
    Return the slice of the rows to use and a list of warnings.

    Parameters
    ----------
    rows : RecordedRows
    turns : (n - 1, 3) rotation vectors from row to row, rad
    start_s : time from the first row to the instant that becomes motion time zero, s
    on_gap : 'refuse' raises ValueError with the times of all faults; 'cut' keeps the part between
        faults that contains start_s

    """
    faults = find_faults(rows, turns)
    if not faults:
        return slice(0, len(rows.t_ns)), []
    dt = np.diff(rows.t_ns) * 1e-9
    found = describe_faults(faults, median_interval(dt))
    if on_gap != 'cut':
        raise ValueError(f'{rows.path} has {found}; expected an unbroken recording '
                         "(motion.recording.on_gap = 'cut' keeps the part that contains start_s)")
    since = (rows.t_ns - rows.t_ns[0]) * 1e-9
    parts = [(a, b) for a, b in _between([fault.index for fault in faults], len(dt))]
    holding = [(a, b) for a, b in parts if since[a] <= start_s < since[b]]
    longest = max(parts, key=lambda p: since[p[1]] - since[p[0]], default=None)
    hint = ('' if longest is None else f'the longest unbroken part is {since[longest[0]]:.4g} to '
            f'{since[longest[1]]:.4g} s after the first row')
    if not holding:
        raise ValueError(f'{rows.path} has {found} and no part between them contains '
                         f'motion.recording.start_s = {start_s:g} s; '
                         f'{hint or "there is a fault between every two rows"}')
    first, last = holding[0]
    return slice(first, last + 1), [
        f'{rows.path} has {found}; it is cut there: {since[first]:.6g} to {since[last]:.6g} s '
        f'after the first row is kept; {hint}']
