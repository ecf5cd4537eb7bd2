"""Blocks are returned in order and once each, whatever finishes first or fails."""

import os
import signal
import time

from ins_sim.jobs.blocks import ATTEMPTS, run_blocks
from ins_sim.jobs.executors import open_executor
from ins_sim.jobs.store import BlockStore
import numpy as np
import pytest


def square(block):
    """Return the squares of a block; early blocks take longest."""
    time.sleep(0.03 * (6 - min(block)))
    return {'squares': np.array(block) ** 2, 'worker': np.array(os.getpid())}


class DiesOnce:
    """Work that kills its process at one block, the first times that it is computed."""

    def __init__(self, folder, block, times):
        self.folder, self.block, self.times = folder, block, times

    def __call__(self, block):
        """Return the block, or end the process."""
        if block == self.block:
            seen = len(list(self.folder.iterdir()))
            if seen < self.times:
                (self.folder / str(seen)).touch()
                os.kill(os.getpid(), signal.SIGKILL)
        return {'block': np.array(block)}


@pytest.mark.parametrize('jobs', [1, 2, 3])
def test_results_come_in_the_order_of_the_blocks(jobs):
    """
    Results come in the order of the blocks although the first ones take longest.

    The number of processes is the requested one.
    """
    blocks, seen = [range(k, k + 2) for k in range(6)], []
    with open_executor(jobs) as executor:
        found = list(run_blocks(square, blocks, executor, progress=seen.append))
    assert [number for number, _ in found] == list(range(6)) and seen == list(range(1, 7))
    for number, result in found:
        assert result['squares'].tolist() == [number ** 2, (number + 1) ** 2]
    workers = {int(result['worker']) for _, result in found}
    assert len(workers) <= jobs and (os.getpid() in workers) == (jobs == 1)


@pytest.mark.parametrize('times', range(1, ATTEMPTS))
def test_a_killed_worker_costs_only_time(times, tmp_path):
    """After a killed worker every block is still returned once, with its result."""
    with open_executor(2) as executor:
        found = list(run_blocks(DiesOnce(tmp_path, 3, times), range(8), executor))
    assert [(n, int(r['block'])) for n, r in found] == [(k, k) for k in range(8)]


def test_a_block_that_kills_every_worker_is_named(tmp_path):
    """A block that kills every worker ends the study with a message that names this block only."""
    found = []
    with open_executor(2) as executor, pytest.raises(ValueError, match='^block 4 of 8 ended'):
        for number, _ in run_blocks(DiesOnce(tmp_path, 3, 99), range(8), executor):
            found.append(number)
    assert found == [0, 1, 2] and len(list(tmp_path.iterdir())) == ATTEMPTS


def refuse(block):
    """Refuse the third block."""
    if block == 2:
        raise ValueError('the third block; expected another')
    return {'block': np.array(block)}


@pytest.mark.parametrize('jobs', [1, 2])
def test_an_error_of_the_work_is_the_error(jobs):
    """An error raised by the work is passed on unchanged."""
    with open_executor(jobs) as executor, pytest.raises(ValueError, match='^the third block'):
        list(run_blocks(refuse, range(5), executor))


@pytest.mark.parametrize('jobs, scheduler', [(-1, None), (2, 'tcp://host:8786')])
def test_what_is_no_executor_is_refused(jobs, scheduler):
    """An invalid executor is refused with one message that names it."""
    with pytest.raises(ValueError, match=f'^jobs is {jobs}'), open_executor(jobs, scheduler):
        pass


def test_finished_blocks_are_not_computed_again(tmp_path):
    """After an interruption finished blocks are not computed again; a damaged one is."""
    folder, identity = tmp_path / 'blocks', {'a': 1, 'b': (1.5, 'x')}
    store = BlockStore(folder, identity)
    with open_executor(2) as executor:
        before = dict(run_blocks(square, [range(k, k + 2) for k in range(4)], executor, store))
    (folder / 'block_000002.npz').write_bytes(b'PK damaged')
    (folder / 'block_000003.npz').unlink()
    store, computed = BlockStore(folder, identity), []
    assert store.found == 3
    with open_executor(1) as executor:
        after = dict(run_blocks(square, [range(k, k + 2) for k in range(4)], executor, store,
                                computed.append))
    assert computed == [1, 2] and sorted(after) == [0, 1, 2, 3]
    for k in range(4):
        assert after[k]['squares'].tolist() == before[k]['squares'].tolist()
        assert (after[k]['worker'] == before[k]['worker']) == (k < 2)
    store.remove()
    assert not folder.exists()


def test_blocks_of_another_study_are_never_mixed(tmp_path):
    """Blocks of another study are refused with the difference; replace deletes only them."""
    folder = tmp_path / 'blocks'
    BlockStore(folder, {'seed': 1, 'rate_hz': 100.0}).save(0, {'x': np.zeros(3)})
    with pytest.raises(ValueError, match='seed is 1 there and 2 here'):
        BlockStore(folder, {'seed': 2, 'rate_hz': 100.0})
    with pytest.raises(ValueError, match='rate_hz is 100.0 there and None here, more is None'):
        BlockStore(folder, {'seed': 1, 'more': []})
    assert BlockStore(folder, {'seed': 1, 'rate_hz': 100.0}).found == 1
    (folder / 'mine.txt').touch()
    store = BlockStore(folder, {'seed': 2}, replace=True)
    assert store.found == 0 and len(store) == 0
    assert [path.name for path in folder.iterdir()] == ['mine.txt']
    # Without a finished block there is nothing to mix, and nothing remains.
    none = tmp_path / 'none'
    assert BlockStore(none, {'seed': 1}).found == 0 and not none.exists()
    other = tmp_path / 'other'
    other.mkdir()
    (other / 'mine.txt').touch()
    with pytest.raises(ValueError, match='holds no blocks of a study'):
        BlockStore(other, {}, replace=True)
