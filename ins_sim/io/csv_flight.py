"""Read a recorded flight from a CSV file, plain or gzip."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.attitude.angles import from_compass
from ins_sim.core.attitude.interpolation import continuous_quaternions
from ins_sim.core.motion.recorded.poses import RecordedPoses
from ins_sim.settings.place import HIGHEST_M
from .csv_table import LONGEST_STAMP_S, nanoseconds, Table

# The splines are of latitude and longitude, which end at the poles; hence 89.9.  The heights keep
# out sentinels (-9999).
USED = {'lat_deg': (-89.9, 89.9), 'lon_deg': (-180.0, 360.0), 'height_m': (-1000.0, HIGHEST_M),
        'roll_deg': (-180.0, 180.0), 'pitch_deg': (-90.0, 90.0), 'heading_deg': (-180.0, 360.0)}
UNUSED = ('vn_mps', 've_mps', 'vd_mps')
REQUIRED = ('t_s', *USED, *UNUSED)
OPTIONAL = ('att_gap',)


@dataclass(frozen=True)
class RecordedRows:
    """
    Rows of a file, (n,) each.

    t_ns int64, the file's own stamps; degrees and metres as in the file, longitude unwrapped;
    resolution: the rounding step of lat_deg, lon_deg, height_m in their units.
    """

    path: str
    t_ns: np.ndarray
    lat_deg: np.ndarray
    lon_deg: np.ndarray
    height_m: np.ndarray
    roll_deg: np.ndarray
    pitch_deg: np.ndarray
    heading_deg: np.ndarray
    resolution: tuple[float, float, float]


def read_rows(path):
    """
    Return the RecordedRows of a file.

    Raises ValueError, one sentence with file, line, time, what was found and what was expected,
    on a file that cannot be read, is no such table, or holds a value that is no such quantity.
    """
    path = str(path)
    table = Table(path, REQUIRED, OPTIONAL)
    stamps = table.texts('t_s')
    if not stamps:
        raise ValueError(f'{path} has a header and no rows; expected a recorded flight')
    t_s = table.numbers('t_s', (-LONGEST_STAMP_S, LONGEST_STAMP_S))
    values = {name: table.numbers(name, bounds) for name, bounds in USED.items()}
    for name in UNUSED:
        table.numbers(name, (-1e5, 1e5), blank=True)
    return RecordedRows(
        path=path, t_ns=nanoseconds(stamps, t_s),
        **{name: np.unwrap(x, period=360.0) if name == 'lon_deg' else x
           for name, x in values.items()},
        resolution=tuple(_resolution(table.texts(name), values[name])
                         for name in ('lat_deg', 'lon_deg', 'height_m')))


def _decimals(text):
    """Return the number of decimals a text shows: 3 for 12.345 and for 1.2345e1."""
    mantissa, _, exponent = text.strip().lower().partition('e')
    return len(mantissa.partition('.')[2]) - int(exponent or 0)


def _resolution(texts, values):
    """
    Return the step to which a column is rounded; 0 for a constant one, which makes no noise.

    The last decimal any field shows (writers drop trailing zeros, hence the maximum); the
    spacing of float32 if all values are float32 numbers printed to more decimals than they have.
    """
    if values.min() == values.max():
        return 0.0
    step = 10.0 ** -max(map(_decimals, texts))
    single = values.astype(np.float32)
    spacing = float(np.spacing(np.abs(single).max()))
    if step < 0.25 * spacing and np.all(np.abs(single - values) <= 0.51 * step + 1e-15):
        return spacing
    return step


def read_poses(path):
    """Return the RecordedPoses of a CSV file; ValueError as ``read_rows``."""
    rows = read_rows(path)
    q_nb = from_compass(*(np.radians(a) for a in (rows.roll_deg, rows.pitch_deg,
                                                  rows.heading_deg)))
    return RecordedPoses(rows.path, rows.t_ns, rows.lat_deg, rows.lon_deg, rows.height_m,
                         continuous_quaternions(q_nb), rows.resolution)
