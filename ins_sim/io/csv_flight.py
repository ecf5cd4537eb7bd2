"""Read a recorded flight from a CSV file, plain or gzip."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.attitude.angles import from_compass
from ins_sim.core.attitude.interpolation import continuous_quaternions
from ins_sim.core.motion.recorded.poses import RecordedPoses
from ins_sim.settings.place import HIGHEST_M
from .csv_table import CsvTable

# Splines of latitude and longitude fail at the poles, hence 89.9. The height limits exclude
# sentinels such as -9999.
USED = {'lat_deg': (-89.9, 89.9), 'lon_deg': (-180.0, 360.0), 'height_m': (-1000.0, HIGHEST_M),
        'roll_deg': (-180.0, 180.0), 'pitch_deg': (-90.0, 90.0), 'heading_deg': (-180.0, 360.0)}
# Angles that may be unwrapped; they are brought into the range above. The limit of ten turns
# excludes sentinels such as -9999.
WRAPPED = ('roll_deg', 'pitch_deg', 'heading_deg')
MOST_DEG = 3600.0
UNUSED = ('vn_mps', 've_mps', 'vd_mps')
REQUIRED = ('t_s', *USED)
COLUMNS = (*REQUIRED, *UNUSED)


@dataclass(frozen=True)
class RecordedRows:
    """
    Columns of a file, (n,) each.

    t_ns holds the stamps of the file (int64); angles and heights are in degrees and metres as in
    the file, with the longitude unwrapped; resolution holds the rounding steps of lat_deg, lon_deg
    and height_m in their units; notes are sentences on skipped, unused or changed data.
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
    notes: tuple = ()


def read_rows(path, columns=None, key='motion.recording.columns'):
    """
    Return the RecordedRows of a file.

    columns is {name: header of the column}, with empty texts for columns that are found by their
    names; key is the parameter that gives them.

    Raises ValueError, with file, line, time, value and expectation, if the file cannot be read,
    is not such a table, or holds an invalid value.
    """
    path = str(path)
    table = CsvTable(path, REQUIRED, UNUSED, columns, key=key)
    if not table.rows:
        raise ValueError(f'{path} has a header but no rows; expected a recorded flight')
    notes, values = list(table.notes), {}
    t_ns = table.stamps_ns()
    for name, bounds in USED.items():
        wide = (-MOST_DEG, MOST_DEG) if name in WRAPPED else bounds
        values[name] = table.numbers(name, wide)
        if name in WRAPPED:
            values[name] = _wrapped(table, name, values[name], bounds, notes)
    for name in UNUSED:
        if name in table:
            table.numbers(name, (-1e5, 1e5), blank=True)
    return RecordedRows(
        path=path, t_ns=t_ns,
        **{name: np.unwrap(x, period=360.0) if name == 'lon_deg' else x
           for name, x in values.items()},
        resolution=tuple(_resolution(table, name, values[name])
                         for name in ('lat_deg', 'lon_deg', 'height_m')), notes=tuple(notes))


def _wrapped(table, name, values, bounds, notes):
    """Return angles wrapped into their bounds by whole turns; add a note if any changed."""
    low, high = bounds
    beyond = (values < low) | (values > high)
    if not beyond.any():
        return values
    turned = np.where(beyond, (values + 180.0) % 360.0 - 180.0, values)
    if not ((turned >= low) & (turned <= high)).all():
        # A pitch of 100 degrees is invalid with any number of turns; the message names the row.
        table.numbers(name, bounds)
    notes.append(f'{table.path}: {np.count_nonzero(beyond)} values of {name} outside {low:g}..'
                 f'{high:g} are wrapped into this range by whole turns')
    return turned


def _decimals(text):
    """Return the number of decimals a text shows: 3 for 12.345 and for 1.2345e1."""
    mantissa, _, exponent = text.strip().lower().partition('e')
    return len(mantissa.partition('.')[2]) - int(exponent or 0)


def _resolution(table, name, values):
    """
    Return the step to which a column is rounded; 0 for a constant one, which adds no noise.

    It is one unit of the last decimal of the field with the most decimals (writers drop trailing
    zeros), or the spacing of float32 numbers if all values are such numbers, printed with more
    decimals than float32 resolves.
    """
    if values.min() == values.max():
        return 0.0
    step = 10.0 ** -max(map(_decimals, table.texts(name))) * table.factor(name)
    single = values.astype(np.float32)
    spacing = float(np.spacing(np.abs(single).max()))
    if step < 0.25 * spacing and np.all(np.abs(single - values) <= 0.51 * step + 1e-15):
        return spacing
    return step


def read_poses(path, columns=None, key='motion.recording.columns'):
    """Return the RecordedPoses of a CSV file; arguments and errors as in ``read_rows``."""
    rows = read_rows(path, columns, key)
    q_nb = from_compass(*(np.radians(a) for a in (rows.roll_deg, rows.pitch_deg,
                                                  rows.heading_deg)))
    return RecordedPoses(rows.path, rows.t_ns, rows.lat_deg, rows.lon_deg, rows.height_m,
                         continuous_quaternions(q_nb), rows.resolution, notes=rows.notes)
