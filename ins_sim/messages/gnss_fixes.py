"""Convert a GnssFix to the messages gnss/fix and gnss/velocity, and back by their stamps."""

from collections import deque
import math

from ins_sim.core.timeseries.fixes import GnssFix, no_gnss_fix, OUTAGE
from . import topics
from .convert import fix_one
from .plausible import check_stamp

# Largest number of fixes or velocities that wait for their counterpart.
_WAITING = 100


class GnssWriter:
    """
    Packs GnssFixes.

    epoch_ns is the stamp of motion time zero, which may change; for names see ``Topic.named``,
    None for the default ones.
    """

    def __init__(self, epoch_ns, names=None):
        self.epoch_ns = epoch_ns
        self._fix, self._none, self._velocity = (
            topic.named(names or {}).writer().pack
            for topic in (topics.GNSS_FIX, topics.GNSS_NO_FIX, topics.GNSS_VELOCITY))

    def fix(self, fix):
        """Return gnss/fix in degrees; an invalid fix has status -1 and NaN."""
        stamp_ns = fix.t_ns + self.epoch_ns
        if not fix.valid:
            return self._none(stamp_ns)
        return self._fix(stamp_ns, fix_one((fix.lat, fix.lon, fix.height)),
                         *((sigma * sigma,) for sigma in fix.position_sigma))

    def velocity(self, fix):
        """Return gnss/velocity of a valid fix."""
        return self._velocity(fix.t_ns + self.epoch_ns, fix.v_n,
                              *((sigma * sigma,) for sigma in fix.velocity_sigma))


class GnssPairs:
    """
    Builds GnssFixes from both topics, matched by their stamps.

    epoch_ns is the stamp of motion time zero, which may change; latency_ns the delay from the
    instant of a fix to its delivery.  Both push methods return the list of complete fixes, in
    order, and raise ValueError on an invalid message.  Repeated messages are ignored; backward
    stamps reset the object.  A fix whose velocity is lost is skipped when a later velocity has
    arrived, and counted in ``lost``.
    """

    def __init__(self, epoch_ns, latency_ns):
        self.epoch_ns, self._latency_ns = epoch_ns, latency_ns
        self._fix_reader = topics.GNSS_FIX.reader()
        self._velocity_reader = topics.GNSS_VELOCITY.reader()
        self.lost, self._done_ns = 0, None
        self._fixes, self._velocities = deque(maxlen=_WAITING), deque(maxlen=_WAITING)

    def push_fix(self, data):
        """Process a message of gnss/fix."""
        stamp_ns, place, *variances = self._fix_reader.read(data)
        check_stamp(topics.GNSS_FIX.name, stamp_ns)
        valid = self._fix_reader.numbers(data)[0] >= 0
        return self._push(self._fixes, (stamp_ns, place if valid else None, variances))

    def push_velocity(self, data):
        """Process a message of gnss/velocity."""
        message = self._velocity_reader.read(data)
        check_stamp(topics.GNSS_VELOCITY.name, message[0])
        return self._push(self._velocities, message)

    def _push(self, queue, message):
        last_ns = queue[-1][0] if queue else self._done_ns
        if message[0] == last_ns or message[0] == self._done_ns:
            return []
        if queue and message[0] < last_ns:
            queue.clear()
        queue.append(message)
        return self._match()

    def _match(self):
        found, fixes, velocities = [], self._fixes, self._velocities
        while fixes:
            stamp_ns, place, variances = fixes[0]
            if place is not None:
                while velocities and velocities[0][0] < stamp_ns:
                    velocities.popleft()
                if not velocities:
                    break
            t_ns = stamp_ns - self.epoch_ns
            fixes.popleft()
            self._done_ns = stamp_ns
            if place is None:
                found.append(no_gnss_fix(t_ns, OUTAGE, t_ns + self._latency_ns))
            elif velocities[0][0] > stamp_ns:
                self.lost += 1
            else:
                _, v_n, *slips = velocities.popleft()
                lat, lon, height = place
                found.append(GnssFix(
                    t_ns, math.radians(lat), math.radians(lon), height, v_n,
                    *(tuple(_sigma(v) for v, in runs) for runs in (variances, slips)),
                    arrival_ns=t_ns + self._latency_ns))
        return found


def _sigma(variance):
    """Return the standard deviation; 0 for an invalid variance, which the navigator refuses."""
    return math.sqrt(variance) if variance > 0.0 else 0.0
