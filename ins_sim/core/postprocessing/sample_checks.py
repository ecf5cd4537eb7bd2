"""Detect irregular samples of a recorded IMU, and correct or drop them."""

from dataclasses import replace

import numpy as np

from ins_sim.core.numerics.instants import seconds
from ins_sim.core.timeseries.bounds import FORCE_M_S2, RATE_RAD_S

# If between 5 % and 95 % of the samples have a force of exactly zero, forces and rates are sent
# alternately; rounding does not produce so many zeros on all three axes.
_PART = 0.05


def checked_samples(imu, stamps, zero_readings):
    """
    Return a RecordedImu without invalid readings and with the desired stamps, and notes.

    Parameters
    ----------
    imu : RecordedImu
    stamps : StampSettings
    zero_readings : 'refuse', 'fill' or 'keep'

    Raises
    ------
    ValueError : if forces and rates are zero in turns and zero_readings is 'refuse'

    """
    imu, notes = stamped_samples(imu, stamps)
    imu = _without_spikes(imu, notes)
    return without_zeros(imu, zero_readings, notes), notes


def stamped_samples(imu, stamps):
    """Return a RecordedImu with the stamps required by StampSettings, and notes."""
    notes = []
    if stamps.source == 'even' and len(imu):
        t_ns = imu.t_ns[0] + np.round(np.arange(len(imu)) * (1e9 / stamps.rate_hz)).astype(
            np.int64)
        imu = replace(imu, t_ns=t_ns)
        notes.append(f'the stamps are the first one and then {stamps.rate_hz:g} Hz')
    if stamps.on_repeat == 'spread':
        imu = _spread(imu, notes)
    return imu, notes


def odd_samples(imu):
    """Return notes on irregular samples of a RecordedImu that a conversion keeps unchanged."""
    steps, (no_force, in_part) = np.diff(imu.t_ns), _zero_forces(imu)
    odd = {'that are not finite': ~_finite(imu),
           f'beyond {FORCE_M_S2:g} m/s^2 or {RATE_RAD_S:g} rad/s': _spikes(imu),
           'whose specific force is exactly zero': no_force if in_part else False,
           'with the stamp of the one before': steps == 0,
           'with a stamp that goes back': steps < 0}
    found = [f'{np.count_nonzero(which)} {what}' for what, which in odd.items() if np.any(which)]
    return [f'kept as they are: of {len(imu)} samples {", ".join(found)}'] if found else []


def _spread(imu, notes):
    """Return the samples; those with equal stamps are spread evenly up to the next stamp."""
    t_ns = imu.t_ns
    first = np.flatnonzero(np.append(True, np.diff(t_ns) != 0))
    count = np.diff(np.append(first, len(t_ns)))
    if len(first) < 2 or count.max() < 2:
        return imu
    until = np.append(t_ns[first[1:]], t_ns[first[-1]] + int(np.median(np.diff(t_ns[first]))))
    step = np.maximum(until - t_ns[first], 0) / count
    inside = np.arange(len(t_ns)) - np.repeat(first, count)
    notes.append(f'{len(t_ns) - len(first)} repeated stamps are spread up to the next one')
    return replace(imu, t_ns=t_ns + (inside * np.repeat(step, count)).astype(np.int64))


def _finite(imu):
    """Return whether all values of a sample are finite, (n,)."""
    return np.isfinite(imu.f).all(axis=1) & np.isfinite(imu.omega).all(axis=1)


def _spikes(imu):
    """Return whether a sample is finite but has a component beyond its bound, (n,)."""
    return _finite(imu) & ((np.abs(imu.f) > FORCE_M_S2).any(axis=1)
                           | (np.abs(imu.omega) > RATE_RAD_S).any(axis=1))


def _zero_forces(imu):
    """Return where the force is exactly zero, (n,), and whether too often to be rounding."""
    zero = (imu.f == 0.0).all(axis=1)
    return zero, _PART <= np.count_nonzero(zero) / max(len(imu), 1) <= 1.0 - _PART


def _without_spikes(imu, notes):
    for name, values, most, unit in (('specific force', imu.f, FORCE_M_S2, 'm/s^2'),
                                     ('angular rate', imu.omega, RATE_RAD_S, 'rad/s')):
        # Comparisons with NaN are false; samples that are not finite are counted elsewhere.
        size = np.abs(values).max(axis=1, initial=0.0)
        bad = (size > most) & np.isfinite(size)
        if bad.any():
            k = int(np.argmax(bad))
            notes.append(f'{np.count_nonzero(bad)} readings of the {name} beyond {most:g} {unit} '
                         f'dropped, the first at {seconds(imu.t_ns[k])}: {size[k]:.6g} {unit}')
    return imu[~_spikes(imu)]


def without_zeros(imu, zero_readings, notes):
    """
    Return the samples without those in which only rates or only forces were sent.

    zero_readings and errors: see ``checked_samples``; notes: list to which a note is appended.
    """
    no_force, in_part = _zero_forces(imu)
    if zero_readings == 'keep' or not in_part:
        return imu
    count, no_rate = len(imu), (imu.omega == 0.0).all(axis=1)
    # A gyro at rest may read exactly zero now and then. The two are sent alternately only if the
    # rate is zero in nearly all samples with a force.
    in_turns = np.count_nonzero(no_rate & ~no_force) > 0.9 * np.count_nonzero(~no_force)
    what = (f'the specific force is exactly zero in {np.count_nonzero(no_force)} of {count} '
            'samples' + (f' and the angular rate in {np.count_nonzero(no_rate)} others'
                         if in_turns else ''))
    if zero_readings == 'refuse':
        raise ValueError(f'{what}: the driver seems to send them alternately; expected both in '
                         'each sample (accept.zero_readings:=fill interpolates them between their '
                         'neighbours, keep uses them as they are)')
    notes.append(f'{what}: interpolated linearly between their neighbours')
    omega = _filled(imu.t_ns, imu.omega, no_rate & ~no_force) if in_turns else imu.omega
    return replace(imu, f=_filled(imu.t_ns, imu.f, no_force), omega=omega)


def _filled(t_ns, values, missing):
    t_s = (t_ns - t_ns[0]) * 1e-9
    return np.stack([np.interp(t_s, t_s[~missing], column[~missing]) for column in values.T],
                    axis=-1)
