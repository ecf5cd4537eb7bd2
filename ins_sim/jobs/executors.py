"""Executors for the blocks of a study: this process, local processes, or a cluster."""

from contextlib import contextmanager

from .processes import cores, LocalProcesses, ThisProcess


@contextmanager
def open_executor(jobs=0, scheduler=None):
    """
    Open an executor for ``run_blocks``; leaving the context closes it.

    Parameters
    ----------
    jobs : int, optional
        Number of local processes; 0: one for each core; 1: this process alone.
    scheduler : str, optional
        Address of the scheduler of a Dask cluster, used instead of local processes.

    Yields
    ------
    ThisProcess, LocalProcesses or Cluster

    Raises
    ------
    ValueError
        If both are given, jobs is negative, or the cluster cannot be used.
    """
    check_jobs(jobs, scheduler)
    if scheduler is not None:
        from .cluster import Cluster
        executor = Cluster(scheduler)
    else:
        jobs = jobs or cores()
        executor = ThisProcess() if jobs == 1 else LocalProcesses(jobs)
    try:
        yield executor
    finally:
        executor.close()


def check_jobs(jobs, scheduler=None):
    """Raise ValueError if jobs is negative, or given together with a scheduler."""
    if jobs < 0:
        raise ValueError(f'jobs is {jobs}; expected 0 (all cores) or more')
    if scheduler is not None and jobs:
        raise ValueError(f'jobs is {jobs}, and a scheduler is given; expected only one of them: a '
                         'cluster has its own workers')
