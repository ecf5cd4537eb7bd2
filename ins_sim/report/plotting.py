"""
What all figures share: size, colours, the number of points drawn, and how a figure is saved.

``Figure`` objects are used without pyplot, so no window is opened and no backend is chosen.
"""

from matplotlib.figure import Figure

DPI = 110
# More points of a curve than this cannot be told apart.
MOST_POINTS = 4000
COLOURS = {'east': 'tab:red', 'north': 'tab:blue', 'up': 'tab:green'}


def new_figure(width, height):
    """Return an empty figure, size in inches, whose parts do not overlap."""
    return Figure(figsize=(width, height), layout='constrained')


def thinned(values):
    """Return every n-th of a sequence, so many that a curve still looks the same."""
    return values[::max(1, len(values) // MOST_POINTS)]


def finish_panel(axes, label):
    """Give a panel the label of its vertical axis, a grid and a legend."""
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    axes.legend(loc='best', fontsize='small')


def save_png(figure, path):
    """Save a figure as PNG."""
    figure.savefig(path, dpi=DPI)
