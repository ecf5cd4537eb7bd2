"""Write an offline run as a bag with the messages that the nodes would publish."""

from bisect import bisect_left, bisect_right

import numpy as np

from ins_sim.bags.windows import write_windows
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.navigation.sample_clock import SampleClock
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.with_errors import reported_variances
from ins_sim.core.sensors.tuned_gyro.instrument import PairInstrument
from ins_sim.core.sensors.tuned_gyro.parity import parity_rows
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.messages import convert, topics
from ins_sim.messages.cdr import SECOND
from ins_sim.messages.run_announcement import RunAnnouncement
from ins_sim.settings.suggest import nearest_name
from .environment import environment_topics, EnvironmentSensors
from .motion import read_motion
from .simulated_topics.aiding import AidingSource, message_columns
from .simulated_topics.covariance import CovarianceSource
from .simulated_topics.transforms import SimulatedTransforms

# Number of generator samples that are converted to messages at a time.
WINDOW = 4096
CLOCK_HZ = 100.0


def published_topics(settings, aided=False):
    """
    Return the Topics that the nodes publish, in the order of messages with equal stamps.

    aided includes velocity_meter, gnss and aided_navigator.
    """
    data = (topics.IMU_DATA,) if settings.strapdown.imu_data else ()
    clock = (topics.CLOCK_TOPIC,) if settings.motion_generator.publish_clock else ()
    parity = (topics.IMU_PARITY,) if settings.imu_sensor.gyro.model == 'dtg' else ()
    around = environment_topics(settings.imu_sensor)
    guidance = topics.GUIDANCE if settings.motion_generator.motion.kind == 'guided' else ()
    transforms = () if settings.motion_generator.tf.source == 'none' else (
        topics.TF_STATIC, topics.TF)
    return (topics.RUN, *clock, *transforms, *topics.DATA, *data, *around, *parity,
            *(topics.AIDING if aided else ()), *guidance)


def select_topics(settings, names, aided=False):
    """
    Return the Topics with the given names, in the order of ``published_topics``; None for all.

    For aided see ``published_topics``.

    Raises ValueError if the nodes do not publish a topic (the message gives the nearest one), or
    if tf.source is aided without an aided solution.
    """
    if settings.motion_generator.tf.source == 'aided' and not aided:
        raise ValueError('tf.source is aided without velocity_meter, gnss and aided_navigator; '
                         'expected these nodes to run (--aided), or tf.source truth or ins')
    known = {topic.name.lstrip('/'): topic for topic in published_topics(settings, aided)}
    if names is None:
        return tuple(known.values())
    wanted = {name.lstrip('/') for name in names}
    for name in sorted(wanted):
        if name not in known:
            raise ValueError(f'no node publishes the topic {name!r}; the nearest is '
                             f'{nearest_name(name, known)!r}')
    return tuple(topic for name, topic in known.items() if name in wanted)


def write_bag(path, settings, run, chosen, storage='mcap', compression='none', replace=False,
              progress=None, aided=None, motion=None, steered=None):
    """
    Write a SimulationResult into a bag and return {topic: number of messages}.

    The bag is created only if it is complete. A message is logged at its stamp.

    Parameters
    ----------
    path, storage, compression, replace : see BagWriter
    settings : SimulationSettings
    run : SimulationResult
    chosen : Topics of ``select_topics``
    progress : called with the fraction done
    aided : AidedSimulationSettings and AidedResult of this run, or None
    motion : Motion of the run; None for that of the settings
    steered : GuidedResult of a guided motion, or None
    """
    aiding, generator = None, settings.motion_generator
    epoch_ns = generator.time.epoch_ns(round(generator.start_s * SECOND), live=False)
    transforms = None
    if topics.TF in published_topics(settings):
        transforms = SimulatedTransforms(settings, None if aided is None else aided[0])
    if aided is not None:
        aided_settings, flown = aided
        aiding = AidingSource(aided_settings, flown, _readings_at(
            flown.states.t_ns, run.imu.t_ns, run.imu.omega), epoch_ns)
    source = _Source(settings, run, aiding, transforms, epoch_ns,
                     read_motion(generator) if motion is None else motion,
                     None if steered is None else steered.estimates)

    def windows():
        for first in range(0, source.count, WINDOW):
            yield source.window(first, min(first + WINDOW, source.count))
            if progress is not None:
                progress(min(1.0, (first + WINDOW) / source.count))

    return write_windows(path, {topic: _as_published(topic, settings, aiding)
                                for topic in chosen},
                         windows(), storage, compression, replace)


def _as_published(topic, settings, aiding):
    if topic in (topics.IMU_RAW, topics.IMU_DATA):
        topic = topics.imu_raw(*reported_variances(settings.imu_sensor), topic)
    if topic in (topics.IMU_MAG, topics.IMU_PRESSURE):
        topic = EnvironmentSensors(settings.imu_sensor).topics[topic]
    if topic in topics.AIDING:
        return aiding.as_published(topic)
    return topic.named(settings.motion_generator.frames.names())


