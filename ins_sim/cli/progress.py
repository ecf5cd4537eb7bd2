"""The progress bars of the verbs that take longer than a moment."""

from contextlib import contextmanager

from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn


@contextmanager
def progress_bars(console, unit=None):
    """
    Show progress bars on a console while the block runs, and remove them at its end.

    Parameters
    ----------
    console : rich.console.Console
        Where the bars appear.
    unit : str, optional
        What is counted, such as 'flights': a bar shows '3 of 24 flights'. Without it a bar shows
        a percentage.

    Yields
    ------
    callable
        ``add_bar(label, total=1.0)`` adds a bar and returns the function that takes how much of
        the total is done.
    """
    amount = ('{task.percentage:>3.0f} %' if unit is None else
              f'{{task.completed:.0f}} of {{task.total:.0f}} {unit}')
    with Progress(TextColumn('{task.description}', markup=False), BarColumn(),
                  TextColumn(amount), TimeRemainingColumn(), console=console,
                  transient=True) as progress:

        def add_bar(label, total=1.0):
            task = progress.add_task(label, total=total)
            return lambda done: progress.update(task, completed=done)

        yield add_bar
