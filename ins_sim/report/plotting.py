"""
What all figures share: size, colours, the number of points drawn, and how a figure is saved.

``Figure`` objects are used without pyplot, so no window is opened and no backend is chosen.
"""

from ins_sim.core.numerics.garbage_collection import collector_paused
from ins_sim.visible_text import visible

with collector_paused:
    from matplotlib.figure import Figure
    from matplotlib.text import Text

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


def thinned(values):
    """Return every n-th of a sequence, so many that a curve still looks the same."""
    return values[::max(1, len(values) // MOST_POINTS)]


def finish_panel(axes, label):
    """Give a panel the label of its vertical axis, a grid and a legend."""
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    axes.legend(loc='best', fontsize='small')


def save_png(figure, path):
    """
    Save a figure as PNG, quickly rather than as small as can be.

    Names of files are drawn as they are, with escapes for what is no UTF-8 or cannot be seen.
    """
    for text in figure.findobj(Text):
        text.set_parse_math(False)
        text.set_text(visible(text.get_text(), keep='\n'))
    with collector_paused:
        figure.savefig(path, dpi=DPI, pil_kwargs={'compress_level': 2})
