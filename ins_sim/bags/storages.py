"""Recognise bags by their names, without importing a reader."""

from pathlib import Path

SUFFIXES = {'.mcap': 'mcap', '.db3': 'sqlite3'}
# Bags of ROS 1, which are recognised but not read.
ROS_1 = '.bag'


def is_bag(path):
    """Return whether a path is a folder or has the suffix of a bag file."""
    return Path(path).suffix in (*SUFFIXES, ROS_1) or (bool(str(path)) and Path(path).is_dir())
