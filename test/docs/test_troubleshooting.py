"""The messages quoted in docs/how_to/troubleshooting.md are messages of the code."""

import ast
import re

import pytest
from support.places import ROOT

PAGE = (ROOT / 'docs' / 'how_to' / 'troubleshooting.md').read_text(encoding='utf-8')
QUOTES = [' '.join(text.split()) for text in re.findall(r'```text\n(.*?)```', PAGE, re.DOTALL)]
GAP = '…'


def templates():
    """Return every string of the package, with a gap in place of each formatted value."""
    found = set()
    for path in sorted((ROOT / 'ins_sim').rglob('*.py')):
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if isinstance(node, ast.JoinedStr):
                found.add(''.join(part.value if isinstance(part, ast.Constant) else GAP
                                  for part in node.values))
            elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                found.add(node.value)
    return found


TEMPLATES = templates()


def test_the_page_quotes_messages():
    """The page quotes at least fifteen messages."""
    assert len(QUOTES) >= 15


@pytest.mark.parametrize('quote', QUOTES)
def test_quoted_messages_are_those_of_the_code(quote):
    """For each quotation one string of the code has all its fixed parts in the same order."""
    parts = [part.strip() for part in quote.split(GAP)]
    wanted = re.compile('.*'.join(re.escape(part) for part in parts), re.DOTALL)
    assert any(wanted.search(template) for template in TEMPLATES), quote
