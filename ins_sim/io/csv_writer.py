"""Write CSV files whose numbers are exact to the last bit, as csv_flight and csv_imu read."""

import gzip
from pathlib import Path

import numpy as np

from ins_sim.core.attitude.angles import to_compass, within_half_turn_deg
from ins_sim.core.numerics.instants import seconds
from . import csv_flight, csv_imu
from .whole_file import write_whole


def write_flight(path, poses):
    """Write RecordedPoses with velocity and replace an existing file.  Raises OSError."""
    lon = within_half_turn_deg(poses.lon_deg)
    east, north, up = poses.v_n.T
    values = (poses.lat_deg, lon, poses.height_m,
              *(np.degrees(a) for a in to_compass(poses.q_nb)), north, east, -up)
    _write(path, poses.t_ns, csv_flight.COLUMNS[1:], values)


def write_imu(path, imu):
    """Write a RecordedImu without orientation; replace an existing file.  Raises OSError."""
    _write(path, imu.t_ns, csv_imu.IMU, (*imu.omega.T, *imu.f.T))


def write_rows(path, names, blocks):
    """Write names and blocks of rows, each block given by its columns.  Raises OSError."""
    with open(path, 'w', encoding='utf-8') as file:
        file.write(','.join(names) + '\n')
        for block in blocks:
            file.writelines(f'{row}\n' for row in _rows(map(_texts, block)))


def _texts(column):
    """Return the numbers of a column as the shortest texts that are exact."""
    return map(repr, column.tolist())


def _rows(texts):
    return (','.join(row) for row in zip(*texts))


def _write(path, t_ns, names, values):
    """Write t_s, exact to the nanosecond, and columns."""
    path = Path(path)
    stamps = (seconds(t).removesuffix(' s') for t in t_ns.tolist())
    lines = [','.join(('t_s', *names)), *_rows([stamps, *map(_texts, values)]), '']
    data = '\n'.join(lines).encode()
    if path.name.endswith('.gz'):
        data = gzip.compress(data, mtime=0)
    write_whole(path, data)
