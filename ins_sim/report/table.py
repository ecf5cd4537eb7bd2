"""Tables for a terminal."""

from rich.table import Table

from .console import PlainConsole
from .summary import DEG_PER_HOUR

COLUMNS = (('predicted', 'predicted'), ('measured', 'measured'), ('twin', 'zero-delay twin'),
           ('published', 'paper / re-derived'))


def number_text(value):
    """Return a figure with six significant digits, or a dash."""
    return '-' if value is None else f'{value + 0.0:.6g}'


def show_table(title, rows, console=None):
    """Print the rows of ``summary.rows``; columns that are empty throughout are left out."""
    columns = [c for c in COLUMNS if any(getattr(r, c[0]) is not None for r in rows)]
    table = Table(title=title)
    table.add_column('figure')
    table.add_column('unit')
    for _, head in columns:
        table.add_column(head, justify='right')
    for row in rows:
        table.add_row(row.name, row.unit, *(number_text(getattr(row, c)) for c, _ in columns))
    (console or PlainConsole()).print(table)


def show_resonances(resonances, console=None):
    """Print the resonances of motion 2, if any."""
    if not resonances:
        return
    table = Table(title='resonances of motion 2')
    for head in ('resonance', "psi' [rad/s]", 'drift east [deg/h]', 'drift north [deg/h]'):
        table.add_column(head, justify='left' if head == 'resonance' else 'right')
    for name, rate, drift in resonances:
        table.add_row(name, number_text(rate), number_text(drift[0] * DEG_PER_HOUR),
                      number_text(drift[1] * DEG_PER_HOUR))
    (console or PlainConsole()).print(table)
