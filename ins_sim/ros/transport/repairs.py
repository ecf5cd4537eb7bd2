"""What a transport drops is sent again: soon, and before its publisher leaves."""

from importlib import metadata
import os
import time

from ins_sim import resources

# Of Fast DDS up to 2.x, which is that of Jazzy, and from 3 on, that of Kilted and Lyrical: the
# variable, and the profile, whose elements have other names.  Other middlewares know neither.
BEFORE_3 = ('FASTRTPS_DEFAULT_PROFILES_FILE', 'fastdds')
FROM_3 = ('FASTDDS_DEFAULT_PROFILES_FILE', 'fastdds3')
# the first rclpy of a distribution with Fast DDS 3, which warns of the variable of before
RCLPY_FROM_3 = 8
# heartbeats are 0.1 s apart in config/fastdds.xml and config/fastdds3.xml
REPAIR_S = 0.5
DRAIN_S = 2.0


def use_profile():
    """
    Let the publishers of this process and its children ask every 0.1 s what readers miss.

    Fast DDS does so every 3 s.  A profile that the user has named stays.  It counts before the
    first participant is made.
    """
    for variable, name in profiles():
        os.environ.setdefault(variable, str(resources.middleware_profile(name)))


def profiles():
    """Return (variable, name of its profile) of the Fast DDS here, of both where it is unknown."""
    try:
        major = int(metadata.version('rclpy').partition('.')[0])
    except (metadata.PackageNotFoundError, ValueError):
        return BEFORE_3, FROM_3
    return (FROM_3,) if major >= RCLPY_FROM_3 else (BEFORE_3,)


def drain_publishers(publishers):
    """Wait until the readers of publishers have all that was sent, at most DRAIN_S together."""
    from rclpy.duration import Duration
    end = time.monotonic() + DRAIN_S
    for publisher in publishers:
        publisher.wait_for_all_acked(Duration(seconds=max(0.0, end - time.monotonic())))
