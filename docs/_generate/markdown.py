"""The Markdown that the pages are made of."""

import re

SPECIAL = re.compile(r'([\\`*_{}\[\]<>|$#])')
# What is shown as code inside a sentence: options, dotted names, names of files.
CODE = re.compile(r'(?<![\w.`/-])(--[a-z][a-z-]*\w|-[a-z]|~/\w+|[a-z]\w*(?:\.[a-z]\w*)+|\w+_\w+)'
                  r'(?![\w`])')
NO_VALUE = '–'


def text(words):
    """Return a plain sentence as Markdown, with options and dotted names as code."""
    parts = CODE.split(' '.join(str(words).split()))
    return ''.join(code(part) if k % 2 else SPECIAL.sub(r'\\\1', part)
                   for k, part in enumerate(parts))


def code(words):
    """Return words as code; a vertical bar would end the cell of a table."""
    return f'`{words}`'.replace('|', '\\|')


def table(head, rows, kind=''):
    """
    Return the lines of a table; head and cells are Markdown.

    A table of more than two columns folds on a narrow screen, by its class in the style sheet;
    kind: a further class, which gives the columns labels there.
    """
    lines = [f'| {" | ".join(head)} |', f'|{"---|" * len(head)}',
             *(f'| {" | ".join(row)} |' for row in rows), '']
    if len(head) < 3:
        return lines
    return [f':::{{container}} fold {kind}'.rstrip(), '', *lines, ':::', '']


def page(title, *lines):
    """Return a page from its title and its lines."""
    return '\n'.join([f'# {title}', '', *lines]).rstrip() + '\n'


def contents(names, depth=1):
    """Return the lines of a hidden table of contents: the page itself links to its children."""
    return ['```{toctree}', ':hidden:', f':maxdepth: {depth}', '', *names, '```', '']


def first_sentence(docstring):
    """Return the first sentence of a docstring, without marks of reStructuredText."""
    paragraph = ' '.join(docstring.strip().partition('\n\n')[0].split())
    return paragraph.replace('``', '').replace('`', '')
