"""
Run all nodes while invalid messages are sent: python tools/fuzz_nodes.py [COUNT] [SEED].

Prints the number of messages by kind and topic. After a failure it prints seed and message, and
exits with 1. It is test/ros/test_hostile_nodes.py with any number of messages, and with all
settings of VARIANTS in turn.
"""

from collections import Counter
import faulthandler
import os
from pathlib import Path
import resource
import sys

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / 'test')]
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'

# Number of messages for one set of nodes, and between two intervals without invalid messages.
RUN, ATTACK = 20_000, 2500
# If sending takes longer, all threads print where they are, and the tool exits.
HANG_S = 600


def fuzz(count, seed):
    """Send COUNT messages; return Counters of the messages sent and of unexpected exceptions."""
    from support.hostile.flight import HostileFlight
    tried, rescued, sent, held = Counter(), Counter(), 0, 0
    while (done := sum(tried.values())) < count:
        with HostileFlight(seed + done // RUN, variant=done // RUN) as run:
            run.good(50)
            try:
                while sum(run.tried.values()) < min(RUN, count - done):
                    faulthandler.dump_traceback_later(HANG_S, exit=True)
                    run.attack(min(ATTACK, count - done))
                    run.calm()
            except Exception:
                kind, name, data = run.spoilt
                print(f'finding after {done + sum(run.tried.values())} messages, seed '
                      f'{seed + done // RUN}: {kind} on {name}: {data[:400].hex()}')
                raise
            tried += run.tried
            rescued += run.rescued
            sent, held = max(sent, run.most_sent), max(held, run.most_bytes)
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
        print(f'{sum(tried.values())} messages tried, 0 findings; a message led to at most {sent} '
              f'of the nodes, a node held at most {held} bytes, the process {memory} MB',
              flush=True)
    return tried, rescued


def main(words):
    """Run the tool; return the exit code."""
    count = int(words[0]) if words else 2_000_000
    seed = int(words[1]) if len(words) > 1 else 1
    try:
        tried, rescued = fuzz(count, seed)
    except AssertionError as finding:
        print(f'finding: {finding}')
        return 1
    for name, which in (('kind', 0), ('topic', 1)):
        totals = Counter()
        for key, number in tried.items():
            totals[key[which]] += number
        print(f'by {name}: ' + ', '.join(f'{key} {number}' for key, number in sorted(
            totals.items())))
    print(f'caught by the last net: {sum(rescued.values())}')
    for sentence, number in rescued.most_common():
        print(f'  {number} x {sentence}')
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
