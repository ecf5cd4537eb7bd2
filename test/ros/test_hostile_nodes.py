"""Hostile messages during a flight of all nodes: no node ends, and all recover."""

from collections import Counter

from support.hostile.flight import ATTACKED, HostileFlight, VARIANTS
import pytest

pytest.importorskip('rclpy')

KINDS = {'field', 'fields', 'stamp', 'shifted', 'text', 'malformed', 'order', 'duplicate',
         'publisher'}
# Number of messages between two quiet periods.
ATTACK = 2500


def attacked(seed, count):
    """
    Send hostile messages during a flight; return the number tried by kind.

    After every ATTACK the good stream alone must bring all nodes back. A HostileFlight raises a
    Finding for values that are not finite, for too many messages, bytes and lines, and for a node
    that has ended; an exception out of a callback ends the test.
    """
    with HostileFlight(seed) as flight:
        flight.good(50)
        while sum(flight.tried.values()) < count:
            flight.attack(ATTACK)
            flight.calm()
        print(f'\nseed {seed}: {sum(flight.tried.values())} hostile messages; one led to at most '
              f'{flight.most_sent} of the nodes; a node held at most {flight.most_bytes} bytes')
        # The plausibility bounds reject all these messages; no unexpected exception occurs.
        assert not flight.rescued
        kinds = Counter()
        for (kind, _), number in flight.tried.items():
            kinds[kind] += number
        assert set(kinds) == KINDS and {name for _, name in flight.tried} == {
            topic.name for topic in ATTACKED}
        return kinds


@pytest.mark.parametrize('seed', [1, 2])
def test_ten_thousand_hostile_messages(seed, ros_domain):
    """
    Ten thousand hostile messages: no exception, finite output, bounded memory and log.

    All nodes recover.
    """
    attacked(seed, 10_000)


@pytest.mark.slow
@pytest.mark.parametrize('variant', range(1, len(VARIANTS)))
def test_hostile_messages_to_nodes_of_other_settings(variant, ros_domain):
    """With other sources, outputs, errors, channels, modes and filters all nodes recover."""
    with HostileFlight(variant, variant=variant) as flight:
        flight.good(50)
        flight.attack(2000)
        flight.calm()
        assert not flight.rescued


@pytest.mark.slow
@pytest.mark.parametrize('seed', [3, 4])
def test_fifty_thousand_hostile_messages(seed, ros_domain):
    """Fifty thousand hostile messages; tools/fuzz_nodes.py continues with two million."""
    attacked(seed, 50_000)


def test_a_recorder_hears_all_of_it(ros_domain, tmp_path):
    """Hostile messages are recorded like others: the bag is complete and can be read."""
    from ins_sim.bags.bag_reader import open_bag
    bag = tmp_path / 'bag'
    with HostileFlight(5, {'recorder': {
            'record.topics': [topic.name for topic in ATTACKED], 'storage.path': str(bag)}}) as f:
        f.good(50)
        f.attack(1500)
        f.good(50)
        recorder = f.fed.nodes['recorder']
        recorder.recorder.finish()
        recorder._bag.close()
        assert not f.rescued
        counts = recorder.recorder.counts
    with open_bag(bag) as bag:
        assert {name: span.count for name, span in bag.spans().items()} == counts
