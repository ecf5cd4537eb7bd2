"""
What all figures share: size, colours, the number of points drawn, and how a figure is saved.

``Figure`` objects are used without pyplot, so no window is opened and no backend is chosen.
"""

from ins_sim.core.numerics.garbage_collection import collector_paused
from ins_sim.visible_text import visible

with collector_paused:
    from matplotlib.figure import Figure

DPI = 110
# More points of a curve than this cannot be told apart.
MOST_POINTS = 4000
COLOURS = {'east': 'tab:red', 'north': 'tab:blue', 'up': 'tab:green'}


def new_figure(width, height, margins=None):
    """
    Return an empty figure, size in inches, whose parts do not overlap.

    margins: of the panels, as ``Figure.subplots_adjust`` takes them, where they are known; to find
    them takes as long as a third of the drawing.
    """
    if margins is None:
        return Figure(figsize=(width, height), layout='constrained')
    figure = Figure(figsize=(width, height))
    figure.subplots_adjust(**margins)
    return figure


def literal(text):
    """Return a text, perhaps with names of files, that a figure shows as it is."""
    return visible(text).replace('$', r'\$')


def thinned(values):
    """Return every n-th of a sequence, so many that a curve still looks the same."""
    return values[::max(1, len(values) // MOST_POINTS)]


def finish_panel(axes, label):
    """Give a panel the label of its vertical axis, a grid and a legend."""
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    axes.legend(loc='best', fontsize='small')


def save_png(figure, path):
    """Save a figure as PNG, quickly rather than as small as can be."""
    with collector_paused:
        figure.savefig(path, dpi=DPI, pil_kwargs={'compress_level': 2})
