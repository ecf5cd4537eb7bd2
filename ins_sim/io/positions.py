"""Positions that somebody recorded: which of them are places on Earth, and why the others not."""

import numpy as np

# What receivers and drivers put where they have no position (sensor_msgs/NavSatStatus: -1 no fix,
# -2 unknown).
UNKNOWN_STATUS = -2
# Beyond any vehicle and any frame of odometry: bits that fell, or another unit.
MOST_M_S, MOST_DEG, MOST_M = 1e5, 1e6, 1e9


def usable(lat_deg, lon_deg, height_m, status=None, keep_zero=False):
    """
    Return which positions can be used, (n,) bool, and {reason: how many were dropped for it}.

    lat_deg, lon_deg, height_m, status (n,); keep_zero: whether what lies at latitude 0,
    longitude 0 to the last bit, where many receivers are before their first fix, is one.
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
         'that are no place on Earth')
    if not keep_zero:
        drop((lat_deg == 0.0) & (lon_deg == 0.0),
             'at latitude 0, longitude 0 (accept.zero_fixes keeps them)')
    return good, dropped


def plausible(name, values, most, unit, notes):
    """Return values (n,) or (n, k) with NaN for the rows beyond a bound, which are noted."""
    size = np.abs(values).reshape(len(values), -1).max(axis=1, initial=0.0)
    # Comparisons with NaN are false.
    bad = size > most
    if bad.any():
        notes.append(f'{name}: {np.count_nonzero(bad)} of {len(values)} dropped that are beyond '
                     f'{most:g} {unit}, the first is {size[np.argmax(bad)]:.6g} {unit}')
        values = np.where(bad if values.ndim == 1 else bad[:, None], np.nan, values)
    return values


def sentence(name, what, count, dropped):
    """Return what was dropped and why: '/fix: 5 of 16 fixes dropped: 5 of unknown status'."""
    reasons = ', '.join(f'{n} {reason}' for reason, n in dropped.items())
    return f'{name}: {sum(dropped.values())} of {count} {what} dropped: {reasons}'


def track(lat_deg, lon_deg, height_m):
    """Return (n, 3) latitude and longitude, rad, the latter continuous, and height, m."""
    return np.stack([np.radians(lat_deg), np.unwrap(np.radians(lon_deg)), height_m], axis=-1)
