"""Distribute the tasks of a verb over processes."""


def run_all(tasks, jobs, console, unit):
    """
    Run tasks in several processes and return their results in order.

    Parameters
    ----------
    tasks : list of (function, argument, ...), which can be pickled
    jobs : number of processes; 0 = one for each core
    console : console of the progress bar
    unit : unit of the count in the progress bar, such as 'flights'
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
