"""Configure fast retransmission of lost messages, and wait for it before a process ends."""

from importlib import metadata
import os
import time

from ins_sim import resources

# (environment variable, name of the XML profile) of Fast DDS 2 (Jazzy) and of Fast DDS 3 (Kilted,
# Lyrical), whose XML elements have other names. Other middlewares ignore both variables.
BEFORE_3 = ('FASTRTPS_DEFAULT_PROFILES_FILE', 'fastdds')
FROM_3 = ('FASTDDS_DEFAULT_PROFILES_FILE', 'fastdds3')
# First major version of rclpy with Fast DDS 3, which warns about the old variable.
RCLPY_FROM_3 = 8
# Time allowed for retransmissions, s; the period of heartbeats is 0.1 s in config/fastdds.xml and
# config/fastdds3.xml.
REPAIR_S = 0.5
DRAIN_S = 2.0


def use_profile():
    """
    Set the heartbeat period of the publishers of this process and its children to 0.1 s.

    At a heartbeat, readers request the messages that they miss; the default period of Fast DDS
    is 3 s. A profile chosen by the user is kept. Call this before the first participant is made.
    """
    for variable, name in profiles():
        os.environ.setdefault(variable, str(resources.middleware_profile(name)))


def profiles():
    """Return [(variable, profile name)] of the installed Fast DDS, both if it is unknown."""
    try:
        major = int(metadata.version('rclpy').partition('.')[0])
    except (metadata.PackageNotFoundError, ValueError):
        return BEFORE_3, FROM_3
    return (FROM_3,) if major >= RCLPY_FROM_3 else (BEFORE_3,)


def drain_publishers(publishers):
    """Wait, at most DRAIN_S in total, until the readers have received everything published."""
    from rclpy.duration import Duration
    end = time.monotonic() + DRAIN_S
    for publisher in publishers:
        publisher.wait_for_all_acked(Duration(seconds=max(0.0, end - time.monotonic())))
