"""README is short, its links and pictures exist, and lines of prose are short."""

from pathlib import Path
import re

from support.each import each
from support.pages import anchors, page_id, PAGES, README, split
from support.places import ROOT

TEXT = README.read_text(encoding='utf-8')
DOCS = [page for page in PAGES if page != README]
# Greatest length of a line, without tables, links and code.
LONGEST = 100
LINK = re.compile(r'(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)')


def links(text):
    """Yield (is it a picture, target) for each link of a page outside code."""
    prose = re.sub(r'`[^`\n]+`', '', '\n'.join(split(text)[1]))
    for found in LINK.finditer(prose):
        yield bool(found[1]), found[3]


def test_the_readme_has_at_most_600_words():
    """README has at most 600 words, including commands, tables and headings."""
    assert len(TEXT.split()) <= 600


def test_the_readme_begins_with_make_demo_and_make_test():
    """README names make demo and make test, and how long they take."""
    assert '```sh\nmake demo\nmake test\n```' in TEXT
    assert re.search(r'`make demo` \(about [\w ]+ minutes\)', ' '.join(TEXT.split()))
    assert re.search(r'`make test` \(about [\w ]+ minutes[\w ]*\)', ' '.join(TEXT.split()))


@each(PAGES, page_id)
def test_links_lead_somewhere(page):
    """Files, folders, pictures and anchors to which a page links exist."""
    for is_picture, target in links(page.read_text(encoding='utf-8')):
        # Reference pages generated from the code are checked when the site is built.
        if re.match(r'[a-z]+:|(\.\./|\w+/)*generated/', target):
            continue
        name, _, anchor = target.partition('#')
        path = (page.parent / name).resolve() if name else page
        assert path.exists(), target
        assert ROOT in path.parents, target
        assert not is_picture or path.suffix in ('.png', '.svg'), target
        if anchor and path.suffix == '.md':
            assert anchor in anchors(path.read_text(encoding='utf-8')), target


@each(PAGES, page_id)
def test_lines_of_prose_can_be_read_in_an_editor(page):
    """Lines have at most 100 characters, except tables, code, formulas and link targets."""
    _, prose = split(page.read_text(encoding='utf-8'))
    wide = [line for line in prose if len(re.sub(r'\]\([^)]*\)', ']', line)) > LONGEST
            and not line.lstrip().startswith('|')]
    assert not wide, (page_id(page), len(wide), wide[0])


def test_every_page_is_in_the_table_of_contents():
    """Every page is in the table of contents; here without building the site."""
    listed = set()
    for index in [page for page in DOCS if page.name == 'index.md']:
        for block in re.findall(r'```\{toctree\}\n(.*?)```', index.read_text(encoding='utf-8'),
                                re.DOTALL):
            for line in block.splitlines():
                if line and not line.startswith(':'):
                    entry = line.rpartition('<')[2].rstrip('>').strip()
                    folder = (index.parent / entry).resolve().parent
                    listed |= set(folder.glob(f'{Path(entry).name}.md'))
    missing = [page_id(page) for page in DOCS
               if page not in listed and page != ROOT / 'docs' / 'index.md']
    assert not missing
