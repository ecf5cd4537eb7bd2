"""Verb play: a bag as live topics."""

from ..ros.player import play
from ..ros.playing import Options


def run(chosen):
    """Play; return the exit code of the node."""
    options = Options(
        None if chosen.topics is None else tuple(chosen.topics), chosen.rate, chosen.start,
        chosen.duration, chosen.loop, chosen.wait, chosen.clock, tuple(chosen.lock_step),
        chosen.window, chosen.timeout)
    return play(chosen.bag, options, chosen.ros_args)
