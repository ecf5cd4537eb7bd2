"""
The site of docs/, built once for all tests of this file (10 to 15 s of CPU time).

Links to other sites are not opened; they are listed in build/external_links.txt.
"""

from html.parser import HTMLParser
import json
import os
import re
import shutil
import subprocess
import sys
from urllib.parse import unquote, urlsplit

import ins_sim
from ins_sim.cli.known_settings import READERS
from ins_sim.cli.main import VERBS
from ins_sim.launching.arguments import LAUNCH_FILES
from ins_sim.messages.interfaces import INTERFACES
from ins_sim.messages.topic_contents import CONTENTS
from ins_sim.resources import config_names
from ins_sim.settings.catalogue import flatten, value_text
import pytest
from support.places import ROOT

for _needed in ('sphinx', 'myst_parser', 'sphinx_rtd_theme'):
    pytest.importorskip(_needed)
# With pytest-xdist one worker builds the site and runs all tests on it.
pytestmark = pytest.mark.xdist_group('site')

GENERATED = 'reference/generated'
FRAGMENT = re.compile(r'\sid="([^"]+)"')
LINK = re.compile(r'<(?:a|link|img|script)\s[^>]*?(?:href|src)="([^"]+)"')
# Searches that must find a page.
SEARCHES = ('bias instability', 'lever arm', 'TF', 'Monte Carlo')


@pytest.fixture(scope='session')
def built(tmp_path_factory):
    """Return the folder of the built site, and the finished process of its build."""
    folder = tmp_path_factory.mktemp('site')
    # A copy, as made by rosdoc2: the build writes reference pages into its source.
    shutil.copytree(ROOT / 'docs', folder / 'docs',
                    ignore=shutil.ignore_patterns('generated', '__pycache__'))
    # The site is built without ROS, as on a machine without it.
    (folder / 'without').mkdir()
    (folder / 'without' / 'rclpy.py').write_text("raise RuntimeError('rclpy was imported')\n")
    path = os.pathsep.join([str(folder / 'without'), str(ROOT)])
    ended = subprocess.run(
        [sys.executable, '-m', 'sphinx', '-W', '--keep-going', '-q', '-b', 'html',
         str(folder / 'docs'), str(folder / 'html')], capture_output=True, text=True,
        env={**os.environ, 'PYTHONPATH': path})
    return folder / 'html', ended


@pytest.fixture
def site(built):
    """Return the folder of the built site."""
    return built[0]


class Tables(HTMLParser):
    """The rows of all tables of a page, each a list of the texts of its cells."""

    def __init__(self, text):
        super().__init__()
        self.rows, self._inside = [], False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        """Start a row or a cell."""
        if tag == 'tr':
            self.rows.append([])
        elif tag == 'td':
            self.rows[-1].append('')
            self._inside = True

    def handle_endtag(self, tag):
        """End a cell."""
        if tag == 'td':
            self._inside = False

    def handle_data(self, data):
        """Store the text of a cell."""
        if self._inside:
            self.rows[-1][-1] += data


def read(path):
    """Return the text of a file."""
    return path.read_text(encoding='utf-8')


def heading(page):
    """Return the text of the first heading of a page."""
    return re.sub(r'<[^>]+>|', '', re.search(r'<h1>(.*?)</h1>', read(page), re.DOTALL)[1])


def test_the_site_is_built_without_a_warning(built):
    """Sphinx exits with 0, although warnings are errors, and prints nothing."""
    assert (built[1].returncode, built[1].stderr) == (0, '')


def links(site):
    """Return the broken links inside a site, as 'page: link', and its external links."""
    pages = {path: read(path) for path in site.rglob('*.html')}
    fragments = {path: set(FRAGMENT.findall(text)) for path, text in pages.items()}
    broken, external = set(), set()
    for path, text in pages.items():
        for link in set(LINK.findall(text)):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                external.add(link)
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file() or parts.fragment and target.suffix == '.html' \
                    and unquote(parts.fragment) not in fragments[target]:
                broken.add(f'{path.relative_to(site)}: {link}')
    return sorted(broken), sorted(external)


def test_every_link_inside_the_site_leads_somewhere(site):
    """The file and the fragment of each relative link exist; external links are listed."""
    broken, external = links(site)
    listed = ROOT / 'build' / 'external_links.txt'
    listed.parent.mkdir(exist_ok=True)
    listed.write_text(''.join(f'{link}\n' for link in external), encoding='utf-8')
    assert not broken


def test_a_broken_link_is_found(tmp_path):
    """A missing file and a missing fragment are broken links; external ones are not checked."""
    (tmp_path / 'a.html').write_text('<p id="here"><a class="x" href="b.html#there">')
    (tmp_path / 'b.html').write_text(
        '<a href="a.html#here"><a href="#none"><img alt="" src="c.png"><a href="https://x.y/#z">')
    assert links(tmp_path) == (['a.html: b.html#there', 'b.html: #none', 'b.html: c.png'],
                               ['https://x.y/#z'])


