"""Titles that describe a simulation, such as 'Racetrack flight, tactical FOG, 100 Hz, 1 h'."""

from dataclasses import fields
from pathlib import Path

from ins_sim.settings.catalogue import values_of
from ins_sim.settings.imu import ImuSensorSettings
from ins_sim.settings.presets import ACCELEROMETER, GYRO, PRESETS, ROTORS

MOTIONS = {'static': 'At rest', 'two_axis': 'Two-axis rotation (motion 2)', 'coning': 'Coning',
           'sculling': 'Sculling', 'sinusoids': 'Sinusoidal motion',
           'harmonics': 'Periodic motion', 'cruise': 'Cruise flight',
           'racetrack': 'Racetrack flight', 'aggressive': 'Aggressive flight',
           'route': 'Route flight', 'guided': 'Guided flight'}
INSTRUMENTS = {'tactical_mems': 'tactical MEMS', 'tactical_fog': 'tactical FOG',
               'navigation_rlg': 'navigation RLG', 'tactical_dtg': 'tactical DTG'}
ERRORS = (GYRO, ACCELEROMETER, ROTORS, 'gyro.dtg.fault.', 'gyro.model', 'sampling.')
# An IMU is named after a preset if at most this number of its errors differ from it.
FEW = 3


def title(settings):
    """Return a line that names motion, instrument, delays, rate and length of a simulation."""
    generator, sensor = settings.motion_generator, settings.imu_sensor
    parts = [motion_words(generator.motion), instrument_words(sensor), *delay_words(sensor),
             f'{sensor.rate_hz:g} Hz']
    if generator.duration_s:
        parts.append(length_words(generator.duration_s))
    return ', '.join(parts)


def motion_words(motion):
    """Return the name of the motion of MotionSettings."""
    if motion.kind == 'recording':
        return f'Recorded flight {Path(motion.recording.path).name}'
    if motion.kind == 'rocking':
        axis = motion.rocking.axis
        about = f'body axis {axis}' if axis in 'xyz' else axis
        return f'Rocking about {about}' + (' (motion 1)' if axis == 'north' else '')
    # A motion defined by the user has the name of its kind.
    return MOTIONS.get(motion.kind, motion.kind)


def instrument_words(sensor):
    """Return the name of the IMU of ImuSensorSettings: that of its preset if it has one."""
    values, ideal = _errors(sensor), _errors(ImuSensorSettings())
    if values == ideal:
        return 'ideal IMU'
    for name, preset in PRESETS.items():
        expected = {**ideal, **{key: value for key, value in preset.values.items()
                                if key.startswith(ERRORS)}}
        changed = [key for key in values if values[key] != expected[key]]
        if len(changed) <= FEW:
            return INSTRUMENTS[name] + (
                f' with other {", ".join(_short(key) for key in changed)}' if changed else '')
    groups = {'dynamically tuned gyros': ('gyro.model', ROTORS, 'gyro.dtg.fault.'),
              'gyro errors': (GYRO,), 'accelerometer errors': (ACCELEROMETER,),
              'sampling errors': ('sampling.',)}
    there = [words for words, prefixes in groups.items()
             if any(values[key] != ideal[key] for key in values if key.startswith(prefixes))]
    return 'IMU with ' + ' and '.join(there)


def _errors(sensor):
    return {key: value for key, value in values_of(sensor).items() if key.startswith(ERRORS)}


def _short(key):
    """Return the name of a setting without its unit."""
    return key.removeprefix('gyro.errors.').replace('.errors', '').replace('_', ' ')


def delay_words(sensor):
    """Return words about the delays of ImuSensorSettings: a list of zero to two entries."""
    found = []
    for name in ('gyro', 'accelerometer'):
        delays = getattr(sensor, name).delay_us
        late = [f'{f.name} {getattr(delays, f.name):g}' for f in fields(delays)
                if getattr(delays, f.name)]
        if late:
            found.append(f'{name} delays {", ".join(late)} us' if len(late) > 1 else
                         f'{name} delay {late[0]} us')
    return found


def length_words(seconds):
    """Return a duration in a convenient unit: 1 h, 50 min, 90 s."""
    for unit, size in (('h', 3600.0), ('min', 60.0)):
        amount = round(seconds / size, 2)
        if amount >= 1.0 and abs(amount * size - seconds) < 1e-6 * seconds:
            return f'{amount:g} {unit}'
    return f'{seconds:g} s'
