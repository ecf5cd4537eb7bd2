"""The result of an ensemble does not depend on its workers, even if some are killed."""

import os
import signal
import subprocess
import sys
import time

import ins_sim
from ins_sim.io.motion import read_motion
from ins_sim.jobs.executors import open_executor
from ins_sim.jobs.fingerprint import array_digest
from ins_sim.studies.ensembles import EnsemblePlan, fly_ensemble
import numpy as np
import pytest
from support.nodes.clusters import Processes
from support.places import ROOT

WORDS = ['--params-file', 'racetrack', '--params-file', 'imu_tactical_fog', '-p',
         'duration_s:=30.0']
RUNS = 90


def plan_of(runs=RUNS, **values):
    """Return an EnsemblePlan of a flight of 30 s."""
    return EnsemblePlan(ins_sim.read_settings(['racetrack', 'imu_tactical_fog'],
                                              {'duration_s': 30.0, **values}), runs, 11)


def digest(executor, progress=None):
    """Return the digest of the ensemble on an executor."""
    return array_digest(fly_ensemble(plan_of(), read_motion, executor,
                                     progress=progress).arrays())


@pytest.fixture(scope='module')
def alone():
    """Return the digest of the ensemble computed in this process alone."""
    with open_executor(1) as executor:
        return digest(executor)


def test_blocks_are_whole_and_do_not_depend_on_workers():
    """
    Blocks cover all runs in groups of 16, and do not depend on the number of workers.

    They begin at the run of the settings, and there are a few tens of them.
    """
    for runs in (1, 16, 90, 1000, 10 ** 5):
        blocks = plan_of(runs, run=7).blocks()
        assert [k for block in blocks for k in block] == list(range(7, 7 + runs))
        assert all(len(block) % 16 == 0 for block in blocks[:-1])
        assert len(blocks) <= max(16, runs // 256 + 1)
    # Tuned gyros are simulated one by one.
    assert {len(b) for b in EnsemblePlan(ins_sim.read_settings(
        ['racetrack', 'imu_tactical_dtg'], {'duration_s': 1.0}), 40).blocks()} == {3, 1}


def test_two_workers_one_of_them_killed(alone):
    """With two workers, one of them killed, the digest is that of one process."""
    with open_executor(2) as executor:
        assert digest(executor) == alone
    killed = []

    def kill(done):
        if not killed:
            killed.append(next(iter(executor._pool._processes)))
            os.kill(killed[0], signal.SIGKILL)

    with open_executor(2) as executor:
        assert digest(executor, kill) == alone and killed


@pytest.mark.slow
def test_a_cluster_one_worker_of_which_is_killed(alone):
    """On a cluster, with one worker killed, the digest is that of one process."""
    pytest.importorskip('distributed', reason='needs Dask (extra cluster)')
    cluster = Processes()
    try:
        workers = [cluster.worker(), cluster.worker()]
        with open_executor(scheduler=cluster.address) as executor:
            assert digest(executor, lambda done: workers[0].kill()) == alone
    finally:
        for process in reversed(cluster.all):
            process.kill()
            process.communicate()


def monte_carlo(folder, *words, **more):
    """Return the Popen of the command in a folder."""
    return subprocess.Popen(
        [sys.executable, '-m', 'ins_sim', 'monte-carlo', *WORDS, '--runs', str(RUNS),
         '--instants', '11', '-o', 'study', *words], cwd=folder, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        env={**os.environ, 'PYTHONPATH': str(ROOT)}, **more)


@pytest.mark.slow
def test_an_interrupted_study_goes_on(alone, tmp_path):
    """A resumed study finds its finished blocks, and its digest is that of a single pass."""
    blocks = tmp_path / 'study.blocks'
    first = monte_carlo(tmp_path, '--jobs', '2')
    while len(list(blocks.glob('block_*.npz'))) < 2 and first.poll() is None:
        time.sleep(0.01)
    first.send_signal(signal.SIGINT)
    first.communicate()
    there = len(list(blocks.glob('block_*.npz')))
    assert first.returncode == 130 and not (tmp_path / 'study').exists() and 2 <= there < 6
    other = monte_carlo(tmp_path, '-p', 'seed:=5')
    _, said = other.communicate()
    assert other.returncode == 2 and 'imu_sensor: seed is 0 there and 5 here' in said
    second = monte_carlo(tmp_path, '--jobs', '1')
    out, _ = second.communicate()
    assert second.returncode == 0 and f'{there} of 6 blocks found in study.blocks' in out
    assert f'SHA-256 of the result: {alone}' in out and not blocks.exists()
    with np.load(tmp_path / 'study' / 'ensemble.npz') as found:
        assert len(found['runs']) == RUNS and found['t_ns'].tolist()[-1] == 30_000_000_000


@pytest.mark.slow
def test_run_417_alone():
    """The end of run 417 of 1000 has the bits of ``simulate`` with this run."""
    settings = ins_sim.read_settings(['racetrack', 'imu_tactical_fog'], {'duration_s': 20.0})
    study = ins_sim.monte_carlo(settings)
    alone = ins_sim.simulate(ins_sim.read_settings(['racetrack', 'imu_tactical_fog'], {
        'duration_s': 20.0, 'run': 417}), twin=False)
    for name, ends in study.final_errors.items():
        np.testing.assert_array_equal(ends[417], getattr(alone.errors, name)[-1])
    np.testing.assert_array_equal(study.result.final[417, 6:], alone.states.q_nb[-1])
