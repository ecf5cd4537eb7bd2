"""Let a process end when its parent ends, for whatever reason."""

import ctypes
import os
import signal

PR_SET_PDEATHSIG = 1


def end_with_parent(parent, number=signal.SIGTERM):
    """Let this process get a signal when its parent (process id) ends, or now if it has ended."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, int(number))
    if os.getppid() != parent:
        os.kill(os.getpid(), number)
