"""
Run a node process that ends when its parent process ends, even if the parent is killed.

``python -m ins_sim.ros.process.tied PARENT NODE [--ros-args ...]``, where PARENT is the id of the
process to watch. Nodes that are started in another way do not watch their parent.
"""

import sys

from ins_sim.jobs.parent import end_with_parent


def main(words):
    """Run the node named by the second word; return its exit code."""
    from ins_sim.entry import end_at_once
    end_at_once()
    end_with_parent(int(words[0]))
    from ..main import main as run
    return run(words[1:])


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
