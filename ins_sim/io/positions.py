"""Select the valid ones of recorded positions, and count the others by reason."""

import numpy as np

# Status that receivers and drivers give without a position (sensor_msgs/NavSatStatus: -1 no fix,
# -2 unknown).
UNKNOWN_STATUS = -2
# Larger than in any vehicle or odometry frame; such values are corrupt or in another unit.
MOST_M_S, MOST_DEG, MOST_M = 1e5, 1e6, 1e9


def usable(lat_deg, lon_deg, height_m, status=None, keep_zero=False):
    """
    Return which positions are valid, (n,) bool, and {reason: number of invalid ones}.

    lat_deg, lon_deg, height_m and status have the shape (n,). keep_zero accepts positions at
    exactly latitude 0, longitude 0, which many receivers report before their first fix.
    """
    good, dropped = np.ones(len(lat_deg), dtype=bool), {}

    def drop(bad, reason):
        count = int(np.count_nonzero(good & bad))
        if count:
            dropped[reason] = count
            good[bad] = False

    if status is not None:
        drop(status == UNKNOWN_STATUS, 'of unknown status')
        drop(status < 0, 'without a fix by their status')
    drop(~(np.isfinite(lat_deg) & np.isfinite(lon_deg)),
         'whose latitude or longitude is not a number')
    drop(~np.isfinite(height_m), 'whose height is not a number')
    drop((np.abs(lat_deg) > 90.0) | (np.abs(lon_deg) > 540.0) | (np.abs(height_m) > 1e7),
         'outside the range of latitude, longitude or height')
    if not keep_zero:
        drop((lat_deg == 0.0) & (lon_deg == 0.0),
             'at latitude 0, longitude 0 (accept.zero_fixes keeps them)')
    return good, dropped


def plausible(name, values, most, unit, notes):
    """Return values (n,) or (n, k) with NaN in rows beyond a bound, and add a note."""
    size = np.abs(values).reshape(len(values), -1).max(axis=1, initial=0.0)
    # Comparisons with NaN are false.
    bad = size > most
    if bad.any():
        notes.append(f'{name}: {np.count_nonzero(bad)} of {len(values)} dropped, because they '
                     f'exceed {most:g} {unit}; the first is {size[np.argmax(bad)]:.6g} {unit}')
        values = np.where(bad if values.ndim == 1 else bad[:, None], np.nan, values)
    return values


def sentence(name, what, count, dropped):
    """Return a sentence such as '/fix: 5 of 16 fixes dropped: 5 of unknown status'."""
    reasons = ', '.join(f'{n} {reason}' for reason, n in dropped.items())
    return f'{name}: {sum(dropped.values())} of {count} {what} dropped: {reasons}'


def track(lat_deg, lon_deg, height_m):
    """Return (n, 3) latitude, rad, unwrapped longitude, rad, and height, m."""
    return np.stack([np.radians(lat_deg), np.unwrap(np.radians(lon_deg)), height_m], axis=-1)
