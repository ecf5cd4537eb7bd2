"""What a bag is named like; light, for those that may need no reader at all."""

from pathlib import Path

SUFFIXES = {'.mcap': 'mcap', '.db3': 'sqlite3'}


def is_bag(path):
    """Return whether a path is a folder, or named as a file of a bag."""
    return Path(path).suffix in SUFFIXES or (bool(str(path)) and Path(path).is_dir())
