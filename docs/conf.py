"""
Configuration of Sphinx for this folder: ``make docs`` here, rosdoc2 on docs.ros.org.

rosdoc2 copies this folder elsewhere and puts the package on ``sys.path`` itself.
"""

from importlib import import_module
from pathlib import Path
import re
import sys

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

project = 'ins_sim'
author = 'The ins_sim developers'
copyright = author
release = version = import_module('ins_sim').__version__

extensions = ['myst_parser', 'sphinx.ext.autodoc', 'sphinx.ext.mathjax', 'sphinx.ext.napoleon']
source_suffix = {'.md': 'markdown', '.rst': 'restructuredtext'}
# The files behind the first two are put here by rosdoc2.
exclude_patterns = ['figures', '_generate', 'index.rst', '__*.rst', 'README.md',
                    'CONTRIBUTING.md', 'CHANGELOG.rst']
html_theme = 'sphinx_rtd_theme'
html_title = f'ins_sim {release}'
html_static_path = ['_static']
html_css_files = ['tables.css']
# Options such as --params-file keep their two hyphens.
smartquotes = False

myst_enable_extensions = ['colon_fence', 'deflist', 'dollarmath']
# Headings of the first three levels are anchors, so that pages can link to them.
myst_heading_anchors = 3
nitpicky = False
autodoc_typehints = 'none'
napoleon_google_docstring = False


def setup(app):
    """Write the reference pages before Sphinx looks for its sources."""
    import_module('_generate').write_pages(Path(app.srcdir) / 'reference' / 'generated')
    app.connect('doctree-read', set_dashes)
    app.connect('autodoc-process-docstring', protect, priority=400)
    app.connect('autodoc-process-docstring', restore, priority=600)


def set_dashes(app, doctree):
    """Set a dash between the name of an argument and its description, as smartquotes would."""
    for text in list(doctree.findall(lambda node: isinstance(node, str) and node == ' -- ')):
        text.parent.replace(text, type(text)(' – '))


# A page that a docstring cites.
PAGE = re.compile(r'(?<!`)\bdocs/([\w/]+)\.md')
# Stands for a colon while napoleon, with the priority 500, reads a docstring.
COLON = '\ue000'


def protect(app, what, name, thing, options, lines):
    """
    Prepare a docstring: pages that it cites become links.

    Bars are kept, because |x| is not a substitution, and so are colons, because napoleon takes
    what stands before the first colon of a property for its type.
    """
    lines[:] = [line if '``' in line else PAGE.sub(r':doc:`\g<0> </\1>`',
                                                   line.replace('|', '\\|')) for line in lines]
    if what in ('attribute', 'property'):
        lines[:] = [line.replace(':', COLON) for line in lines]


def restore(app, what, name, thing, options, lines):
    """Put the colons back."""
    lines[:] = [line.replace(COLON, ':') for line in lines]
