"""Processes that share the tasks of a verb."""


def run_all(tasks, jobs, console, unit):
    """
    Return what each task returns, in their order.

    tasks: list of (function, arguments ...), which can be pickled; jobs: processes, 0: as many as
    cores; unit: what is counted, such as 'flights'.
    """
    from ins_sim.jobs.blocks import run_blocks
    from ins_sim.jobs.executors import open_executor
    from .progress import progress_bars
    with progress_bars(console, unit) as add_bar, open_executor(jobs) as executor:
        show = add_bar('flying', len(tasks))
        return [result for _, result in run_blocks(_call, tasks, executor, progress=show)]


def _call(task):
    """Call the function of a task."""
    function, *arguments = task
    return function(*arguments)
