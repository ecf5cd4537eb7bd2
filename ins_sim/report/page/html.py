"""A report as one HTML file, which holds everything that it shows."""

from html import escape

REPORT = 'report.html'


def write_page(folder, page):
    """
    Write a Page as report.html into a folder (pathlib.Path).

    Interim form without figures: the drawer takes its place.
    """
    body = [f'<h1>{escape(page.title)}</h1>', f'<p>{escape(page.answer)}</p>']
    body += [f'<h2>{escape(chart.title)}</h2>' for chart in page.charts]
    for table in page.tables:
        rows = ''.join('<tr>' + ''.join(f'<td>{escape(str(cell))}</td>' for cell in row) + '</tr>'
                       for row in (table.heads, *table.rows))
        body.append(f'<h2>{escape(table.title)}</h2><table>{rows}</table>')
    body += [f'<p>{escape(note)}</p>' for note in page.notes]
    (folder / REPORT).write_text('<!doctype html>\n' + '\n'.join(body), encoding='utf-8')
