"""A Dask cluster computes the same blocks; an unusable one is refused with one message."""

import signal
import sys

from ins_sim.jobs import cluster
from ins_sim.jobs.blocks import run_blocks
from ins_sim.jobs.executors import open_executor
import numpy as np
import pytest
from support.nodes.clusters import Processes, slow_block

distributed = pytest.importorskip('distributed', reason='needs Dask (extra cluster)')


@pytest.fixture
def processes():
    """Yield a function that starts a scheduler or worker; all of them end after the test."""
    made = Processes()
    yield made
    for process in reversed(made.all):
        process.kill()
        process.communicate()


def test_a_killed_worker_costs_only_time(processes):
    """After one of two workers is killed, every block is still returned once and in order."""
    workers = {process.pid: process for process in (processes.worker(), processes.worker())}
    found = []
    with open_executor(scheduler=processes.address) as executor:
        assert executor.width == 2
        for number, result in run_blocks(slow_block, range(12), executor):
            found.append((number, int(result['block'])))
            if number == 3:
                workers[int(result['worker'])].send_signal(signal.SIGKILL)
    assert found == [(k, k) for k in range(12)]


def test_a_cluster_that_goes_away_is_named(processes):
    """If the scheduler ends, the study ends with a message that names it."""
    processes.worker()
    with open_executor(scheduler=processes.address) as executor:
        with pytest.raises(ValueError, match=f'{processes.address} is lost'):
            for number, _ in run_blocks(slow_block, range(50), executor):
                if number == 1:
                    processes.all[0].kill()


def test_a_cluster_without_workers_is_refused(processes, monkeypatch):
    """A cluster without workers is refused at the start, one that lost its last worker later."""
    with pytest.raises(ValueError, match='has no worker; expected one or more'):
        with open_executor(scheduler=processes.address):
            pass
    monkeypatch.setattr(cluster, 'COUNT_S', 0.1)
    monkeypatch.setattr(cluster, 'NO_WORKER_S', 1.0)
    worker = processes.worker()
    with open_executor(scheduler=processes.address) as executor:
        with pytest.raises(ValueError, match='has had no worker for 1 s'):
            for number, _ in run_blocks(slow_block, range(50), executor):
                worker.kill()


@pytest.mark.parametrize('address, reason', [
    ('tcp://127.0.0.1:9', 'there is no Dask scheduler at'), ('nowhere', 'there is no Dask')])
def test_a_scheduler_that_is_not_there(address, reason, monkeypatch):
    """A missing scheduler is reported with its address."""
    monkeypatch.setattr(cluster, 'CONNECT_S', 1.0)
    with pytest.raises(ValueError, match=reason), open_executor(scheduler=address):
        pass


@pytest.mark.parametrize('address', ['nowhere', '', 'tcp:/localhost:8786', 'http://localhost:1'])
def test_a_misspelt_address_makes_no_client(address, monkeypatch):
    """A misspelt address creates no client, which would block for 20 s when deleted."""
    def client(*_, **__):
        pytest.fail('a client was made')

    monkeypatch.setattr(distributed, 'Client', client)
    with pytest.raises(ValueError, match='there is no Dask'), open_executor(scheduler=address):
        pass


@pytest.mark.parametrize('source, found', [
    ("__version__ = '0.0.9'\n", 'has ins_sim 0.0.9; expected ins_sim '),
    # The package is not installed there.
    ("raise ModuleNotFoundError('ins_sim', name='ins_sim')\n", 'has no ins_sim')])
def test_other_versions_are_refused(processes, tmp_path, source, found):
    """Another version of ins_sim on a worker is refused; the message names both."""
    (tmp_path / 'ins_sim').mkdir()
    (tmp_path / 'ins_sim' / '__init__.py').write_text(source, encoding='utf-8')
    processes.worker(path=tmp_path)
    with pytest.raises(ValueError, match=found), open_executor(scheduler=processes.address):
        pass


@pytest.mark.parametrize('name', ['Python', 'NumPy'])
def test_another_python_is_refused(processes, monkeypatch, name):
    """Another version of Python or NumPy on a worker is refused."""
    processes.worker()
    theirs = cluster.own_versions()[name]
    monkeypatch.setattr(cluster, 'own_versions',
                        lambda: {**dict.fromkeys(('Python', 'NumPy', 'ins_sim'), theirs),
                                 'Python': '3.0' if name == 'Python' else '.'.join(
                                     map(str, sys.version_info[:2])),
                                 'NumPy': '1.0' if name == 'NumPy' else np.__version__})
    with pytest.raises(ValueError, match=f'has {name} {theirs}; expected {name} [13].0'):
        with open_executor(scheduler=processes.address):
            pass
