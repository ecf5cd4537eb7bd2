"""
Render docs/explanation/validation.md from its template and the recorded figures.

Usage: python tools/render_validation.py [--take build/figures.json] [--check]

The template, docs/figures/validation.md.in, is the page with figures as {{name:format}} or
{{name[index]:format}}; the format is that of Python. The figures are in
docs/figures/validation.json. ``--take`` first copies the figures that the page shows from the file
of a run of the tests; ``--check`` writes nothing and fails if the page differs from its rendering.
"""

import argparse
import json
from pathlib import Path
import re
import sys

ROOT = Path(__file__).resolve().parents[1]
TEMPLATE = ROOT / 'docs' / 'figures' / 'validation.md.in'
VALUES = TEMPLATE.with_suffix('').with_suffix('.json')
PAGE = ROOT / 'docs' / 'explanation' / 'validation.md'
FIELD = re.compile(r'\{\{([^{}:\[\]]+)(?:\[(\d+)\])?:([^{}]*)\}\}')


def names(template):
    """Return the names of the figures that a template shows."""
    return {match[1] for match in FIELD.finditer(template)}


def render(template, figures):
    """Return the page; raises KeyError where a figure is missing."""
    def text(match):
        value = figures[match[1]]['value']
        shown = format(value[int(match[2])] if match[2] else value, match[3])
        return re.sub(r'e([+-])0(\d)$', r'e\1\2', shown)

    return FIELD.sub(text, template)


def take(run, figures, wanted):
    """Return the wanted figures, replaced by those that a run has measured, and their names."""
    known = {name: figure for name, figure in figures.items() if name in wanted}
    new = {name: {**figure, 'made_with': run['made_with']}
           for name, figure in run['figures'].items() if name in wanted}
    return dict(sorted({**known, **new}.items())), sorted(new)


def main(words=None):
    """Render or check; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('--take', type=Path, metavar='FILE', help='figures of a run of the tests')
    parser.add_argument('--check', action='store_true', help='write nothing, fail on a difference')
    arguments = parser.parse_args(words)
    template = TEMPLATE.read_text(encoding='utf-8')
    figures = json.loads(VALUES.read_text(encoding='utf-8'))['figures']
    if arguments.take:
        run = json.loads(arguments.take.read_text(encoding='utf-8'))
        figures, taken = take(run, figures, names(template))
        print(f'{len(taken)} of the {len(names(template))} figures of the page are new')
    page = render(template, figures)
    if arguments.check:
        same = PAGE.read_text(encoding='utf-8') == page
        print('docs/explanation/validation.md is its rendering' if same else
              'docs/explanation/validation.md is out of date: run python '
              'tools/render_validation.py')
        return 0 if same else 1
    VALUES.write_text(json.dumps({'figures': figures}, indent=1) + '\n', encoding='utf-8')
    PAGE.write_text(page, encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main())
