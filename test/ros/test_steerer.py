"""The steering topic of the generator, node objects without DDS: what goes wrong with it."""

from types import SimpleNamespace

from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND
import pytest
from support.hostile.flight import HostileFlight, STEERED

pytest.importorskip('rclpy')


def test_hostile_messages_to_a_closed_loop(ros_domain):
    """On every topic, that which steers included: the loop is closed again after each attack."""
    with HostileFlight(1, variant=STEERED) as flight:
        flight.good(50)
        flight.attack(1200)
        flight.calm(1100)
        assert not flight.rescued
        generator = flight.fed.nodes['motion_generator']
        assert generator._steerer._command.why == ''
