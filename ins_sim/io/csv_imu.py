"""Columns of a CSV file, plain or gzip: a recorded IMU and its reference."""

import numpy as np

from ins_sim.core.attitude.angles import from_compass
from ins_sim.core.attitude.interpolation import continuous_quaternions
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.postprocessing.reference import keep_rising, Reference, SampledTrack
from ins_sim.settings.suggest import nearest_name
from . import csv_table

IMU = ('gx_rps', 'gy_rps', 'gz_rps', 'ax_mps2', 'ay_mps2', 'az_mps2')
POSITION = ('lat_deg', 'lon_deg', 'height_m')
ATTITUDE = ('roll_deg', 'pitch_deg', 'heading_deg')
VELOCITY = ('ve_mps', 'vn_mps', 'vd_mps')


def read_columns(path, required):
    """
    Return {name: (n,) floats}, NaN where blank, and the stamps (n,) int64 ns of column t_s.

    Raises ValueError in one sentence with file and line where a required column is missing or a
    field is no number.
    """
    header, lines, rows = csv_table.read_table(path)
    for name in ('t_s', *required):
        if name not in header:
            raise ValueError(f'{path} has no column {name}; the nearest is '
                             f'{nearest_name(name, header)!r}; expected {", ".join(required)} '
                             'beside t_s')
    if not rows:
        raise ValueError(f'{path} has a header and no rows; expected samples')
    columns = {name: _floats(path, name, lines, texts)
               for name, texts in zip(header, zip(*rows))}
    if not np.isfinite(columns['t_s']).all():
        k = int(np.argmin(np.isfinite(columns['t_s'])))
        raise ValueError(f'{path}, line {lines[k]}: t_s is blank or not finite; expected a time')
    texts = [row[header.index('t_s')] for row in rows]
    return columns, csv_table.nanoseconds(texts, columns['t_s'])


def _floats(path, name, lines, texts):
    values = np.full(len(texts), np.nan)
    for k, text in enumerate(texts):
        try:
            if text and not text.isspace():
                values[k] = float(text)
        except ValueError:
            raise ValueError(f'{path}, line {lines[k]}: {name} is {text.strip()[:40]!r}; '
                             'expected a number or a blank') from None
    return values


def read_imu(path):
    """Return the RecordedImu of a CSV file with t_s, gx_rps.. and ax_mps2.., in its own axes."""
    columns, t_ns = read_columns(path, IMU)
    values = np.stack([columns[name] for name in IMU], axis=-1)
    return RecordedImu(t_ns, values[:, :3], values[:, 3:], np.full((len(t_ns), 4), np.nan))


def read_reference(path):
    """
    Return the Reference of a CSV file: position, and attitude and velocity where it has them.

    Columns as in a recorded flight (``csv_flight``); v_n is made of vn, ve, vd.
    """
    columns, t_ns = read_columns(path, POSITION)
    lat, lon, height = (columns[name] for name in POSITION)
    lon = np.unwrap(np.where(np.isfinite(lon), lon, 0.0), period=360.0) + 0.0 * lon
    tracks = {'position': _track(t_ns, np.stack([np.radians(lat), np.radians(lon), height], -1))}
    if all(name in columns for name in VELOCITY):
        east, north, down = (columns[name] for name in VELOCITY)
        tracks['velocity'] = _track(t_ns, np.stack([east, north, -down], axis=-1))
    if all(name in columns for name in ATTITUDE):
        angles = (np.radians(columns[name]) for name in ATTITUDE)
        track = _track(t_ns, from_compass(*angles))
        tracks['attitude'] = track and SampledTrack(track.t_ns,
                                                    continuous_quaternions(track.values))
    if tracks['position'] is None:
        raise ValueError(f'{path} has no row with {", ".join(POSITION)}; expected a reference')
    return Reference(str(path).rpartition('/')[2], **tracks)


def _track(t_ns, values):
    t_ns, values = keep_rising(t_ns, values)
    return SampledTrack(t_ns, values) if len(t_ns) else None
