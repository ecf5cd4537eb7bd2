"""Recorded flights written for the tests of splines."""

import dataclasses

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ins_sim.settings.place import Earth
from ins_sim.settings.motion import Recording
from ins_sim.core.motion.recorded.spline import RecordedMotion
from ins_sim.io.csv_flight import read_poses, COLUMNS

HEADER = ','.join(COLUMNS)


def write(path, t, lat=55.0, lon=37.0, height=100.0, roll=0.0, pitch=0.0, heading=0.0,
          digits='.17g'):
    """Write columns in the units of the file; scalars are repeated; return the path as text."""
    columns = np.broadcast_arrays(t, lat, lon, height, roll, pitch, heading)
    lines = [','.join(COLUMNS)]
    lines += [','.join([*(format(x, digits) for x in row), '', '', '']) for row in zip(*columns)]
    path.write_text('\n'.join(lines) + '\n')
    return str(path)


def load(path, rotation=True, **keys):
    return RecordedMotion(read_poses(path), Recording(path=str(path), **keys),
                          Earth(rotation=rotation))


def recorder_angles(q):
    """Return roll, pitch, heading, deg, of q_nb (n, 4), computed independently of the package."""
    c = Rotation.from_quat(q).as_matrix()
    return np.degrees([np.arctan2(c[:, 2, 1], c[:, 2, 2]), np.arcsin(c[:, 2, 0]),
                       np.arctan2(c[:, 0, 0], c[:, 1, 0])])


def record(path, motion, rate_hz, duration_s):
    """Write a closed-form motion as its recorder would, without rounding."""
    t_ns = np.arange(round(duration_s * rate_hz) + 1) * round(1e9 / rate_hz)
    x = motion.at(t_ns)
    roll, pitch, heading = recorder_angles(x.q_nb)
    return write(path, t_ns * 1e-9, np.degrees(x.lat), np.degrees(x.lon), x.height, roll, pitch,
                 heading % 360.0)


def same(a, b):
    return all(np.array_equal(getattr(a, f.name), getattr(b, f.name))
               for f in dataclasses.fields(a))


def rows(n=101, interval_s=0.1):
    """Return the fields of a level flight north at 40 m/s, as lists of text."""
    return [[f'{k * interval_s:.3f}', f'{55.0 + k * interval_s * 40.0 / 111e3:.9f}', '37.0',
             '100.0', '1.0', '2.0', '3.0', '', '', ''] for k in range(n)]


def save(path, table, header=HEADER):
    path.write_text('\n'.join([header, *(','.join(row) for row in table)]) + '\n')
    return path


def refusal(path, **keys):
    """Return the message with which the file is refused."""
    with pytest.raises((ValueError, FileNotFoundError)) as caught:
        RecordedMotion(read_poses(path), Recording(path=str(path), **keys), Earth())
    sentence = str(caught.value)
    assert '\n' not in sentence and len(sentence) < 900
    return sentence


def accepted(path, **keys):
    return RecordedMotion(read_poses(path), Recording(path=str(path), **keys), Earth())
