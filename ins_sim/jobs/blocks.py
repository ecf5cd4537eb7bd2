"""Distribute the blocks of a study to an executor, and yield their results in order."""

from collections import deque
from concurrent.futures import CancelledError, FIRST_COMPLETED, wait

# Number of attempts to compute a block whose worker ends. During the last one no other block is
# running, so that this block is certainly the cause.
ATTEMPTS = 3
# Number of submitted blocks for each worker: while it computes one, the next already waits.
AHEAD = 2
# Interval at which the executor is checked, s.
LOOK_S = 1.0


def run_blocks(work, blocks, executor, store=None, progress=None):
    """
    Yield the number and the result of each block, in the order of the blocks.

    Parameters
    ----------
    work : callable
        ``work(block)`` returns the result; with a store, a dict of arrays by name. ``work`` and
        the blocks must be picklable. An error raised by it ends the study.
    blocks : sequence
    executor : LocalProcesses, ThisProcess or Cluster
        From ``executors.open_executor``.
    store : BlockStore, optional
        Keeps the results of finished blocks; blocks in it are not computed again.
    progress : callable, optional
        Called with the number of blocks computed so far, without those from the store.

    Yields
    ------
    number : int
    result : dict or object

    Raises
    ------
    ValueError
        If a block ends its worker in every attempt, or the executor is lost.
    """
    queue = _Queue(work, blocks, executor)
    queue.waiting.extend(n for n in range(len(blocks)) if store is None or n not in store)
    done, computed = {}, 0
    for number in range(len(blocks)):
        if store is not None and number in store:
            done[number] = store.load(number)
            if done[number] is None:
                # The file is damaged; compute the block again.
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
    """The blocks that still have to be computed, and those that are submitted."""

    def __init__(self, work, blocks, executor):
        self._work, self._blocks, self._executor = work, blocks, executor
        self.waiting, self._alone, self._flying, self._lost = deque(), deque(), {}, {}

    def collect(self, wanted):
        """Submit blocks; return a list of (number, result) of those that have finished."""
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
            # A pool of processes breaks as a whole; it does not tell which block was the cause.
            if self._executor.renew():
                lost += self._flying.values()
                self._flying.clear()
            for number in sorted(lost, reverse=True):
                self._again(number)
        return found

    def _hand_out(self, wanted):
        if self._alone:
            # A block under suspicion is computed alone, before the others continue.
            if not self._flying:
                self._submit(self._alone)
            return
        # Limit how far ahead blocks are computed: finished results wait in memory for their turn.
        last = wanted + AHEAD * self._executor.width
        while (self.waiting and len(self._flying) < AHEAD * self._executor.width
               and self.waiting[0] <= last):
            if not self._submit(self.waiting):
                break

    def _submit(self, waiting):
        """Submit the first waiting block; return whether the executor accepted it."""
        try:
            future = self._executor.submit(self._work, self._blocks[waiting[0]])
        except self._executor.LOST:
            # A process has ended: the futures of the submitted blocks will tell which are lost.
            if not self._flying:
                self._executor.renew()
            return False
        self._flying[future] = waiting.popleft()
        return True

    def _again(self, number):
        """Queue a block again whose worker has ended; ValueError after ATTEMPTS."""
        times = self._lost[number] = self._lost.get(number, 0) + 1
        if times == ATTEMPTS:
            raise ValueError(
                f'block {number + 1} of {len(self._blocks)} ended the process that computed it '
                f'{ATTEMPTS} times, the last time while no other block was running; expected a '
                'worker that stays alive: does it have enough memory?')
        (self._alone if times == ATTEMPTS - 1 else self.waiting).appendleft(number)
