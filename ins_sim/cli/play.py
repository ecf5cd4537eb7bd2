"""Verb play: a bag as live topics."""

from ins_sim.ros.main import run as run_node
from ins_sim.ros.recording.playing import Options


def run(chosen):
    """Play; return the exit code of the node."""
    options = Options(
        None if chosen.topics is None else tuple(chosen.topics), chosen.rate, chosen.start,
        chosen.duration, chosen.loop, chosen.wait, chosen.clock, tuple(chosen.lock_step),
        chosen.window, chosen.timeout)
    return run_node('player', chosen.ros_args, path=chosen.bag, options=options)
