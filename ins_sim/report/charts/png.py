"""
Draw a chart as PNG with Matplotlib.

The legend of a panel is to its right, where it hides no curve. All sizes, in inches, are computed
before drawing: the automatic layout of Matplotlib would take a third of the time.
"""

from io import BytesIO
from pathlib import Path
from textwrap import fill

from ins_sim.core.numerics.garbage_collection import collector_paused
from ins_sim.visible_text import visible
from .chart import Bars, LOG, Map
from .extent import equal_ranges, horizontal_range, vertical_range
from .palette import coloured
with collector_paused:
    from matplotlib.figure import Figure
    from matplotlib.text import Text
    from matplotlib.ticker import FuncFormatter, LogFormatter
    from .png_marks import draw

DPI = 110
WIDTH, PANEL, EQUAL = 10.0, 2.3, 5.0
LEFT, RIGHT, GAP = 0.95, 0.2, 0.12
# Height of a line of text and width of a character, inches; longest line of a legend, characters.
LINE, CHARACTER, LONGEST = 0.22, 0.075, 34
TICKS = 0.55


def save_chart(folder, chart):
    """Save a Chart as <name>.png into a folder; return the path."""
    path = Path(folder) / f'{chart.name}.png'
    path.write_bytes(chart_png(chart))
    return path


def chart_png(chart):
    """
    Return the bytes of a Chart as PNG.

    Texts are drawn literally; invisible characters and invalid UTF-8 are escaped.
    """
    figure = _draw(chart)
    for text in figure.findobj(Text):
        text.set_parse_math(False)
        text.set_text(visible(text.get_text(), keep='\n'))
    stream = BytesIO()
    with collector_paused:
        figure.savefig(stream, format='png', dpi=DPI, pil_kwargs={'compress_level': 2},
                       metadata={'Software': None})
    return stream.getvalue()


def _draw(chart):
    panels, columns = chart.panels, chart.columns
    rows = [panels[first:first + columns] for first in range(0, len(panels), columns)]
    shared = chart.shared and len(panels) > 1
    left, right = _left(panels), _right(panels, columns)
    width = (WIDTH - columns * left - right - (columns - 1) * RIGHT) / columns
    # Space above and below the axes of each row, and the height of the axes.
    above = [LINE * any(p.title for p in row) + GAP for row in rows]
    heights = [max(EQUAL if p.equal else PANEL * p.height for p in row) for row in rows]
    below = [TICKS if not shared or row is rows[-1] else 0.0 for row in rows]
    title, caption = fill(chart.title, 105), fill(chart.caption, 125)
    head = LINE * (title.count('\n') + 1) + 0.12
    foot = LINE * (caption.count('\n') + 1) if caption else 0.0
    height = head + sum(above) + sum(heights) + sum(below) + foot + 0.05
    figure = Figure(figsize=(WIDTH, height))
    figure.text(0.5, 1.0 - 0.08 / height, title, ha='center', va='top', size=12)
    if caption:
        figure.text(left / WIDTH, 0.05 / height, caption, va='bottom', size=9, color='0.3')
    common = horizontal_range(panels) if shared else None
    top = height - head
    for row, room, tall, under in zip(rows, above, heights, below):
        top -= room
        for column, panel in enumerate(row):
            start = left + column * (left + width + RIGHT)
            axes = figure.add_axes((start / WIDTH, (top - tall) / height, width / WIDTH,
                                    tall / height))
            axes.yaxis.set_label_coords(-(left - 0.22) / width, 0.5)
            _fill(figure, axes, panel, columns == 1)
            x_range = common or horizontal_range((panel,))
            if panel.equal:
                x_range, y_range = equal_ranges(panel, width / tall)
                axes.set_ylim(y_range)
            axes.set_xlim(x_range)
            axes.tick_params(labelbottom=under > 0.0)
            if under:
                axes.set_xlabel(panel.x_label)
        top -= tall + under
    return figure


def _fill(figure, axes, panel, legend_beside):
    """Draw the marks of a panel, its scales, title and legend."""
    marks = coloured(panel.marks)
    bars = any(isinstance(mark, Bars) for mark in marks)
    axes.set_xscale(panel.x_scale)
    axes.set_yscale(panel.y_scale)
    for mark in marks:
        image = draw(mark, axes, panel)
        if image is not None:
            box = axes.get_position()
            bar = figure.add_axes((box.x1 + 0.15 / WIDTH, box.y0, 0.15 / WIDTH, box.height))
            figure.colorbar(image, cax=bar, label=mark.unit)
    low, high = vertical_range(panel)
    axes.set_ylim((high, low) if bars else (low, high))
    axes.set_ylabel(panel.y_label)
    axes.set_title(panel.title, size=10, loc='left')
    if not any(isinstance(mark, Map) for mark in marks):
        axes.grid(which='major', alpha=0.3)
        if LOG in (panel.x_scale, panel.y_scale):
            axes.grid(which='minor', alpha=0.1)
        axes.set_axisbelow(True)
    for axis, scale in ((axes.xaxis, panel.x_scale), (axes.yaxis, panel.y_scale)):
        if scale == LOG:
            # Plain number format: texts are not parsed as formulas.
            axis.set_major_formatter(FuncFormatter(lambda value, _: f'{value:g}'))
            axis.set_minor_formatter(LogFormatter(minor_thresholds=(1.0, 0.4)))
        elif not (bars and axis is axes.yaxis):
            axis.get_major_formatter().set_useOffset(False)
    if panel.note:
        axes.text(0.5, 0.5, panel.note, ha='center', va='center', transform=axes.transAxes)
    handles, labels = axes.get_legend_handles_labels()
    if handles:
        labels = [fill(label, LONGEST) for label in labels]
        place = {'loc': 'upper left', 'bbox_to_anchor': (1.0, 1.02)} if (
            legend_beside and not _has_map(panel)) else {'loc': 'best'}
        axes.legend(handles, labels, fontsize=9, frameon=not legend_beside, **place)


def _left(panels):
    """Return the margin left of the axes, inches, with room for the labels of bars."""
    longest = max((len(label) for panel in panels for mark in panel.marks
                   if isinstance(mark, Bars) for label in mark.labels), default=0)
    return max(LEFT, min(0.5 + CHARACTER * longest, 0.45 * WIDTH))


def _right(panels, columns):
    """Return the margin right of the axes, inches, with room for the legends."""
    if any(_has_map(panel) for panel in panels):
        return RIGHT + 0.85
    if columns > 1:
        return RIGHT
    labels = [label for panel in panels for mark in panel.marks
              for label in (getattr(mark, 'labels', ()) if not isinstance(mark, Bars) else ())
              or (getattr(mark, 'label', None),) if label]
    longest = min(max(map(len, labels), default=0), LONGEST)
    return RIGHT + (0.55 + CHARACTER * longest if longest else 0.0)


def _has_map(panel):
    return any(isinstance(mark, Map) for mark in panel.marks)
