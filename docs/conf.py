"""Configuration of Sphinx for this folder: ``make docs`` here, rosdoc2 on docs.ros.org."""

from pathlib import Path
import re
import sys

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

project = 'ins_sim'
author = 'The ins_sim developers'
copyright = author
release = re.search(r"^__version__ = '(.+)'$",
                    (ROOT / 'ins_sim' / '__init__.py').read_text('utf-8'), re.MULTILINE)[1]
version = release

extensions = ['myst_parser', 'sphinx.ext.autodoc', 'sphinx.ext.autosummary', 'sphinx.ext.mathjax',
              'sphinx.ext.napoleon']
source_suffix = {'.md': 'markdown', '.rst': 'restructuredtext'}
exclude_patterns = ['figures', '_generate']
html_theme = 'sphinx_rtd_theme'
html_title = f'ins_sim {release}'

myst_enable_extensions = ['colon_fence', 'deflist', 'dollarmath']
# Headings of the first three levels are anchors, so that pages can link to them.
myst_heading_anchors = 3
nitpicky = False
autosummary_generate = True
autodoc_typehints = 'none'
napoleon_google_docstring = False
