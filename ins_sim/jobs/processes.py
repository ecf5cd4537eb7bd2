"""Executors on this machine: processes of their own, or the present one."""

from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
import os
import signal

from .parent import end_with_parent


class ThisProcess:
    """Computes each block at once, in the process that hands it out."""

    LOST, width = (), 1

    def submit(self, work, block):
        """Return a Future with the result of work on a block."""
        future = Future()
        future.set_result(work(block))
        return future

    def check(self):
        """Find it there."""

    def close(self):
        """Leave nothing behind."""


class LocalProcesses:
    """
    Processes of this machine, which end with this one.

    LOST: the error of a future whose process has ended; width: how many compute at once.
    """

    LOST = (BrokenProcessPool,)

    def __init__(self, jobs):
        self.width = jobs
        self._pool = ProcessPoolExecutor(jobs, initializer=_begin_worker)

    def submit(self, work, block):
        """Return the Future of work on a block."""
        return self._pool.submit(work, block)

    def check(self):
        """Find it there: what happens to a process is told by its futures."""

    def renew(self):
        """Make new processes, one having ended; return True: all futures are lost."""
        self.close()
        self._pool = ProcessPoolExecutor(self.width, initializer=_begin_worker)
        return True

    def close(self):
        """End the processes without waiting for what they compute, which may take minutes."""
        for process in (self._pool._processes or {}).values():
            process.kill()
        self._pool.shutdown(cancel_futures=True)


def cores():
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0))


def _begin_worker():
    """Leave the signals of a terminal to the process that started this one, and end with it."""
    end_with_parent(os.getppid(), signal.SIGKILL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
