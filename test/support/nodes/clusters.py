"""A Dask cluster of processes on this machine, and a task for it."""

import os
import subprocess
import sys
import time

import numpy as np
from ..places import ROOT

# Workers import the functions of this package from here.
HERE = os.pathsep.join(map(str, (ROOT, ROOT / 'test')))
SCHEDULER = ('import asyncio, sys; from distributed import Scheduler\n'
             'async def main():\n'
             '    async with Scheduler(host="127.0.0.1", port=0, dashboard=False) as s:\n'
             '        print(s.address, flush=True); await s.finished()\n'
             'asyncio.run(main())')
WORKER = ('import asyncio, sys; from distributed import Worker\n'
          'async def main():\n'
          '    async with Worker(sys.argv[1], nthreads=1, dashboard=False) as w:\n'
          '        await w.finished()\n'
          'asyncio.run(main())')


class Processes:
    """A scheduler and workers, each in a process of its own."""

    def __init__(self):
        self.all = []
        self.address = self.start(SCHEDULER).stdout.readline().strip()

    def start(self, program, *words, path=HERE):
        """Start a program with a path from which it imports modules; return its Popen."""
        process = subprocess.Popen([sys.executable, '-c', program, *words], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, cwd='/',
                                   env={**os.environ, 'PYTHONPATH': str(path)})
        self.all.append(process)
        return process

    def worker(self, path=HERE):
        """Start a worker; return it when it is registered with the scheduler."""
        import distributed
        with distributed.Client(self.address, set_as_default=False) as client:
            before = len(client.nthreads())
            process = self.start(WORKER, self.address, path=path)
            client.wait_for_workers(before + 1, timeout=60)
        return process


def slow_block(block):
    """Return a block and the process of its worker, after a pause."""
    time.sleep(0.2)
    return {'block': np.array(block), 'worker': np.array(os.getpid())}
