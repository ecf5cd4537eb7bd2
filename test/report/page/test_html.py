"""The HTML page of a report is complete, escaped, reproducible, and limited in size."""

from html.parser import HTMLParser
import re
import subprocess
import sys
from urllib.parse import unquote_to_bytes

from ins_sim import parameter_files, resources
from ins_sim.report.charts.chart import Chart, Curve, Panel
from ins_sim.report.page.content import Page, PageTable
from ins_sim.report.page.differences import changed_settings
from ins_sim.report.page.html import NO_BOKEH, REPORT, write_page
from ins_sim.report.page.words import cell_text
import numpy as np
import pytest
from support.reports.charts import every_mark

MEGABYTE = 1e6
SETTINGS = parameter_files.read([resources.config('motion_2'), resources.config('delay_y_1us'),
                                 resources.config('imu_tactical_fog')],
                                ['duration_s:=60.0'])
EVERY = Page('Title <b> & "words"', 'The answer <script>alert(1)</script>.', every_mark(),
             (PageTable('Table <i>', ('name', 'value'), (('a<b>', 1.23456), ('none', None),
                                                         ('count', 12345678)), 'a note'),),
             ('a note & more',), SETTINGS, {'the errors': 'abc'},
             {'run.npz': 'arrays', 'a b%<>"\udce9.csv': 'an odd name'})


class Outline(HTMLParser):
    """Collect tags, texts and links of a page, and check that tags are closed."""

    VOID = {'meta', 'link', 'img', 'br', 'wbr', 'path', 'rect', 'circle'}

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts, self.links, self._open = [], [], [], []
        self.feed(text)
        assert self._open == []

    def handle_starttag(self, tag, attrs):
        """Record a tag."""
        self.tags.append(tag)
        self.links += [value for name, value in attrs if name in ('href', 'src')]
        if tag not in self.VOID:
            self._open.append(tag)

    def handle_startendtag(self, tag, attrs):
        """Record a tag without content."""
        self.tags.append(tag)

    def handle_endtag(self, tag):
        """Close the innermost tag."""
        assert self._open.pop() == tag

    def handle_data(self, data):
        """Record a text that is shown."""
        if self._open and self._open[-1] not in ('script', 'style'):
            self.texts.append(data)


def written(folder, page):
    """Return the text of the report of a Page."""
    write_page(folder, page)
    return (folder / REPORT).read_text(encoding='utf-8')


def test_texts_are_shown_as_they_are(tmp_path):
    """No text of a page, a chart or a file becomes markup; invisible characters are escaped."""
    text = written(tmp_path, EVERY)
    outline = Outline(text)
    read = ''.join(outline.texts)
    for words in ('Title <b> & "words"', 'The answer <script>alert(1)</script>.', 'a<b>', '1.235',
                  '12345678', 'a note & more', 'refused <x>', 'A title <of> & "many"',
                  'a b%<>"\\udce9.csv', 'What is seen.'):
        assert words in read, words
    assert not {'b', 'i', 'of', 'x'} & set(outline.tags)
    assert outline.tags.count('h1') == 1 and {'main', 'header', 'figure', 'table'} <= set(
        outline.tags)
    # The answer precedes figures and tables.
    assert text.index('class="answer"') < min(text.index('<figure>'), text.index('<table'))


def test_the_page_says_what_was_simulated(tmp_path):
    """The page shows changed settings, seed, versions, digest, and links to its files."""
    outline = Outline(written(tmp_path, EVERY))
    read = ''.join(outline.texts)
    for words in ('gyro.delay_us.y', 'two_axis', 'seed of imu_sensor', 'digest of the errors',
                  'ins_sim', 'Python', 'NumPy', 'Numba'):
        assert words in read, words
    assert [unquote_to_bytes(link) for link in outline.links if not link.startswith('data:')] == [
        b'run.npz', b'a b%<>"\xe9.csv']


def test_settings_that_differ_are_those_of_the_file():
    """The settings shown on the page, read as parameters, give the same settings."""
    rows = changed_settings(SETTINGS)
    assert {row[0]: row[1] for row in rows}['gyro.errors.bandwidth_hz'] == '3 × 440.0'
    nodes = {row[0]: row[4] for row in rows}
    assert nodes['motion.kind'] == 'all' and nodes['duration_s'] == 'motion_generator'
    assert ('gyro.delay_us.y', '1.0', '0.0', 'us', 'imu_sensor') in rows
    assert changed_settings(parameter_files.read([resources.config('default')])) == []


def test_the_same_page_has_the_same_bytes(tmp_path):
    """The bytes are reproducible, although Bokeh numbers its objects through the process."""
    pytest.importorskip('bokeh')
    assert written(tmp_path, EVERY) == written(tmp_path, EVERY)


def test_the_script_is_as_small_as_promised(tmp_path):
    """Figures add at most 1.5 MB of script to a page, and nothing is fetched."""
    pytest.importorskip('bokeh')
    empty = Chart('empty', 'Nothing', (Panel((), 'x', 'y'),))
    text = written(tmp_path, Page('t', 'a', (empty,)))
    assert len(text.encode()) <= 1.5 * MEGABYTE
    assert not re.search(r'<(script|link|img)[^>]+(src|href)="(?!data:)', text)


def test_curves_of_an_hour_stay_small(tmp_path):
    """Twenty noisy curves of 360001 points need at most 5 MB, including the script."""
    pytest.importorskip('bokeh')
    t = np.arange(360001) / 6000.0
    noise = np.random.default_rng(1).normal(size=(20, len(t)))
    chart = Chart('x', 'x', tuple(Panel((Curve(t, y, 'y'),), 'time', 'error') for y in noise))
    write_page(tmp_path, Page('t', 'a', (chart,)))
    assert (tmp_path / REPORT).stat().st_size <= 5.0 * MEGABYTE


def test_without_bokeh_the_figures_are_images(tmp_path, without_bokeh):
    """Without Bokeh the page embeds images and states how to get zoomable figures."""
    (tmp_path / 'track.png').write_bytes(b'an image')
    outline = Outline(written(tmp_path, EVERY))
    assert NO_BOKEH in outline.texts
    images = [link for link in outline.links if link.startswith('data:image/png;base64,')]
    assert len(images) == len(EVERY.charts)
    assert 'data:image/png;base64,YW4gaW1hZ2U=' in images
    assert 'Bokeh' not in ''.join(outline.texts).replace(NO_BOKEH, '')


def test_a_page_without_figures_needs_no_script(tmp_path):
    """A page with tables and sentences only contains no script."""
    text = written(tmp_path, Page('t', 'a'))
    assert '<script' not in text and NO_BOKEH not in text


def test_bokeh_is_loaded_by_what_writes_a_page_alone():
    """Bokeh, which takes half a second to load, is loaded only when a page is written."""
    code = ('import sys, ins_sim, ins_sim.cli.main, ins_sim.report.storage\n'
            'import ins_sim.report.page.html\n'
            'assert not [name for name in sys.modules if name.startswith("bokeh")]\n')
    subprocess.run([sys.executable, '-c', code], check=True)


@pytest.mark.parametrize('value, text', [
    (1.23456, '1.235'), (11593.2, '11590'), (1e12, '1e+12'), (-0.0, '0'), (7, '7'),
    (np.int64(123456), '123456'), (None, '–'), (float('nan'), '–'), (True, 'yes'),
    (np.float64(1e-9), '1e-09'), ('word', 'word')])
def test_cells(value, text):
    """Numbers have four digits, and counts are complete."""
    assert cell_text(value) == text
