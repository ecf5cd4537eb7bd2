"""Read the sensor_msgs/Imu messages of a topic of any bag."""

import numpy as np

from ins_sim.core.numerics.instants import seconds, unwrap_clock
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.settings.recorded_imu import ConvertSettings
from ins_sim.settings.shown import listed
from .csv_names import UNITS

# Unmeasured orientations are often all zero; a quaternion of another length is not a rotation.
_UNIT = 0.01


def read_imu_messages(bag, topic, settings=None):
    """
    Return RecordedImu, frame id and notes (sentences) of a topic, in the order recorded.

    settings are NavigateSettings or ConvertSettings (default). If all stamps are zero, log times
    are used. Raises ValueError if there is no message, more than one frame, or no angular rate or
    acceleration (REP-145), unless settings.accept allows it.
    """
    settings = settings or ConvertSettings()
    name, accept = f'{bag.path}: {topic}', settings.accept
    table = bag.arrays(topic)
    if not len(table):
        raise ValueError(f'{name} is empty; expected messages')
    notes = []
    _check_measured(name, table, accept, notes)
    frame = _frame(name, bag.frame_counts(topic), accept, notes)
    t_ns = _stamps(name, table, settings.stamps.source, bag.odd_stamps.get(topic, 0), notes)
    omega, f = (table[field] * _factor(kind, unit) for field, kind, unit in (
        ('angular_velocity', 'rate', settings.units.rate),
        ('linear_acceleration', 'force', settings.units.force)))
    return (RecordedImu(t_ns, omega, f, _orientation(name, table, accept, notes)),
            frame.lstrip('/'), notes)


def _factor(kind, unit):
    return 1.0 if unit == 'auto' else UNITS[kind][unit]


def _check_measured(name, table, accept, notes):
    said = {field: int(np.count_nonzero(table[f'{field}_covariance'][:, 0] == -1.0))
            for field in ('angular_velocity', 'linear_acceleration')}
    if not any(said.values()):
        return
    there = [field for field, count in said.items() if count and table[field].any()]
    what = ' and '.join(f'{count} messages have no {field}' for field, count in said.items()
                        if count)
    if not accept.unmeasured:
        raise ValueError(f'{name} states, by a covariance of -1, that it has no rate or no '
                         f'acceleration (REP-145): {what}; expected both'
                         + ('; the fields contain numbers all the same, which '
                            'accept.unmeasured:=true accepts' if there else ''))
    notes.append(f'{name}: by a covariance of -1 {what}; their numbers are used all the same')


def _frame(name, frames, accept, notes):
    """Return the frame id of the messages; the most frequent one if several are accepted."""
    count = {texts[0]: n for texts, n in frames.items()}
    usual = max(count, key=count.get)
    if len(count) > 1:
        said = listed((f'{frame!r} ({n} messages)' for frame, n in count.items()), 4)
        if not accept.frames:
            raise ValueError(f'{name} has the frames {said}; expected one IMU on a topic '
                             '(accept.frames:=true treats them as one)')
        notes.append(f'{name} has the frames {said}: all treated as {usual!r}')
    return usual


def _stamps(name, table, source, odd, notes):
    """Return the stamps, (n,) int64 ns, from the source in the settings."""
    t_ns = table['stamp_ns'].copy()
    if source == 'log':
        notes.append(f'{name}: the log times are used')
        return table['log_ns'].copy()
    if source == 'auto' and not t_ns.any():
        notes.append('the stamps of the IMU are all zero: the log times are used')
        return table['log_ns'].copy()
    if odd:
        notes.append(f'{name}: {odd} stamps have nanosec >= 1e9, which is added to their seconds')
    t_ns, note = unwrap_clock(t_ns)
    if note:
        notes.append(f'{name}: {note}')
    back = int(np.count_nonzero(np.diff(t_ns) < 0))
    if back:
        notes.append(f'{name}: the stamps go back {back} times; stamps.source:=log uses the log '
                     'times instead')
    return t_ns


def _orientation(name, table, accept, notes):
    """Return unit quaternions (n, 4), NaN for messages without orientation."""
    q = table['orientation'].copy()
    with np.errstate(over='ignore', invalid='ignore'):
        norm = np.linalg.norm(q, axis=1)
    there = (table['orientation_covariance'][:, 0] != -1.0) & np.isfinite(norm) & (norm > 1e-3)
    odd = there & (np.abs(norm - 1.0) >= _UNIT)
    if odd.any():
        k = int(np.argmax(odd))
        what = (f'{name}: {np.count_nonzero(odd)} orientations are not rotations, the first at '
                f'{seconds(table["stamp_ns"][k])} has the norm {norm[k]:.4g}: ')
        notes.append(what + ('normalised' if accept.orientations else
                             'not used (accept.orientations:=true normalises them)'))
    known = there if accept.orientations else there & ~odd
    q[~known] = np.nan
    q[known] /= norm[known, None]
    return q
