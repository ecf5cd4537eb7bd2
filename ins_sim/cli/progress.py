"""Show progress as bars in a terminal, or as lines on stderr otherwise."""

from contextlib import contextmanager
import sys
import time

from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn


# Time to the first line and between lines, if the output is a pipe or a file.
FIRST_S, NEXT_S = 5.0, 30.0


@contextmanager
def progress_bars(console, unit=None):
    """
    Show progress bars on a console while the block runs, and remove them at its end.

    If the console is not a terminal, lines on stderr report the progress instead.

    Parameters
    ----------
    console : rich.console.Console
        Console of the bars.
    unit : str, optional
        Unit of the count, such as 'flights': a bar then shows '3 of 24 flights'. Without it a bar
        shows a percentage.

    Yields
    ------
    callable
        ``add_bar(label, total=1.0)`` adds a bar and returns a function; call it with the part of
        the total that is done.
    """
    if not console.is_terminal:
        yield lambda label, total=1.0: ProgressLines(label, total, unit)
        return
    amount = ('{task.percentage:>3.0f} %' if unit is None else
              f'{{task.completed:.0f}} of {{task.total:.0f}} {unit}')
    with Progress(TextColumn('{task.description}', markup=False), BarColumn(),
                  TextColumn(amount), TimeRemainingColumn(), console=console,
                  transient=True) as progress:

        def add_bar(label, total=1.0):
            task = progress.add_task(label, total=total)
            return lambda done: progress.update(task, completed=done)

        yield add_bar


class ProgressLines:
    """Prints lines on stderr with the part that is done and the estimated time left."""

    def __init__(self, label, total, unit):
        self._label, self._total, self._unit = label, total, unit
        self._start = time.monotonic()
        self._next = self._start + FIRST_S

    def __call__(self, done):
        """Report the part of the total that is done; a line is printed from time to time."""
        now = time.monotonic()
        if now < self._next or done <= 0.0:
            return
        self._next = now + NEXT_S
        amount = (f'{100.0 * done / self._total:.0f} %' if self._unit is None else
                  f'{done:.0f} of {self._total:.0f} {self._unit}')
        left_s = round((now - self._start) * max(0.0, self._total / done - 1.0))
        hours, minutes, seconds = left_s // 3600, left_s // 60 % 60, left_s % 60
        print(f'{self._label}: {amount}, {hours}:{minutes:02d}:{seconds:02d} left',
              file=sys.stderr, flush=True)
