"""
A node process that ends with the one that started it, however that ends.

``python -m ins_sim.ros.process.tied PARENT NODE [--ros-args ...]``: PARENT is the process that
waits for it.  Nodes that are started otherwise do not look at their parent.
"""

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1


def end_with_parent(parent, number=signal.SIGTERM):
    """Get a signal when the parent, whose process id is given, ends; end now if it has."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, int(number))
    if os.getppid() != parent:
        os.kill(os.getpid(), number)


def main(words):
    """Run the node that the second word names; return its exit code."""
    from ins_sim.entry import end_at_once
    end_at_once()
    end_with_parent(int(words[0]))
    from ..main import main as run
    return run(words[1:])


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
