"""
Draw docs/figures/data_flow.svg and write the import table of docs/explanation/architecture.md.

The table is MAY_IMPORT of the architecture test; the picture shows how data flow from the motion
to the errors. Run it again after a change of either: ``python tools/draw_architecture.py``.
"""

from pathlib import Path
import re
import sys

from matplotlib import rcParams
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / 'docs' / 'explanation' / 'architecture.md'
PICTURE = ROOT / 'docs' / 'figures' / 'data_flow.svg'
MARKS = ('<!-- import table: python tools/draw_architecture.py -->', '<!-- end of the table -->')
# Name: x, y of the centre, text.
BOXES = {
    'motion': (1.0, 2.0, 'Motion\nclosed form, route,\nrecording, guided'),
    'stream': (1.0, 0.6, 'Truth adapter\nGazebo and other\nsimulators'),
    'truth': (3.0, 2.0, 'Truth\nposition, attitude,\nrate, force'),
    'imu': (5.0, 3.0, 'IMU\nideal or tuned gyros,\ndelays, errors'),
    'meter': (5.0, 1.75, 'Velocity meter'),
    'gnss': (5.0, 0.9, 'GNSS'),
    'strapdown': (7.2, 3.0, 'Strapdown\nfree INS'),
    'aided': (7.2, 1.4, 'Aided navigator\nfilter'),
    'errors': (9.4, 2.2, 'Errors\nsolution minus truth'),
}
ARROWS = (('motion', 'truth'), ('stream', 'truth'), ('truth', 'imu'), ('truth', 'meter'),
          ('truth', 'gnss'), ('imu', 'strapdown'), ('imu', 'aided'), ('meter', 'aided'),
          ('gnss', 'aided'), ('strapdown', 'errors'), ('aided', 'errors'))


def draw(path):
    """Draw the data flow as an SVG file."""
    rcParams.update({'svg.hashsalt': 'ins_sim', 'svg.fonttype': 'none', 'font.size': 10})
    figure = Figure(figsize=(10.5, 4.0))
    FigureCanvasSVG(figure)
    axes = figure.add_subplot()
    axes.set(xlim=(0, 10.4), ylim=(-0.3, 3.8))
    axes.axis('off')
    boxes = {name: axes.text(x, y, text, ha='center', va='center',
                             bbox={'boxstyle': 'round,pad=0.45', 'fc': '#eef3fa',
                                   'ec': '#30557f'})
             for name, (x, y, text) in BOXES.items()}
    figure.canvas.draw()
    style = {'arrowstyle': '-|>', 'color': '#30557f'}
    for start, end in ARROWS:
        axes.annotate('', xy=BOXES[end][:2], xytext=BOXES[start][:2],
                      arrowprops={**style, 'patchA': boxes[start].get_bbox_patch(),
                                  'patchB': boxes[end].get_bbox_patch()})
    axes.annotate('', xy=(1.0, 2.45), xytext=(7.2, 3.4),
                  arrowprops={**style, 'linestyle': 'dashed',
                              'connectionstyle': 'arc3,rad=0.25'})
    axes.text(3.3, 3.55, 'steering, for guided motions only', ha='center', style='italic')
    figure.savefig(path, metadata={'Date': None}, bbox_inches='tight')


def may_import():
    """Return MAY_IMPORT, {room: set of rooms it may import}, and CORE of the architecture test."""
    source = (ROOT / 'test' / 'packaging' / 'test_architecture.py').read_text(encoding='utf-8')
    names = {}
    exec(source[source.index('EARTH = {'):source.index('def room_of')], names)
    return names['MAY_IMPORT'], names['CORE']


def table():
    """Return the import table in Markdown, one room a row."""
    rooms, core = may_import()
    rows = ['| room | may import |', '| --- | --- |']
    for room, others in rooms.items():
        names = sorted(others - {room})
        if core <= others:
            names = ['all of core', *sorted(others - core - {room})]
        # Two underscores would be bold type.
        names = [f'`{name}`' if name.startswith('__') else name for name in names]
        rows.append(f'| `{room}` | {", ".join(names) or "nothing"} |')
    return '\n'.join(rows)


def with_table(text):
    """Return the text of the page with the present table between its marks."""
    start, end = (re.escape(mark) for mark in MARKS)
    new = f'{MARKS[0]}\n\n{table()}\n\n{MARKS[1]}'
    return re.sub(f'{start}.*{end}', lambda _: new, text, flags=re.DOTALL)


def main():
    """Draw the picture and write the table."""
    draw(PICTURE)
    PAGE.write_text(with_table(PAGE.read_text(encoding='utf-8')), encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main())
