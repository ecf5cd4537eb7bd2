"""Processes that share the work of a verb."""

import os
import signal


def run_all(tasks, jobs, console, unit):
    """
    Return what each task returns, in their order.

    tasks: list of (function, arguments ...), which can be pickled; jobs: processes, 0: as many as
    cores; unit: what is counted, such as 'flights'.
    """
    from concurrent.futures import as_completed, ProcessPoolExecutor
    from multiprocessing import active_children
    from .progress import progress_bars
    results, jobs = [None] * len(tasks), jobs or os.cpu_count()
    with progress_bars(console, unit) as add_bar:
        show = add_bar('flying', len(tasks))
        with ProcessPoolExecutor(min(jobs, len(tasks)), initializer=_begin_worker) as pool:
            futures = {pool.submit(*task): k for k, task in enumerate(tasks)}
            try:
                for done, future in enumerate(as_completed(futures), 1):
                    results[futures[future]] = future.result()
                    show(done)
            except BaseException:
                # Running flights are not waited for: each takes minutes.
                for worker in active_children():
                    worker.kill()
                raise
    return results


def _begin_worker():
    """Leave the signals of a terminal to the process that started this one, and end with it."""
    from ins_sim.ros.process.tied import end_with_parent
    end_with_parent(os.getppid(), signal.SIGKILL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
