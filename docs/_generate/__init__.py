"""Write the reference pages of the site from the code; ``docs/conf.py`` calls `write_pages`."""

from . import (command_line, exit_codes, files, interfaces, launch_files, parameters,
               python_api)

# One module for each kind of page.
KINDS = (interfaces, parameters, launch_files, command_line, python_api, files, exit_codes)


def pages():
    """Return {path of a page below the folder: its Markdown}."""
    found = {}
    for kind in KINDS:
        found.update(kind.pages())
    return found


def write_pages(folder):
    """Write all pages into a folder; leave unchanged files alone and delete those left over."""
    wanted = {folder / name: text for name, text in pages().items()}
    for path, text in wanted.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        # Sphinx reads a page again if its time has changed.
        if not path.exists() or path.read_text('utf-8') != text:
            path.write_text(text, 'utf-8')
    for path in folder.rglob('*.md'):
        if path not in wanted:
            path.unlink()
