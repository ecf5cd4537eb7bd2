"""
The latched message on sim/run with which motion_generator announces epoch, start, rate and end.

It is a DiagnosticArray with one status, so that ``ros2 topic echo`` shows the names
(docs/design/time_and_frames.md).
"""

from dataclasses import dataclass
import math

from ins_sim.core.timeseries.bounds import LATEST_NS
from . import diagnostic_array, topics
from .cdr import SECOND
from .diagnostic_array import Status

NAME = 'run'
_WHOLE = ('epoch_ns', 'start_ns', 'end_ns')


@dataclass(frozen=True)
class RunAnnouncement:
    """
    A run: stamps are epoch_ns plus motion time, with samples at rate_hz from start_ns to end_ns.

    Times are in ns.  For an endless run end_ns is the last sample that fits into a ROS stamp.
    """

    epoch_ns: int
    start_ns: int
    rate_hz: float
    end_ns: int

    @property
    def first_stamp_ns(self):
        """Return the stamp of the first sample."""
        return self.epoch_ns + self.start_ns

    def pack(self):
        """Return the message."""
        values = [*((key, str(getattr(self, key))) for key in _WHOLE),
                  ('rate_hz', repr(float(self.rate_hz)))]
        status = Status(diagnostic_array.OK, NAME, f'epoch {self.epoch_ns / SECOND:.3f} s', '',
                        tuple(values))
        return diagnostic_array.pack_diagnostics(self.first_stamp_ns, '', [status])


# Assumed without an announcement: motion time is the stamp itself.
UNANNOUNCED = RunAnnouncement(0, 0, math.inf, LATEST_NS)


def read_announcement(data):
    """Return the RunAnnouncement of a message; raise ValueError if it is invalid."""
    _, _, statuses = diagnostic_array.read_diagnostics(data)
    if len(statuses) != 1 or statuses[0].name != NAME:
        raise ValueError(f'{topics.RUN.name} holds {len(statuses)} statuses; expected one with '
                         f'the name {NAME!r}')
    given = dict(statuses[0].values)
    try:
        epoch_ns, start_ns, end_ns = (int(given.get(key, '')[:25]) for key in _WHOLE)
        rate_hz = float(given.get('rate_hz', '')[:25])
    except ValueError:
        found = ', '.join(f'{key} {given.get(key, "")[:25]!r}' for key in (*_WHOLE, 'rate_hz'))
        raise ValueError(f'{topics.RUN.name} holds {found}; expected a number for each') from None
    if not (0.0 < rate_hz < math.inf and -LATEST_NS < epoch_ns < LATEST_NS
            and 0 <= epoch_ns + start_ns <= epoch_ns + end_ns <= LATEST_NS):
        raise ValueError(f'{topics.RUN.name} announces a run from {start_ns} to {end_ns} ns at '
                         f'{rate_hz:g} Hz, with the epoch {epoch_ns} ns; expected stamps that ROS '
                         'can hold, in order, and a positive rate')
    return RunAnnouncement(epoch_ns, start_ns, rate_hz, end_ns)
