"""What a transport drops is sent again: soon, and before its publisher leaves."""

import os
import time

from ins_sim import resources

# Of Fast DDS up to 2.x, which is that of Jazzy, and from 3 on; other middlewares know neither.
VARIABLES = ('FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE')
# heartbeats are 0.1 s apart in config/fastdds.xml
REPAIR_S = 0.5
DRAIN_S = 2.0


def use_profile():
    """
    Let the publishers of this process and its children ask every 0.1 s what readers miss.

    Fast DDS does so every 3 s.  A profile that the user has named stays.  It counts before the
    first participant is made.
    """
    for variable in VARIABLES:
        os.environ.setdefault(variable, str(resources.middleware_profile('fastdds')))


def drain_publishers(publishers):
    """Wait until the readers of publishers have all that was sent, at most DRAIN_S together."""
    from rclpy.duration import Duration
    end = time.monotonic() + DRAIN_S
    for publisher in publishers:
        publisher.wait_for_all_acked(Duration(seconds=max(0.0, end - time.monotonic())))
