"""
Draw charts as zoomable Bokeh panels: the scripts and data that the page needs.

Each panel has its own element in the page, so that legends and titles belong to the page. The
panels of a chart with a common horizontal axis are zoomed together.
"""

import json
import re

from bokeh import __version__
from bokeh.document import Document
from bokeh.models import PlainText, Range1d
from bokeh.plotting import figure
from bokeh.resources import Resources

from ins_sim.visible_text import visible
from ..charts.chart import Bars, LOG
from ..charts.extent import horizontal_range, vertical_range
from ..charts.palette import coloured
from .bokeh_marks import draw

TOOLS = 'box_zoom,pan,wheel_zoom,reset,save'
# Height of a panel, and of one whose axes have the same scale, px.
PANEL, EQUAL = 250, 480
VERSION, OLDEST = __version__, (3, 4)
# Fixed margins for the axis numbers, so that the panels are aligned below each other.
LEFT, RIGHT = 68, 14
if tuple(int(part) for part in VERSION.split('.')[:2]) < OLDEST:
    raise ImportError(f'Bokeh is {VERSION}; expected 3.4 or newer', name='bokeh')
_ID = re.compile(r'"id":"(p\d+)"')
_EMBED = """
(function () {
  const figures = JSON.parse(document.getElementById('figures').textContent);
  // A finger that moves over a figure scrolls the page.
  if (window.matchMedia('(pointer: coarse)').matches)
    for (const root of figures.document.roots)
      root.attributes.toolbar.attributes.active_drag = null;
  Bokeh.embed.embed_items({figures: figures.document},
                          [{docid: 'figures', roots: figures.roots,
                            root_ids: Object.keys(figures.roots)}]);
})();
"""


def panel_ids(charts):
    """Return, for each Chart, the ids of the page elements of its panels."""
    return [[f'figure-{k}-{n}' for n in range(len(chart.panels))]
            for k, chart in enumerate(charts)]


def scripts(charts):
    """Return the scripts that draw Charts into the elements of ``panel_ids``."""
    document, elements = Document(), {}
    for chart, ids in zip(charts, panel_ids(charts)):
        for panel, name in zip(_panels(chart), ids):
            document.add_root(panel)
            elements[panel.id] = name
    drawn = _compact(document.to_json(deferred=False))
    # Bokeh numbers its objects throughout the process; renumber them so that equal reports have
    # equal bytes.
    fresh = {}
    for found in _ID.findall(drawn):
        fresh.setdefault(found, f'p{len(fresh)}')
    drawn = _ID.sub(lambda found: f'"id":"{fresh[found[1]]}"', drawn)
    roots = _compact({fresh[name]: element for name, element in elements.items()})
    library = '\n'.join(Resources(mode='inline', components=['bokeh'], log_level='warn').js_raw)
    data = f'{{"document":{drawn},"roots":{roots}}}'.replace('<', '\\u003c')
    return (f'<script>{library}</script>\n'
            f'<script type="application/json" id="figures">{data}</script>\n'
            f'<script>{_EMBED}</script>')


def _compact(value):
    return json.dumps(value, separators=(',', ':'), allow_nan=False)


def _panels(chart):
    """Return the panels of a Chart as figures of Bokeh."""
    shared, drawn = chart.shared and len(chart.panels) > 1, []
    common = _range(*horizontal_range(chart.panels)) if shared else None
    for place, panel in enumerate(chart.panels):
        lowest = place + chart.columns >= len(chart.panels)
        drawn.append(_panel(panel, common or _range(*horizontal_range((panel,))),
                            panel.x_label if lowest or not shared else ''))
    return drawn


def _range(first, last):
    return Range1d(float(first), float(last))


def _panel(panel, x_range, x_label):
    marks = coloured(panel.marks)
    bottom, top = vertical_range(panel)
    if any(isinstance(mark, Bars) for mark in marks):
        bottom, top = top, bottom
    ranges = {} if panel.equal else {'x_range': x_range, 'y_range': _range(bottom, top)}
    drawn = figure(
        height=EQUAL if panel.equal else round(PANEL * panel.height), sizing_mode='stretch_width',
        match_aspect=panel.equal, tools=TOOLS, active_drag='box_zoom', toolbar_location='right',
        x_axis_type='log' if panel.x_scale == LOG else 'linear',
        y_axis_type='log' if panel.y_scale == LOG else 'linear',
        x_axis_label=PlainText(visible(x_label)), y_axis_label=PlainText(visible(panel.y_label)),
        min_border_left=LEFT, min_border_right=RIGHT, **ranges)
    drawn.toolbar.logo = None
    drawn.axis.axis_label_text_font_style = 'normal'
    drawn.axis.axis_label_text_font_size = drawn.axis.major_label_text_font_size = '12px'
    drawn.grid.grid_line_alpha = 0.5
    for mark in marks:
        draw(mark, drawn, panel)
    if panel.note:
        drawn.text([0.5 * (x_range.start + x_range.end)], [0.5 * (bottom + top)],
                   [visible(panel.note)], text_align='center', text_baseline='middle')
    return drawn
