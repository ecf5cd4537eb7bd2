"""Figures of a report: zoomable Bokeh figures, or images if Bokeh is not installed."""

from base64 import b64encode
from dataclasses import dataclass

from ..charts.palette import coloured
from ..charts.png import chart_png
from .legend import legend
from .words import text

COLUMNS = {1: '', 2: ' two', 3: ' three'}


@dataclass(frozen=True)
class DrawnFigures:
    """HTML of the figures (``parts``), ``scripts`` that draw them, ``version`` of Bokeh or ''."""

    parts: list
    scripts: str = ''
    version: str = ''


def zoomable(page):
    """Return the DrawnFigures of a Page by Bokeh, or None where it is not installed."""
    charts = page.charts
    if not charts:
        return DrawnFigures([])
    try:
        # Imported lazily: the import takes half a second and only reports need it.
        from . import bokeh_panels
    except ImportError as error:
        if (error.name or '').partition('.')[0] != 'bokeh':
            raise
        return None
    parts = []
    for chart, ids in zip(charts, bokeh_panels.panel_ids(charts)):
        panels = ''.join(
            '<div class="panel">' + (f'<h3>{text(panel.title)}</h3>' if panel.title else '')
            + legend(coloured(panel.marks)) + f'<div id="{name}" class="plot"></div></div>\n'
            for panel, name in zip(chart.panels, ids))
        parts.append(_figure(
            page, chart, f'<div class="panels{COLUMNS[chart.columns]}">\n{panels}</div>'))
    return DrawnFigures(parts, bokeh_panels.scripts(charts), bokeh_panels.VERSION)


def images(folder, page):
    """Return the DrawnFigures of a Page as images; existing ones in the folder are reused."""
    parts = []
    for chart in page.charts:
        path = folder / f'{chart.name}.png'
        data = b64encode(path.read_bytes() if path.exists() else chart_png(chart)).decode('ascii')
        parts.append(_figure(page, chart, f'<img alt="{text(chart.title)}" '
                             f'src="data:image/png;base64,{data}">'))
    return DrawnFigures(parts)


def _figure(page, chart, content):
    # Do not repeat the title of the page in that of the figure.
    title = chart.title.removeprefix(f'{page.title}: ')
    title = title[:1].upper() + title[1:]
    caption = f'<figcaption>{text(chart.caption)}</figcaption>' if chart.caption else ''
    return (f'<section><h2>{text(title)}</h2>\n<figure>{content}{caption}</figure>'
            '</section>')
