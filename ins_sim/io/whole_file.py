"""Write files completely or not at all."""

import os
from pathlib import Path


def check_file(path, force):
    """Raise ValueError if the file exists and force does not allow to replace it."""
    path = Path(path)
    if path.exists() and not force:
        raise ValueError(f'{path} exists; expected a new file (or --force)')
    if path.exists() and not path.is_file():
        raise ValueError(f'{path} is no file; --force replaces only a file')


def write_whole(path, data):
    """Write bytes and replace an existing file.  Raises OSError."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    # The name contains the process id, so that of two writers the last one wins with a whole file.
    part = path.with_name(f'.{path.name}.{os.getpid()}.part')
    try:
        part.write_bytes(data)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
