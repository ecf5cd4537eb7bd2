"""Files that the documents name exist."""

import re

from support.each import each
from support.pages import page_id, PAGES
from support.places import ROOT

# A path of the repository in backticks; with a star or capitals it is a pattern.
PATH = re.compile(r'`((?:config|docs|test|launch|tools|benchmarks|ins_sim)/[\w./-]+)`')
LINK = re.compile(r'\]\(([\w./-]+\.md)[)#]')
# Written by docs/_generate when the site is built, and checked then.
GENERATED = ROOT / 'docs' / 'reference' / 'generated'


@each(PAGES, page_id)
def test_named_files_exist(page):
    """Paths in backticks, relative to the repository, and links, relative to the page, exist."""
    text = page.read_text(encoding='utf-8')
    names = [ROOT / name for name in PATH.findall(text)]
    names += [page.parent / name for name in LINK.findall(text)]
    # Modules may be named without their suffix.
    assert not [name for name in names if not name.exists() and name.parent != GENERATED
                and not name.with_suffix('.py').exists()]
