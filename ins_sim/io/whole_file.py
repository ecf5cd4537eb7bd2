"""Files that a command writes: whole or not at all, and nobody else's."""

import os
from pathlib import Path


def check_file(path, force):
    """Raise ValueError, one sentence, where a file is there and force does not replace it."""
    path = Path(path)
    if path.exists() and not force:
        raise ValueError(f'{path} exists; expected a new file (or --force)')
    if path.exists() and not path.is_file():
        raise ValueError(f'{path} is no file; --force replaces only a file')


def write_whole(path, data):
    """Write bytes; what is there is replaced.  Raises OSError."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    # a name of this process: of two that write at once the last one's file stands, whole
    part = path.with_name(f'.{path.name}.{os.getpid()}.part')
    try:
        part.write_bytes(data)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
