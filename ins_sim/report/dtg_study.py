"""The study of the tuned-gyro paper in tables and two figures."""

import matplotlib

matplotlib.use('Agg')

from matplotlib.figure import Figure  # noqa: E402
from rich.console import Console  # noqa: E402
from rich.table import Table  # noqa: E402


def show(title, column, cells, console=None):
    """Print the Cells of a table beside what the paper prints."""
    table = Table(title=title)
    for head in (column, 'Poisson [deg]', 'Euler vector [deg]', 'paper [deg]', 'ours - paper'):
        table.add_column(head, justify='right')
    for cell in cells:
        table.add_row(f'{cell.value:g}', f'{cell.poisson_deg:.4f}', f'{cell.euler_vector_deg:.4f}',
                      f'{cell.paper_deg:g}', f'{cell.poisson_deg - cell.paper_deg:+.4f}')
    (console or Console()).print(table)


def save_figure(path, label, curve, table, true_deg, limits=()):
    """
    Save the error of the amplitude over its cause as PNG.

    curve: Cells of a dense sweep; table: those with the paper's values, drawn in as points;
    limits: vertical lines where the program of the paper becomes unstable.
    """
    figure = Figure(figsize=(8, 5), layout='constrained')
    axes = figure.subplots()
    axes.plot([c.value for c in curve], [c.poisson_deg - true_deg for c in curve],
              label='simulated')
    axes.plot([c.value for c in table], [c.paper_deg - true_deg for c in table], 'ko',
              label='paper')
    for k, limit in enumerate(limits):
        axes.axvline(limit, color='tab:red', ls='--', lw=1,
                     label=None if k else 'limits of stability')
    axes.set_xlabel(label)
    axes.set_ylabel('error of the roll amplitude [deg]')
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(path, dpi=110)
