"""
Timers that follow the wall clock even with use_sim_time.

With use_sim_time the timers of a node follow /clock, and in lock-step /clock waits for the node.
A timer meant to end this waiting would therefore never fire.
"""

from rclpy.clock import Clock, ClockType


def wall_timer(node, period_s, callback):
    """Return a timer of the node that calls callback() every period_s of wall time."""
    return node.create_timer(period_s, callback, clock=Clock(clock_type=ClockType.STEADY_TIME))
