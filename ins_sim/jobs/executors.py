"""What computes the blocks of a study: this process, processes of this machine, or a cluster."""

from contextlib import contextmanager

from .processes import cores, LocalProcesses, ThisProcess


@contextmanager
def open_executor(jobs=0, scheduler=None):
    """
    Give an executor for ``run_blocks``, and end it with the block.

    Parameters
    ----------
    jobs : int, optional
        Processes of this machine; 0: as many as cores; 1: the present one alone.
    scheduler : str, optional
        Address of the scheduler of a Dask cluster, in the place of processes.

    Yields
    ------
    ThisProcess, LocalProcesses or Cluster

    Raises
    ------
    ValueError
        Where both are given, or jobs is negative, or the cluster cannot be used.
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
    """Raise ValueError where there is no such number of processes, or a scheduler as well."""
    if jobs < 0:
        raise ValueError(f'jobs is {jobs}; expected 0 (every core) or more')
    if scheduler is not None and jobs:
        raise ValueError(f'jobs is {jobs}, and a scheduler is given; expected one of them: a '
                         'cluster has workers of its own')
