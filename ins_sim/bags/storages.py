"""What a bag is named like; light, for those that may need no reader at all."""

from pathlib import Path

SUFFIXES = {'.mcap': 'mcap', '.db3': 'sqlite3'}
# A bag of ROS 1, which is named as such and not read.
ROS_1 = '.bag'


def is_bag(path):
    """Return whether a path is a folder, or named as a file of a bag."""
    return Path(path).suffix in (*SUFFIXES, ROS_1) or (bool(str(path)) and Path(path).is_dir())
