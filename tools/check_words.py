"""
Check the words of docs, README and docstrings with codespell and proselint.

Usage: python tools/check_words.py

Code, formulas and tables are left out. Terms and checks that do not apply are listed below. The
exit code is 1 if anything is found.
"""

import ast
from pathlib import Path
import re
import subprocess
import sys
import tempfile

ROOT = Path(__file__).resolve().parents[1]
# Abbreviations and technical names that codespell reports as misspelt.
TERMS = ('ned', 'nees', 'empy', 'shepperd', 'fro')
# The text is plain ASCII, and comparisons of exact words can be meant.
UNUSED = ('typography', 'uncomparables', 'misc.phrasal_adjectives')
# What proselint misinterprets: a name, "the first of all runs", and decimation.
MEANT = ("'OMG'", "'first of all'", "'decimate'")
# Only repetitions of plain words count: constants, axes and numbers may be repeated.
REPEATED = re.compile(r"'([a-z]{2,})\s\1'")


def prose_of_page(text):
    """Return Markdown without code, formulas, tables, links and headings."""
    text = re.sub(r'(```|:::).*?\1', '', text, flags=re.DOTALL)
    text = re.sub(r'\$\$.*?\$\$|\$[^$\n]+\$|`[^`]*`|\]\([^)]*\)', ' _ ', text, flags=re.DOTALL)
    return re.sub(r'^(\||#|    ).*$', '', text, flags=re.MULTILINE)


def prose_of_module(text):
    """Return the docstrings of a module, without quoted names and indented formulas."""
    nodes = [node for node in ast.walk(ast.parse(text))
             if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef))]
    found = '\n\n'.join(ast.get_docstring(node) or '' for node in nodes)
    found = re.sub(r'``[^`]*``', ' _ ', found)
    # The names of parameters that precede descriptions are not part of the sentence.
    found = re.sub(r'^[\w, ]+ : ', 'The ', found, flags=re.MULTILINE)
    return re.sub(r'^(    |-+$).*$', '', found, flags=re.MULTILINE)


def collect(folder):
    """Write the prose of every page and module into a folder, under their names."""
    pages = [*ROOT.glob('*.md'), ROOT / 'CHANGELOG.rst', *(ROOT / 'docs').rglob('*.md')]
    for path in [*pages, *(ROOT / 'ins_sim').rglob('*.py')]:
        text = path.read_text(encoding='utf-8')
        prose = prose_of_module(text) if path.suffix == '.py' else prose_of_page(text)
        target = folder / f'{path.relative_to(ROOT)}.md'
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(prose, encoding='utf-8')


def run(command, folder):
    """Run a checker in a folder; return its findings, one text each."""
    found = subprocess.run([sys.executable, '-m', *command], cwd=folder, capture_output=True,
                           text=True, check=False)
    if found.returncode not in (0, 1, 65):
        raise SystemExit(f'{command[0]}: {found.stderr.strip() or found.stdout.strip()}')
    # A finding may contain a line break: it extends to the next location, "file:line".
    return [' '.join(text.split()) for text in re.split(r'\n(?=\S+:\d+:)', found.stdout)
            if text.strip()]


def findings(folder):
    """Return what codespell and proselint find in a folder."""
    lines = run(['codespell_lib', '-L', ','.join(TERMS), '.'], folder)
    for line in run(['proselint', '-o', 'compact', 'check', '.'], folder):
        check = line.split(': ')[1] if ': ' in line else ''
        if check == 'lexical_illusions' and not REPEATED.search(line):
            continue
        if not check.startswith(UNUSED) and not any(phrase in line for phrase in MEANT):
            lines.append(line)
    return lines


def main():
    """Print the findings; return 1 if there are any."""
    with tempfile.TemporaryDirectory() as name:
        collect(Path(name))
        found = findings(Path(name))
    for line in found:
        print(line)
    print(f'{len(found)} findings')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
