"""
Timers that run on when simulated time stands still.

With use_sim_time the timers of a node follow /clock, and in lock-step /clock waits for the
node: a timer that is to get it out of its waiting would wait for itself.
"""

from rclpy.clock import Clock, ClockType


def wall_timer(node, period_s, callback):
    """Return a timer of the node that calls callback() every period_s of wall time."""
    return node.create_timer(period_s, callback, clock=Clock(clock_type=ClockType.STEADY_TIME))
