"""Executors on this machine: this process, or local processes."""

from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
import os
import signal

from .parent import end_with_parent


class ThisProcess:
    """Computes each block in this process, as soon as it is submitted."""

    LOST, width = (), 1

    def submit(self, work, block):
        """Return a Future with the result of work on a block."""
        future = Future()
        future.set_result(work(block))
        return future

    def check(self):
        """Do nothing: this process cannot be lost."""

    def close(self):
        """Do nothing: nothing is running."""


class LocalProcesses:
    """
    Local processes, which end when this process ends.

    Attributes
    ----------
    LOST : the error of a future whose process has ended
    width : number of processes
    """

    LOST = (BrokenProcessPool,)

    def __init__(self, jobs):
        self.width = jobs
        self._pool = ProcessPoolExecutor(jobs, initializer=_begin_worker)

    def submit(self, work, block):
        """Return the Future of work on a block."""
        return self._pool.submit(work, block)

    def check(self):
        """Do nothing: the futures report what happens to a process."""

    def renew(self):
        """Replace all processes after one has ended; return True: all futures are lost."""
        self.close()
        self._pool = ProcessPoolExecutor(self.width, initializer=_begin_worker)
        return True

    def close(self):
        """Kill the processes without waiting for their blocks, which may take minutes."""
        for process in (self._pool._processes or {}).values():
            process.kill()
        self._pool.shutdown(cancel_futures=True)


def cores():
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0))


def _begin_worker():
    """Ignore the Ctrl-C of the terminal, which the parent handles, and end with the parent."""
    end_with_parent(os.getppid(), signal.SIGKILL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
