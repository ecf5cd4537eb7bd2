"""
A node process that ends with the one that started it, however that ends.

``python -m ins_sim.ros.process.tied PARENT NODE [--ros-args ...]``: PARENT is the process that
waits for it.  Nodes that are started otherwise do not look at their parent.
"""

import sys

from ins_sim.jobs.parent import end_with_parent


def main(words):
    """Run the node that the second word names; return its exit code."""
    from ins_sim.entry import end_at_once
    end_at_once()
    end_with_parent(int(words[0]))
    from ..main import main as run
    return run(words[1:])


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
