"""Read a recorded IMU, or a reference for it, from a CSV file, plain or gzip."""

import numpy as np

from ins_sim.core.attitude.angles import from_compass
from ins_sim.core.attitude.interpolation import continuous_quaternions
from ins_sim.core.numerics.instants import unwrap_clock
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.postprocessing.reference import keep_rising, Reference, SampledTrack
from ins_sim.settings.catalogue import values_of
from . import positions
from .csv_lines import read_lines
from .csv_names import ColumnFinder
from .csv_table import CsvTable

IMU = ('gx_rps', 'gy_rps', 'gz_rps', 'ax_mps2', 'ay_mps2', 'az_mps2')
POSITION = ('lat_deg', 'lon_deg', 'height_m')
ATTITUDE = ('roll_deg', 'pitch_deg', 'heading_deg')
VELOCITY = ('ve_mps', 'vn_mps', 'vd_mps')


def is_imu(path, columns):
    """
    Return whether a CSV file holds an IMU rather than a flight.

    columns are ImuColumns. Raises ValueError if the file is not a table.
    """
    table = read_lines(path)
    finder = ColumnFinder(f'{path}, line {table.header_line}', table.header, values_of(columns))
    return any(values_of(columns).values()) or finder.is_known(IMU[0])


def read_imu(path, columns=None, units=None):
    """
    Return the RecordedImu of a CSV file, in the axes of the file, and notes (sentences).

    columns and units are ImuColumns and RecordUnits; by default the columns are recognised by
    their names. Raises ValueError, with file and line, if a column is missing or a field is not a
    number.
    """
    table = CsvTable(str(path), ('t_s', *IMU), (), columns and values_of(columns),
                     units and values_of(units))
    t_ns, notes = _stamps(table, 'samples')
    values = np.stack([table.floats(name) for name in IMU], axis=-1)
    unknown = np.full((len(t_ns), 4), np.nan)
    return RecordedImu(t_ns, values[:, :3], values[:, 3:], unknown), [*table.notes, *notes]


def _stamps(table, expected):
    """Return the stamps of a table, (n,) int64 ns, with clock wraps undone, and notes."""
    if not table.rows:
        raise ValueError(f'{table.path} has a header but no rows; expected {expected}')
    t_ns, note = unwrap_clock(table.stamps_ns())
    return t_ns, [f'{table.path}: {note}'] if note else []


def read_reference(path, columns=None, keep_zero=False):
    """
    Return the Reference of a CSV file, and notes (sentences).

    It has the position, and attitude and velocity if the file has them. The columns are those of
    a recorded flight (``csv_flight``) and are given by FlightColumns; v_n is computed from vn, ve
    and vd. For keep_zero see ``positions.usable``.
    """
    table = CsvTable(str(path), ('t_s', *POSITION), (*ATTITUDE, *VELOCITY),
                     columns and values_of(columns), key='reference.columns')
    t_ns, notes = _stamps(table, 'a reference')
    lat, lon, height = (table.floats(name) for name in POSITION)
    good, dropped = positions.usable(lat, lon, height, keep_zero=keep_zero)
    notes = [*table.notes, *notes]
    if dropped:
        notes.append(positions.sentence(str(path), 'rows', len(good), dropped))
    tracks = {'position': _track(t_ns[good], positions.track(lat[good], lon[good],
                                                             height[good]))}
    if all(name in table for name in VELOCITY):
        east, north, down = (positions.plausible(f'{path}: {name}', table.floats(name),
                                                 positions.MOST_M_S, 'm/s', notes)
                             for name in VELOCITY)
        tracks['velocity'] = _track(t_ns, np.stack([east, north, -down], axis=-1))
    if all(name in table for name in ATTITUDE):
        angles = [np.radians(positions.plausible(f'{path}: {name}', table.floats(name),
                                                 positions.MOST_DEG, 'deg', notes))
                  for name in ATTITUDE]
        track = _track(t_ns, from_compass(*angles))
        tracks['attitude'] = track and SampledTrack(track.t_ns,
                                                    continuous_quaternions(track.values))
    if tracks['position'] is None:
        raise ValueError(positions.sentence(str(path), 'rows', len(good), dropped)
                         + f'; expected a reference with {", ".join(POSITION)}')
    return Reference(str(path).rpartition('/')[2], **tracks), notes


def _track(t_ns, values):
    t_ns, values = keep_rising(t_ns, values)
    return SampledTrack(t_ns, values) if len(t_ns) else None
