"""A process that ends with the one that started it, however that ends."""

import ctypes
import os
import signal

PR_SET_PDEATHSIG = 1


def end_with_parent(parent, number=signal.SIGTERM):
    """Get a signal when the parent, whose process id is given, ends; end now if it has."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, int(number))
    if os.getppid() != parent:
        os.kill(os.getpid(), number)
