"""Read records of gyros under a known motion: a run, a bag, or a CSV file of an IMU."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.storages import is_bag
from ins_sim.core.calibration.bench_record import BenchRecord
from ins_sim.core.numerics.instants import period_ns, seconds
from ins_sim.core.postprocessing.imu_record import ordered_samples
from ins_sim.core.postprocessing.sample_checks import stamped_samples
from ins_sim.core.sensors.imu.triad_model import triad_model
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.messages import topics
from ins_sim.settings.imu import ImuSensorSettings
from ins_sim.settings.motion import MotionSettings
from . import bag_imu, csv_imu
from .csv_text import is_csv
from .motion import read_motion
from .topic_choice import choose_topic

# Relative difference above which two rates count as different.
RATES_ALIKE = 0.01
# Latest motion time, s.
LONGEST_S = 1e7
TUNED = ('channels of tuned gyros also respond to changes of the rates about other axes, which '
         'look like a delay if the rates change together; rock about each body axis in turn')
HOW = ('give it by motion.*, such as "-p motion.kind:=rocking", or motion.kind recording with '
       'the reference in motion.recording.path')


def is_named(group, names, value, default):
    """
    Return whether the user gave a parameter or group, by name or by a value that is not default.

    group is a name such as ``rate_hz``, or a prefix such as ``motion.``; names are the parameters
    that were given one by one, some as NODE:NAME.
    """
    own = [name.rpartition(':')[2] for name in names]
    return value != default or any(
        name.startswith(group) if group.endswith('.') else name == group for name in own)


def record_of_run(name, settings, imu, motion=None):
    """
    Return the BenchRecord of a run of ``simulate``, and notes (sentences).

    settings and imu are the SimulationSettings and the ImuSamples of the run, motion its Motion,
    by default that of the settings. Raises ValueError if the settings do not define the motion,
    or if the samples have another rate.
    """
    _check_rate(name, imu.t_ns, settings.imu_sensor.rate_hz)
    record = _record(name, imu, period_ns(settings.imu_sensor.rate_hz),
                     motion or _known_motion(settings.motion_generator), settings)
    return record, (TUNED,) if settings.imu_sensor.gyro.model == 'dtg' else ()


def read_record(path, settings, imu_settings, names=(), topic=None):
    """
    Return the BenchRecord of a bag or a CSV file, and notes (sentences).

    Parameters
    ----------
    path : path of the file or folder
    settings : SimulationSettings with the motion, the place, the output mode and the white noise
    imu_settings : ConvertSettings, how an IMU is read
    names : parameters that were given one by one. If neither they nor the settings name a motion,
        the truth in the bag is used; if they name no rate, that of the stamps is used
    topic : topic of the Imu messages in a bag, or None for the only one

    Raises
    ------
    ValueError, OSError
        If the record or its motion cannot be used.
    """
    path = Path(path)
    if not path.exists():
        raise FileNotFoundError(f'{path} does not exist; expected a run of "ins_sim simulate", a '
                                'rosbag2 bag or a CSV file')
    if is_csv(path):
        if topic is not None:
            raise ValueError(f'--topic is {topic}, but {path} is not a bag; expected no --topic')
        recorded, notes = csv_imu.read_imu(path, imu_settings.columns, imu_settings.units)
    elif is_bag(path):
        with open_bag(path) as bag:
            found = _imu_topic(bag, topic)
            recorded, _, notes = bag_imu.read_imu_messages(bag, found, imu_settings)
    else:
        raise ValueError(f'{path} is not usable; expected a run of "ins_sim simulate", a rosbag2 '
                         'bag, or a CSV file named .csv or .csv.gz')
    recorded, more = stamped_samples(recorded, imu_settings.stamps)
    recorded, losses = ordered_samples(recorded)
    notes = [*notes, *more]
    for count, what in ((losses.not_finite, 'are not finite'),
                        (losses.repeated, 'have the stamp of the one before'),
                        (losses.out_of_order, f'are out of order{losses.first_back}')):
        if count:
            notes.append(f'{path}: {count} readings {what} and are left out')
    rate_hz, motion_settings = settings.imu_sensor.rate_hz, settings.motion_generator.motion
    if is_named('rate_hz', names, rate_hz, ImuSensorSettings().rate_hz):
        _check_rate(path, recorded.t_ns, rate_hz)
    named = is_named('motion.', names, motion_settings, MotionSettings())
    motion, zero_ns, note = _motion(path, settings, named, int(recorded.t_ns[0]))
    imu = ImuSamples(recorded.t_ns - zero_ns, recorded.omega, recorded.f)
    return _record(path.name, imu, round(recorded.step_ns), motion, settings), (*notes, note)


def _imu_topic(bag, topic):
    """Return the name of the Imu topic; by default imu/data_raw if there are several."""
    if topic is None:
        raw = [c.name for c in bag.topics.values() if c.type_name == topics.IMU
               and f'/{c.name}'.endswith(f'/{topics.IMU_RAW.name}')]
        topic = raw[0] if len(raw) == 1 else 'auto'
    return choose_topic(bag, [topics.IMU], topic, '--topic', needed=True)


def _record(name, imu, dt_ns, motion, settings):
    sensor, generator = settings.imu_sensor, settings.motion_generator
    white = (0.0, 0.0, 0.0)
    if sensor.gyro.model == 'ideal':
        white = triad_model(sensor.gyro.errors, dt_ns * 1e-9, 'gyro.errors').white
    return BenchRecord(name, imu, dt_ns, motion, generator.datum, generator.earth, sensor.output,
                       white)


def _check_rate(name, t_ns, rate_hz):
    """Raise ValueError if the samples have another rate than the given one."""
    if len(t_ns) > 1:
        found = 1e9 / max(float(np.median(np.diff(t_ns))), 1.0)
        if abs(found / rate_hz - 1.0) > RATES_ALIKE:
            raise ValueError(f'{name} has {found:.6g} readings a second by its stamps, but '
                             f'rate_hz is {rate_hz:.6g} Hz; expected the rate of the record')


def _known_motion(generator):
    if generator.motion.kind == 'guided':
        raise ValueError('motion.kind is guided, which is steered during the run; expected a '
                         'motion that is known beforehand, or a bag with the truth')
    return read_motion(generator)


def _motion(path, settings, named, first_ns):
    """Return the Motion, the stamp of motion time zero, ns, and a note about it."""
    generator = settings.motion_generator
    if not named and is_csv(path):
        raise ValueError(f'{path} does not contain the motion of the bench; {HOW}')
    if not named:
        recording = replace(generator.motion.recording, path=str(path))
        generator = replace(generator, motion=MotionSettings(kind='recording',
                                                             recording=recording))
        try:
            motion = read_motion(generator)
        except ValueError as error:
            raise ValueError(f'{error}; expected the motion of the bench as truth in the bag, or '
                             f'{HOW}') from None
        return motion, motion.zero_ns, f'{path}: the motion is the truth in the bag'
    motion = _known_motion(generator)
    if generator.motion.kind == 'recording':
        return motion, motion.zero_ns, (f'{path}: the stamps are assumed to be on the clock of '
                                        f'{generator.motion.recording.path}')
    epoch_ns = 1_000_000_000 * generator.time.epoch_s
    zero_ns = epoch_ns if generator.time.given or first_ns >= epoch_ns else 0
    if not 0 <= first_ns - zero_ns <= LONGEST_S * 1e9:
        raise ValueError(f'{path} begins at {seconds(first_ns)}, '
                         f'{(first_ns - zero_ns) * 1e-9:.9g} s from motion time zero; expected 0 '
                         f'to {LONGEST_S:g} s: set time.epoch to fixed and time.epoch_s to the '
                         'stamp of motion time zero')
    return motion, zero_ns, (f'{path}: motion time zero is the stamp {seconds(zero_ns)}; an error '
                             'of this stamp appears as an equal delay of all channels')