class _Source:
    """Messages of a run and the truth at every generator sample, window by window."""

    def __init__(self, settings, run, aiding, transforms, epoch_ns, motion, commands):
        generator = settings.motion_generator
        self._motion, self._transforms, self._commands = motion, transforms, commands
        self._truth_frame = MapFrame(generator.datum, generator.earth.rotation)
        strapdown = settings.strapdown
        self._frame = MapFrame(strapdown.datum, strapdown.earth.rotation)
        self._epoch_ns = epoch_ns
        self._first_ns, self._dt_ns = round(generator.start_s * SECOND), period_ns(
            generator.rate_hz)
        self.count = round(generator.duration_s * SECOND) // self._dt_ns + 1
        self._announcement = RunAnnouncement(
            epoch_ns, self._first_ns, generator.rate_hz,
            self._first_ns + (self.count - 1) * self._dt_ns)
        self._clock_every = int(np.ceil(generator.rate_hz / CLOCK_HZ))
        self._instant = SampleClock(strapdown, period_ns(strapdown.rate_hz)).instant
        self._run, self._aiding = run, aiding
        self._environment = EnvironmentSensors(settings.imu_sensor)
        self._known = CovarianceSource(settings, run, motion)
        self._parity = None
        if run.imu.parity is not None:
            self._parity = parity_rows(
                settings.imu_sensor, PairInstrument(settings.imu_sensor), run.imu[:])

    def window(self, first, stop):
        """Return {Topic: (stamps_ns, values)} from sample first of the generator to stop."""
        k = np.arange(first, stop, dtype=np.int64)
        truth = self._motion.at(self._first_ns + k * self._dt_ns)
        # Everything after the last sample belongs to the last window.
        last = stop == self.count
        begin = int(truth.t_ns[0]) if first else -np.inf
        end = np.inf if last else self._first_ns + stop * self._dt_ns
        run = self._run
        sensed = _between(run.imu.t_ns, begin, end)
        solved = _between(run.states.t_ns, begin, end)
        imu, states, errors = run.imu[sensed], run.states[solved], run.errors[solved]
        blocks = {topics.CLOCK_TOPIC: (truth.t_ns[k % self._clock_every == 0], None)}
        for record, values in (
                (truth, convert.truth_blocks(self._truth_frame, truth)),
                (imu, convert.imu_block(imu)),
                (states, convert.state_blocks(self._frame, states, self._readings(states),
                                              self._known.at(states.t_ns))),
                (errors, convert.error_blocks(errors))):
            blocks.update({topic: (record.t_ns, v) for topic, v in values.items()})
        if self._parity is not None:
            blocks[topics.IMU_PARITY] = imu.t_ns, self._parity[sensed]
        if self._commands is not None:
            # The last sample needs no further command.
            until = truth.t_ns[-1] if last else end
            commands = self._commands[_between(self._commands.t_ns, begin, until)]
            blocks[topics.GUIDANCE_COMMAND] = commands.t_ns, convert.command_block(commands)
        blocks.update(self._around(truth, blocks[topics.TRUTH_ODOMETRY][1]))
        if self._aiding is not None:
            blocks.update(self._aiding.blocks(begin, end))
        stamped = {topic: (t_ns + self._epoch_ns, v) for topic, (t_ns, v) in blocks.items()}
        stamped[topics.RUN] = message_columns(
            [] if first else [(self._announcement.first_stamp_ns, self._announcement.pack())])
        if self._transforms is not None:
            stamped.update(self._transforms.blocks(stamped, not first))
        return stamped

    def _around(self, truth, odometry):
        """Return {Topic: (instants, values)} of magnetometer and barometer."""
        found = {topic: ([], []) for topic in self._environment.topics}
        if found:
            for t_ns, row in zip(truth.t_ns.tolist(), odometry.tolist()):
                for topic, run in self._environment.read(t_ns, row[0:3], row[3:7], row[7:10]):
                    found[topic][0].append(t_ns)
                    found[topic][1].append(run)
        return {topic: (np.array(stamps, dtype=np.int64),
                        np.array(runs).reshape(len(stamps), -1))
                for topic, (stamps, runs) in found.items()}

    def _readings(self, states):
        """Return the ImuSamples at the instants of a part of the solution."""
        if not len(states):
            return self._run.imu[:0]
        imu, instant = self._run.imu, self._instant
        near = imu[bisect_left(imu.t_ns, states.t_ns[0], key=instant):
                   bisect_right(imu.t_ns, states.t_ns[-1], key=instant)]
        return ImuSamples(states.t_ns, *(_readings_at(states.t_ns, instant(near.t_ns), x)
                                         for x in (near.omega, near.f)))


def _between(t_ns, begin, end):
    """Return the slice of the instants in [begin, end)."""
    return slice(bisect_left(t_ns, begin), bisect_left(t_ns, end))


def _readings_at(t_ns, instants_ns, readings):
    """Return the readings (n, 3) at the instants t_ns, zero if there is no sample."""
    if not len(instants_ns):
        return np.zeros((len(t_ns), 3))
    k = np.minimum(np.searchsorted(instants_ns, t_ns), len(instants_ns) - 1)
    return np.where((instants_ns[k] == t_ns)[:, np.newaxis], readings[k], 0.0)
