"""Blocks of a study: handed out to an executor, and their results in the order of the blocks."""

from collections import deque
from concurrent.futures import CancelledError, FIRST_COMPLETED, wait

# A block that ends its worker is computed so often before the study is given up; the last time
# with nothing beside it, so that no other block can be to blame.
ATTEMPTS = 3
# Blocks handed out for each that is computed at the same time: the next one waits at the worker.
AHEAD = 2
# How often an executor is asked whether it is still there, s.
LOOK_S = 1.0


def run_blocks(work, blocks, executor, store=None, progress=None):
    """
    Yield the number and the result of each block, in the order of the blocks.

    Parameters
    ----------
    work : callable
        ``work(block)`` returns the result, for a store a dict of arrays by name. Both can be
        pickled. An error it raises ends the study.
    blocks : sequence
    executor : LocalProcesses, ThisProcess or Cluster
        Of ``executors.open_executor``.
    store : BlockStore, optional
        Keeps the results of finished blocks; what it holds is not computed again.
    progress : callable, optional
        Called with the number of blocks computed; those of the store do not count.

    Yields
    ------
    number : int
    result : dict or object

    Raises
    ------
    ValueError
        Where a block ends its worker each time, and where the executor has gone away.
    """
    queue = _Queue(work, blocks, executor)
    queue.waiting.extend(n for n in range(len(blocks)) if store is None or n not in store)
    done, computed = {}, 0
    for number in range(len(blocks)):
        if store is not None and number in store:
            done[number] = store.load(number)
            if done[number] is None:
                # damaged on disk
                queue.waiting.appendleft(number)
                del done[number]
        while number not in done:
            for finished, result in queue.collect(number):
                if store is not None:
                    store.save(finished, result)
                done[finished], computed = result, computed + 1
                if progress is not None:
                    progress(computed)
        yield number, done.pop(number)


class _Queue:
    """The blocks that are still to be computed, and those under way."""

    def __init__(self, work, blocks, executor):
        self._work, self._blocks, self._executor = work, blocks, executor
        self.waiting, self._alone, self._flying, self._lost = deque(), deque(), {}, {}

    def collect(self, wanted):
        """Hand out blocks; return (number, result) of those that have finished since, or none."""
        self._hand_out(wanted)
        finished, _ = wait(self._flying, LOOK_S, FIRST_COMPLETED)
        self._executor.check()
        found, lost = [], []
        for future in finished:
            number = self._flying.pop(future)
            try:
                found.append((number, future.result()))
            except self._executor.LOST:
                lost.append(number)
            except CancelledError:
                raise self._executor.gone() from None
        if lost:
            # A pool of processes breaks as a whole: which block it was is not known.
            if self._executor.renew():
                lost += self._flying.values()
                self._flying.clear()
            for number in sorted(lost, reverse=True):
                self._again(number)
        return found

    def _hand_out(self, wanted):
        if self._alone:
            # Beside a suspect there is nothing; it is flown before the others go on.
            if not self._flying:
                self._submit(self._alone)
            return
        # No result waits for its turn behind more than a few others.
        last = wanted + AHEAD * self._executor.width
        while (self.waiting and len(self._flying) < AHEAD * self._executor.width
               and self.waiting[0] <= last):
            if not self._submit(self.waiting):
                break

    def _submit(self, waiting):
        """Hand out the first of some; return whether there was somebody to take it."""
        try:
            future = self._executor.submit(self._work, self._blocks[waiting[0]])
        except self._executor.LOST:
            # A process ended since: the futures of those under way tell which blocks are lost.
            if not self._flying:
                self._executor.renew()
            return False
        self._flying[future] = waiting.popleft()
        return True

    def _again(self, number):
        """Let a block whose worker ended be computed again; ValueError after so many times."""
        times = self._lost[number] = self._lost.get(number, 0) + 1
        if times == ATTEMPTS:
            raise ValueError(
                f'block {number + 1} of {len(self._blocks)} ended the process that computed it '
                f'{ATTEMPTS} times, the last time with no other block beside it; expected a '
                'worker that stays alive: has it enough memory?')
        (self._alone if times == ATTEMPTS - 1 else self.waiting).appendleft(number)
