"""
Refuse messages with impossible values; the bounds are in ``core.timeseries.bounds``.

A node reads its main inputs with a PlausibleReader.  Of a fix only the instants are checked here:
a fix with impossible values must reach the navigator, which refuses it
(``core.aiding.fix_checks``) and then no longer waits for it.
"""

import math

from ins_sim.core.timeseries import bounds
from . import topics
from .cdr import Reader, SECOND

_EARLIEST_NS, _LATEST_NS, _hypot = bounds.EARLIEST_NS, bounds.LATEST_NS, math.hypot
# By message type and run of doubles: name, bound of the norm, and unit.
BOUNDS = {
    (topics.IMU, (0, 4)): ('orientation', bounds.QUATERNION, ''),
    (topics.IMU, (13, 16)): ('angular velocity', bounds.RATE_RAD_S, ' rad/s'),
    (topics.IMU, (25, 28)): ('linear acceleration', bounds.FORCE_M_S2, ' m/s^2'),
    (topics.ODOMETRY, (0, 3)): ('position', bounds.PLACE_M, ' m'),
    (topics.ODOMETRY, (3, 7)): ('orientation', bounds.QUATERNION, ''),
    (topics.ODOMETRY, (43, 46)): ('linear velocity', bounds.SPEED_M_S, ' m/s'),
    (topics.ODOMETRY, (46, 49)): ('angular velocity', bounds.RATE_RAD_S, ' rad/s'),
}
# Norms of a message by its number of runs, written out because a loop takes twice as long.
_NORMS = {1: lambda _, a: _hypot(*a), 2: lambda _, a, b: _hypot(*a, *b),
          3: lambda _, a, b, c: _hypot(*a, *b, *c),
          4: lambda _, a, b, c, d: _hypot(*a, *b, *c, *d)}


class PlausibleReader:
    """
    Reads messages of a Topic, and refuses those with impossible values.

    runs are slices of the doubles to return, all of which must be in the table; by default those
    of the writer of the topic.
    """

    def __init__(self, topic, runs=None):
        runs = topic.writer().runs if runs is None else tuple(runs)
        self._name, self._read = topic.name, Reader(topic.type_name, runs).read
        self._bounds = [BOUNDS[topic.type_name, run] for run in runs]
        # Almost all messages are below this bound as a whole, except far from the datum.
        self._norm = _NORMS[len(runs)]
        self._least = min(bound for _, bound, _ in self._bounds)

    def read(self, data):
        """Return stamp_ns and the doubles of each run; raise ValueError on impossible values."""
        message = self._read(data)
        if not (_EARLIEST_NS <= message[0] < _LATEST_NS
                and self._norm(*message) < self._least):
            self._look(*message)
        return message

    def _look(self, stamp_ns, *runs):
        check_stamp(self._name, stamp_ns)
        for run, (name, bound, unit) in zip(runs, self._bounds):
            # The comparison is false for NaN.
            if not math.hypot(*run) < bound:
                found = ', '.join(f'{value:.6g}' for value in run)
                raise ValueError(f'{self._name} at {stamp_ns / SECOND:.9f} s holds the {name} '
                                 f'({found}){unit}; expected finite numbers below {bound:g}'
                                 f'{unit}; the message was dropped')


def check_stamp(name, stamp_ns):
    """Raise ValueError on a stamp that is impossible in a run; name is the topic."""
    if not bounds.EARLIEST_NS <= stamp_ns < bounds.LATEST_NS:
        raise ValueError(f'{name} holds the instant {str(stamp_ns)[:25]} ns; expected one from 0 '
                         f'to {bounds.LATEST_NS} ns; the message was dropped')


def check_arrival(name, stamp_ns, arrival_ns):
    """Raise ValueError on a fix that is delivered too long after its instant."""
    if not 0 <= arrival_ns - stamp_ns <= bounds.LATENCY_NS:
        raise ValueError(f'{name} of {stamp_ns / SECOND:.9f} s arrives at the instant '
                         f'{str(arrival_ns)[:25]} ns; expected at most '
                         f'{bounds.LATENCY_NS // SECOND} s later; the message was dropped')
