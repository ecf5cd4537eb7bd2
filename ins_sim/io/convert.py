"""Convert recorded flights, truth and IMU samples between bags and CSV files."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import check_target
from ins_sim.bags.storages import is_bag
from ins_sim.bags.windows import write_windows
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.recorded.spline import PAD_S, RecordedMotion
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.postprocessing.sample_checks import odd_samples, stamped_samples
from ins_sim.messages import convert as blocks
from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND
from ins_sim.settings.catalogue import values_of
from ins_sim.settings.recorded_imu import ConvertSettings
from ins_sim.settings.shown import listed
from . import bag_imu, csv_flight, csv_imu, csv_writer
from .bag_truth import read_poses
from .csv_text import is_csv, SUFFIXES
from .topic_choice import choose_topic, short_names
from .whole_file import check_file

WINDOW = 4096
# In 2005; earlier stamps are not absolute times of a recording, s.
OLDEST_S = 1104537600


def convert_recording(source, target, settings, topic=None, storage='mcap', compression='none',
                      force=False, imu=None):
    """
    Convert a bag to a CSV file or a CSV file to a bag; return a sentence on what was written.

    Parameters
    ----------
    source, target : paths; one is a bag and the other a CSV file
    settings : MotionGeneratorSettings; flights use motion.recording, datum, rate_hz, time.epoch_s
    topic : topic of the bag; None for truth/odometry if it exists, else the only Imu topic
    storage, compression : see BagWriter
    force : replace an existing target
    imu : ConvertSettings, how an IMU is read

    Raises
    ------
    ValueError, OSError
        If source, target or topic cannot be used.
    """
    source, target, imu = Path(source), Path(target), imu or ConvertSettings()
    if not source.exists():
        raise FileNotFoundError(f'{source} does not exist; expected a rosbag2 bag or a CSV file')
    from_bag, to_csv = is_bag(source), is_csv(target)
    if not from_bag and not is_csv(source):
        raise ValueError(f'{source} is neither a bag nor named '
                         f'{" or ".join(SUFFIXES)}')
    if from_bag != to_csv:
        raise ValueError(f'{source} and {target} are both {"bags" if from_bag else "CSV files"}; '
                         'expected a bag and a CSV file')
    if from_bag:
        check_file(target, force)
        return _to_csv(source, target, settings, topic, imu)
    check_target(target, storage, compression, force)
    how = dict(storage=storage, compression=compression, replace=force)
    if csv_imu.is_imu(source, imu.columns):
        return _imu_to_bag(source, target, settings, topic, how, imu)
    if topic is not None:
        raise ValueError(f'--topic is {topic}, but {source} is a recorded flight, which becomes '
                         'the topics truth/*; expected no --topic')
    return _flight_to_bag(source, target, settings, how)


def _to_csv(source, target, settings, topic, chosen):
    with open_bag(source) as bag:
        types = [topics.ODOMETRY, topics.IMU]
        wanted = 'auto' if topic is None else topic
        name = choose_topic(bag, types[:1] if topic is None else types, wanted, '--topic',
                            topics.TRUTH_ODOMETRY.name, needed=topic is not None)
        if name is None:
            if not any(c.type_name == topics.IMU for c in bag.topics.values()):
                raise ValueError(f'{source} has neither a {short_names(types[:1])} whose name '
                                 f'ends in {topics.TRUTH_ODOMETRY.name} nor a '
                                 f'{short_names(types[1:])}; it has '
                                 f'{listed(sorted(bag.topics)) or "no topic"}')
            name = choose_topic(bag, types[1:], wanted, '--topic', needed=True)
        if bag.topics[name].type_name == topics.IMU:
            imu, _, notes = bag_imu.read_imu_messages(bag, name, chosen)
            imu, more = stamped_samples(imu, chosen.stamps)
            csv_writer.write_imu(target, imu)
            return '\n'.join([f'{target} with {len(imu)} samples of {name}', *notes, *more,
                              *odd_samples(imu)])
    poses = read_poses(source, name, settings.datum, '--topic', settings.motion.recording.origin)
    csv_writer.write_flight(target, poses)
    return '\n'.join([f'{target} with {len(poses.t_ns)} rows of {name}', *poses.notes])


def _imu_to_bag(source, target, settings, topic, how, chosen):
    imu, notes = csv_imu.read_imu(source, chosen.columns, chosen.units)
    imu, more = stamped_samples(imu, chosen.stamps)
    stamps_ns = imu.t_ns + _offset_ns(settings)
    notes += _check_stamps(source, stamps_ns, settings)
    written = topics.IMU_RAW.named(settings.frames.names())
    written = written if topic is None else replace(written, name=topic)
    values = np.concatenate([imu.omega, imu.f], axis=1)
    counts = write_windows(target, {topics.IMU_RAW: written}, (
        {topics.IMU_RAW: (stamps_ns[k:k + WINDOW], values[k:k + WINDOW])}
        for k in range(0, len(imu), WINDOW)), **how)
    return _told(target, counts, *notes, *more, *odd_samples(imu))


def _flight_to_bag(source, target, settings, how):
    """Write the four truth topics, from the first row (3 s before start_s) to the last."""
    recording = replace(settings.motion.recording, path=str(source))
    motion = RecordedMotion(csv_flight.read_poses(source, values_of(recording.columns)), recording,
                            settings.earth)
    frame, names = MapFrame(settings.datum, settings.earth.rotation), settings.frames.names()
    pad_ns, step_ns = round(PAD_S * SECOND), period_ns(settings.rate_hz)
    count = (round(motion.end_s * SECOND) + 2 * pad_ns) // step_ns + 1
    offset_ns = motion.zero_ns + _offset_ns(settings)
    notes = _check_stamps(source, np.array([-pad_ns, (count - 1) * step_ns - pad_ns]) + offset_ns,
                          settings)

    def windows():
        for k in range(0, count, WINDOW):
            # Written window by window, because a long flight at a high rate exceeds the memory.
            truth = motion.at(step_ns * np.arange(k, min(k + WINDOW, count)) - pad_ns)
            yield {topic: (truth.t_ns + offset_ns, values)
                   for topic, values in blocks.truth_blocks(frame, truth).items()}

    written = {topic: topic.named(names) for topic in topics.TRUTH}
    counts = write_windows(target, written, windows(), **how)
    return _told(target, counts, *motion.warnings, *notes)


def _offset_ns(settings):
    """Return the time that is added to the stamps of a recording, ns."""
    if settings.time.epoch == 'now':
        raise ValueError('time.epoch is now; expected auto, or fixed, which adds time.epoch_s to '
                         'the stamps of a recording')
    return settings.time.epoch_s * SECOND if settings.time.given else 0


def _check_stamps(source, stamps_ns, settings):
    """Return notes about the stamps; raise ValueError if a bag cannot hold them."""
    first_s = stamps_ns.min() / SECOND
    if first_s < 0:
        raise ValueError(f'{source} begins at {first_s:.9g} s; expected 0 s or later in a bag '
                         '(time.epoch_s is added)')
    if first_s >= OLDEST_S or settings.time.given:
        return []
    return [f'its stamps begin at {first_s:.9g} s, before 2005, as in {source}; TF and other '
            'tools may regard this as a clock that was never set; -p time.epoch:=fixed adds '
            f'{settings.time.epoch_s} s (time.epoch_s)']


def _told(target, counts, *more):
    return '\n'.join([f'{target} with ' + ', '.join(
        f'{count} messages on {name}' for name, count in counts.items()), *more])
