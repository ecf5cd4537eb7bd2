"""Read README and the pages of docs/: code blocks, commands, prose, links and headings."""

from dataclasses import dataclass
import re

from .places import ROOT

README = ROOT / 'README.md'
# Without pages that are generated from the code.
PAGES = sorted([README, *(page for page in (ROOT / 'docs').rglob('*.md')
                          if 'generated' not in page.parts)])
SHELL = ('sh', 'bash', 'console')
# A comment on the line above a fence states why a block is not executed.
NOT_RUN = re.compile(r'<!-- not run: (\S.*\S) -->')


@dataclass(frozen=True)
class Block:
    """A code block: its language, its text, and the reason why it is not executed, or ''."""

    language: str
    text: str
    reason: str = ''


def page_id(page):
    """Return the path of a page from the root, used as test id."""
    return str(page.relative_to(ROOT))


def split(text):
    """
    Return the blocks of a page and its other lines, without display formulas.

    A fence without language is a shell block, and so is an indented line that begins with a
    command.
    """
    blocks, prose, fence, before = [], [], None, ''
    for line in re.sub(r'^ *\$\$.*?\$\$', '', text, flags=re.DOTALL | re.MULTILINE).splitlines():
        opened = re.match(r' *(```+|:::+)(.*)', line)
        if fence is None and opened:
            fence, language, inside = opened[1], opened[2].strip(), []
            reason = NOT_RUN.fullmatch(before.strip())
        elif fence is not None and line.strip() == fence:
            blocks.append(Block(language or 'sh', _dedent(inside), reason[1] if reason else ''))
            fence = None
        elif fence is not None:
            inside.append(line)
        elif line.startswith('    ') and line.strip():
            blocks.append(Block('indented', line[4:]))
        else:
            prose.append(line)
        before = line
    assert fence is None, f'{fence} is not closed'
    return _joined(blocks), prose


def _dedent(lines):
    indent = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    return '\n'.join(line[indent:] for line in lines) + '\n'


def _joined(blocks):
    """Join consecutive indented lines, for commands over several lines."""
    joined = []
    for block in blocks:
        if joined and block.language == joined[-1].language == 'indented':
            joined[-1] = Block('indented', f'{joined[-1].text}\n{block.text}')
        else:
            joined.append(block)
    return joined


def commands(block):
    """Return the commands of a shell or indented block, one per line, without comments."""
    if block.language not in (*SHELL, 'indented'):
        return []
    lines = re.sub(r'\\\n\s*', ' ', block.text).splitlines()
    return [re.sub(r'\s+# .*', '', line.removeprefix('$ ').strip()) for line in lines
            if line.strip() and not line.lstrip().startswith('#')]


def anchors(text):
    """Return the anchors of the headings of a page, as GitHub and MyST generate them."""
    headings = re.findall(r'^#{1,3} (.+?)\s*$', re.sub(r'```.*?```', '', text, flags=re.DOTALL),
                          re.MULTILINE)
    return {re.sub(r'[^\w\- ]', '', heading.replace('`', '').lower()).replace(' ', '-')
            for heading in headings}
