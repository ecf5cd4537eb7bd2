"""Node strapdown: readings of an IMU in, navigation solution and its errors out."""

from ins_sim.core.navigation.live import Navigator
from ins_sim.core.navigation.sample_clock import SampleClock
from ins_sim.core.numerics.instants import period_ns
from ins_sim.messages import topics
from ins_sim.messages.convert import fix_one, odometry_one
from ins_sim.messages.placements import INS_FIXED, INS_MOVES
from ins_sim.settings.strapdown import StrapdownSettings
from ..transport.broadcaster import Broadcaster
from .following import NavigatorNode


class StrapdownNode(NavigatorNode):
    """Reads imu/data_raw and truth/odometry, publishes ins/odometry, ins/fix, ins/error/*."""

    NAME = 'strapdown'
    SETTINGS = StrapdownSettings
    PUBLISHED = (topics.INS_ODOMETRY, topics.INS_FIX, *topics.ERRORS)

    def make_broadcaster(self):
        """Return the Broadcaster of odom -> base_link."""
        return Broadcaster(self, self.settings, INS_MOVES, INS_FIXED)

    def make_navigator(self):
        """Return the navigator."""
        self._sample_clock = SampleClock(self.settings, period_ns(self.settings.rate_hz))
        return Navigator(self.settings, self.settings.topics.depth)

    def instant(self, stamp_ns):
        """Return the instant of a reading by its stamp, motion time."""
        return self._sample_clock.instant(stamp_ns)

    def messages(self, rate, solution, errors):
        """Return the runs of each topic."""
        return (odometry_one(self.frame, solution, rate), (fix_one(solution),),
                *((e,) for e in errors))
