"""Write files completely or not at all."""

import os
from pathlib import Path


def check_file(path, force):
    """Raise ValueError if the file exists and must not be replaced."""
    path = Path(path)
    if path.exists() and not force:
        raise ValueError(f'{path} exists; expected a new file (or --force)')
    if path.exists() and not path.is_file():
        raise ValueError(f'{path} is not a file; --force replaces only files')


def write_whole(path, data):
    """Write bytes and replace an existing file.  Raises OSError."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    # The name contains the process id, so that two writers do not mix their data: the last one
    # wins.
    part = path.with_name(f'.{path.name}.{os.getpid()}.part')
    try:
        part.write_bytes(data)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
