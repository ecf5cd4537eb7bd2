"""The progress bar of the verbs."""

from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn


class ProgressBar(Progress):
    """
    A bar for each task, on a terminal only, removed at the end; use it as a context manager.

    unit: of the amounts that are shown, such as 'flights'; without one the bar shows per cent.
    """

    def __init__(self, console, unit=None):
        amount = ('{task.percentage:>3.0f} %' if unit is None
                  else f'{{task.completed:.0f}} of {{task.total:.0f}} {unit}')
        super().__init__(TextColumn('{task.description}'), BarColumn(), TextColumn(amount),
                         TimeRemainingColumn(), console=console, transient=True)

    def watch(self, name, total=1.0):
        """Add a task; return the function that takes how much of total is done."""
        task = self.add_task(name, total=total)
        return lambda done: self.update(task, completed=done)
