"""
Write a report as one self-contained HTML file.

Figures can be zoomed if Bokeh is installed (extra ``report``); otherwise they are images, and the
report says so. Equal reports have equal bytes.
"""

from ins_sim.core.numerics.garbage_collection import collector_paused
from . import figures
from .style import STYLE
from .tables import files_list, settings_section, table_section
from .words import text

REPORT = 'report.html'
NO_BOKEH = ('The figures are images. They can be zoomed in a report that is written where Bokeh '
            '3.4 or newer is installed: pip install "ins_sim[report]".')


def write_page(folder, page):
    """
    Write a Page as report.html into a folder (pathlib.Path).

    Without Bokeh the figures are images: those that ``save_chart`` has written into the folder, or
    new ones.
    """
    with collector_paused:
        drawn = figures.zoomable(page) or figures.images(folder, page)
    body = [f'<header><h1>{text(page.title)}</h1>', f'<p class="answer">{text(page.answer)}</p>',
            '</header>', '<main>', *drawn.parts]
    body += [table_section(table) for table in page.tables]
    if page.notes:
        body.append(_section('Notes', '<ul>' + ''.join(
            f'<li>{text(note)}</li>' for note in page.notes) + '</ul>'))
    body.append(_section('What was simulated', settings_section(page, drawn.version)))
    if page.files:
        body.append(_section('Data', files_list(page.files)))
    if page.charts and not drawn.version:
        body.append(f'<p>{text(NO_BOKEH)}</p>')
    body += ['</main>', drawn.scripts]
    (folder / REPORT).write_text(
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<title>{text(page.title)}</title>\n<link rel="icon" href="data:,">\n'
        f'<style>{STYLE}</style>\n</head>\n<body>\n' + '\n'.join(body) + '\n</body>\n</html>\n',
        encoding='utf-8')


def _section(title, content):
    return f'<section><h2>{text(title)}</h2>\n{content}</section>'
