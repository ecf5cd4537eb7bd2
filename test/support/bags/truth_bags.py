"""Bags that hold the true motion."""

from dataclasses import replace

import numpy as np
from support.studies import settings

from ins_sim.io.motion import read_motion
from ins_sim.bags.windows import write_windows
from ins_sim.core.earth.frames import MapFrame
from ins_sim.messages import convert, topics

SECOND = 1_000_000_000


def record(path, values, length_s, rate_hz=100.0, only=topics.TRUTH, prefix='', change=None):
    """
    Write the truth of a closed-form motion from motion time 0 on.

    change: function of {Topic: [t_ns, x]} that alters the data before they are written.
    """
    chosen = settings(values)
    generator = chosen.motion_generator
    motion = read_motion(generator)
    t_ns = np.arange(round(length_s * rate_hz) + 1) * round(SECOND / rate_hz)
    truth = motion.at(t_ns)
    window = {topic: [t_ns.copy(), x] for topic, x in convert.truth_blocks(
        MapFrame(generator.datum, generator.earth.rotation), truth).items()}
    if change is not None:
        change(window)
    write_windows(path, {topic: replace(topic, name=prefix + topic.name) for topic in only},
                  [window])
    return motion


def recorded(path, values, **more):
    """Return Settings whose motion is read from the bag."""
    return settings({**values, 'motion.kind': 'recording', 'motion.recording.path': str(path),
                     **more})
