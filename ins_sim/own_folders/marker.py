"""
The marker file of a folder written by ins_sim, which lists the other entries of the folder.

A folder is replaced only if it holds nothing but the marker and the entries that it lists. It is
renamed, and then deleted, when the new folder is complete.
"""

from contextlib import suppress
import json
from pathlib import Path

MARKER = '.ins_sim'
HEAD = '# written by ins_sim; a folder that holds more than these names is never replaced\n'
# Entry of the marker in an unfinished folder, which may hold any names.
ANYTHING = '*'


def foreign(folder, mark=''):
    """
    Return why a folder must not be replaced, or '' if it holds only entries of its marker.

    mark, unless empty, is a name that the marker must list.
    """
    if not folder.is_dir():
        return 'it is not a folder'
    names = sorted(p.name for p in folder.iterdir())
    if not names:
        return ''
    own = own_names(folder)
    if own is None:
        return f'it has no marker {MARKER} of ins_sim'
    if mark and mark not in own:
        return f'it holds no {mark}'
    for name in names:
        entry = folder / name
        if name == MARKER:
            continue
        if name not in own:
            return f'it holds {name}, which ins_sim did not write'
        if entry.is_dir() and not entry.is_symlink():
            inner = foreign(entry)
            if inner:
                return f'{name} in it: {inner}'
    return ''


def own_names(folder):
    """Return the names in the marker of a folder, or None without a valid marker."""
    try:
        head, *lines = (folder / MARKER).read_text(encoding='ascii').splitlines(keepends=True)
        names = {json.loads(line) for line in lines} if head == HEAD else None
        return names if names is None or all(Path(name).name == name for name in names) else None
    except (OSError, ValueError, TypeError):
        return None


def remove(folder):
    """Delete the entries that the marker lists, and the folder itself if nothing else is in it."""
    for name in own_names(folder) or ():
        entry = folder / name
        if entry.is_dir() and not entry.is_symlink():
            remove(entry)
        else:
            with suppress(OSError):
                entry.unlink()
    with suppress(OSError):
        if [p.name for p in folder.iterdir()] == [MARKER]:
            (folder / MARKER).unlink()
        folder.rmdir()


def write_marker(folder, mode, head, names):
    """Write (mode 'w') or append (mode 'a') head and names to the marker of a folder."""
    with open(folder / MARKER, mode, encoding='ascii') as marker:
        marker.write(head + ''.join(json.dumps(name) + '\n' for name in names))
