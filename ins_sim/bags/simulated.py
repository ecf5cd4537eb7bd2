"""An offline run as a bag: the topics that the nodes would publish, at their own stamps."""

import numpy as np

from .bag_writer import BagWriter
from ..core.catalogue import nearest
from ..core.imu import period_ns
from ..core.instrument import reported_variances
from ..core.map_frame import MapFrame
from ..core.motions import make_motion
from ..messages import convert, topics
from ..messages.cdr import SECOND

# samples of the generator that are in memory as messages at once
WINDOW = 4096
CLOCK_HZ = 100.0


def published(settings):
    """Return the Topics that the nodes of Settings publish, in the order of equal stamps."""
    clock = (topics.CLOCK_TOPIC,) if settings.motion_generator.publish_clock else ()
    return (*clock, *topics.DATA)


def select(settings, names):
    """
    Return the Topics of these names, in the order of ``published``; all where names is None.

    Raises ValueError, naming the nearest one, for a topic that the nodes do not publish.
    """
    known = {topic.name.lstrip('/'): topic for topic in published(settings)}
    if names is None:
        return tuple(known.values())
    wanted = {name.lstrip('/') for name in names}
    for name in sorted(wanted):
        if name not in known:
            raise ValueError(f'the nodes publish no topic {name!r}; the nearest is '
                             f'{nearest(name, known)!r}')
    return tuple(topic for name, topic in known.items() if name in wanted)


def write(path, settings, run, chosen, storage='mcap', compression='none', replace=False,
          progress=None):
    """
    Write a Run into a bag that appears only if it is whole; return {topic: message count}.

    settings: simulation.Settings; chosen: Topics of ``select``; the rest as of BagWriter;
    progress: called with the fraction done.  A message is logged at its own stamp.
    """
    bag = BagWriter(path, storage, compression, replace)
    try:
        source = _Source(settings, run)
        writers = {topic: _as_published(topic, settings).writer() for topic in chosen}
        counts = dict.fromkeys((topic.name for topic in chosen), 0)
        for topic in chosen:
            bag.add_topic(topic.name, topic.type_name)
        for first in range(0, source.count, WINDOW):
            blocks = source.window(first, min(first + WINDOW, source.count))
            messages = {}
            for topic in chosen:
                stamps_ns, values = blocks[topic]
                messages[topic.name] = stamps_ns, writers[topic].block(stamps_ns, values)
                counts[topic.name] += len(stamps_ns)
            bag.write_blocks(messages)
            if progress is not None:
                progress(min(1.0, (first + WINDOW) / source.count))
        bag.close()
    except OSError:
        raise  # a full disk: what is written is kept, and the error says so
    except BaseException:
        bag.discard()
        raise
    return counts


def _as_published(topic, settings):
    if topic is not topics.IMU_RAW:
        return topic
    return topics.imu_raw(*reported_variances(settings.imu_sensor))


class _Source:
    """The records of a run, and the truth at every sample of the generator, by windows."""

    def __init__(self, settings, run):
        generator = settings.motion_generator
        self._motion = make_motion(generator.motion, generator.datum, generator.earth)
        self._truth_frame = MapFrame(generator.datum, generator.earth.rotation)
        strapdown = settings.strapdown
        self._frame = MapFrame(strapdown.datum, strapdown.earth.rotation)
        self._epoch_ns = generator.time.epoch_s * SECOND
        self._first_ns, self._dt_ns = round(generator.start_s * SECOND), period_ns(
            generator.rate_hz)
        self.count = round(generator.duration_s * SECOND) // self._dt_ns + 1
        self._clock_every = int(np.ceil(generator.rate_hz / CLOCK_HZ))
        self._run, self._omega = run, _rates_at(run.states.t_ns, run.imu)

    def window(self, first, stop):
        """Return {Topic: (stamps_ns, values)} from sample first of the generator to stop."""
        k = np.arange(first, stop, dtype=np.int64)
        truth = self._motion.at(self._first_ns + k * self._dt_ns)
        # whatever is behind the last sample belongs to the last window
        last = stop == self.count
        begin = truth.t_ns[0] if first else -np.inf
        end = np.inf if last else self._first_ns + stop * self._dt_ns
        run = self._run
        imu = run.imu[_between(run.imu.t_ns, begin, end)]
        rows = _between(run.states.t_ns, begin, end)
        states, errors = run.states[rows], run.errors[rows]
        blocks = {topics.CLOCK_TOPIC: (truth.t_ns[k % self._clock_every == 0], None)}
        for record, values in (
                (truth, convert.truth_blocks(self._truth_frame, truth)),
                (imu, convert.imu_block(imu)),
                (states, convert.state_blocks(self._frame, states, self._omega[rows])),
                (errors, convert.error_blocks(errors))):
            blocks.update({topic: (record.t_ns, v) for topic, v in values.items()})
        return {topic: (t_ns + self._epoch_ns, v) for topic, (t_ns, v) in blocks.items()}


def _between(t_ns, begin, end):
    return slice(*np.searchsorted(t_ns, (begin, end)).tolist())


def _rates_at(t_ns, imu):
    """Return the readings of the gyros (n, 3) at instants t_ns, zero where there is none."""
    k = np.minimum(np.searchsorted(imu.t_ns, t_ns), len(imu.t_ns) - 1)
    return np.where((imu.t_ns[k] == t_ns)[:, np.newaxis], imu.omega[k], 0.0)