@pytest.mark.parametrize('name', ins_sim.__all__)
def test_every_public_name_has_a_page(name, site):
    """Each name of ins_sim.__all__ has a page that documents it, and is listed on the overview."""
    assert f'id="ins_sim.{name}"' in read(site / GENERATED / 'python_api' / f'{name}.html')
    assert f'python_api/{name}.html"' in read(site / GENERATED / 'python_api.html')


def test_the_module_of_tests_has_a_page(site):
    """ins_sim.testing is documented with its classes."""
    text = read(site / GENERATED / 'python_api' / 'testing.html')
    assert 'id="ins_sim.testing.RunningSimulation"' in text


@pytest.mark.parametrize('reader', READERS)
def test_every_parameter_is_described(reader, site):
    """The page of a node or verb has every parameter with unit, range, default and meaning."""
    rows = {row[0]: row for row in Tables(read(
        site / GENERATED / 'parameters' / f'{reader}.html')).rows if len(row) == 6}
    fields = flatten(READERS[reader])
    assert set(rows) == set(fields)
    for name, f in fields.items():
        _, kind, unit, span, default, meaning = rows[name]
        assert kind and unit == (f.metadata['unit'] or '–')
        numbers = re.fullmatch(r'(\S+) to (\S+)', span)
        if f.metadata['low'] is not None:
            assert [float(n) for n in numbers.groups()] == [
                f.metadata['low'], f.metadata['high']]
        elif f.metadata['choices']:
            assert span.split(', ') == [choice or 'empty' for choice in f.metadata['choices']]
        else:
            assert span in ('true, false', 'any')
        assert default == value_text(f.default)
        assert len(meaning.split()) > 0
        assert ('can be set while the node runs' in meaning) == (
            name in READERS[reader].SETTABLE)


@pytest.mark.parametrize('verb', VERBS)
def test_every_verb_has_a_page(verb, site):
    """The page of a verb has each of its options."""
    import argparse
    from ins_sim.cli.main import parser
    actions = next(action for action in parser()._actions
                   if isinstance(action, argparse._SubParsersAction)).choices[verb]._actions
    page = site / GENERATED / 'command_line' / f'{verb}.html'
    assert heading(page).startswith(f'ins_sim {verb}')
    first = [row[0] for row in Tables(read(page)).rows if row]
    for action in actions:
        for word in action.option_strings:
            assert word in ('-h', '--help') or any(word in cell.split() or f'{word},' in cell
                                                   for cell in first), word
    assert f'command_line/{verb}.html"' in read(site / GENERATED / 'command_line.html')


def test_every_launch_argument_is_described(site):
    """The page of the launch files has each argument of each shipped file."""
    names = [row[0] for row in Tables(read(site / GENERATED / 'launch_files.html')).rows if row]
    assert names == [argument.name for arguments in LAUNCH_FILES.values()
                     for argument in arguments]
    shipped = {path.name for path in (ROOT / 'launch').glob('*.launch.py')}
    headings = set(re.findall('<h2>([^<]+)<', read(site / GENERATED / 'launch_files.html')))
    assert headings == shipped == set(LAUNCH_FILES)


def test_every_node_topic_service_and_file_has_its_entry(site):
    """The pages contain every node, topic, service and file of the tables in the code."""
    nodes, topics, services, files = (read(site / GENERATED / f'{name}.html') for name in (
        'nodes', 'topics', 'services', 'files'))
    served = [row[:2] for row in Tables(services).rows if row]
    for name, interface in INTERFACES.items():
        assert heading(site / GENERATED / 'nodes' / f'{name}.html').startswith(name)
        assert f'nodes/{name}.html"' in nodes
        for service in interface.services:
            assert [name, service.name] in served
    for topic in CONTENTS:
        assert f'<h2>{topic.name}<' in topics
    for name in config_names():
        assert f'files/{name}.html"' in files


@pytest.mark.parametrize('phrase', SEARCHES)
def test_search_finds(phrase, site):
    """The search index of the site has a page with all words of each phrase."""
    from sphinx.search.en import SearchEnglish
    text = read(site / 'searchindex.js')
    index = json.loads(text[text.index('(') + 1:text.rindex(')')])
    stem, found = SearchEnglish({}).stem, None
    for word in phrase.lower().split():
        pages = [index[kind].get(stem(word), []) for kind in ('terms', 'titleterms')]
        here = {n for one in pages for n in ([one] if isinstance(one, int) else one)}
        found = here if found is None else found & here
    assert found
