"""Files that have an end: devices and pipes are refused before anything is read from them."""

import os
import stat

# What a path may name besides a file or a folder.
_ENDLESS = ((stat.S_ISCHR, 'a device'), (stat.S_ISBLK, 'a device'), (stat.S_ISFIFO, 'a pipe'),
            (stat.S_ISSOCK, 'a socket'))


def check_regular(path, expected):
    """
    Raise ValueError where a path names a device, a pipe or a socket, and OSError where nothing.

    To read these takes forever, or all memory. expected: what the path should name, such as
    'a CSV file'.
    """
    mode = os.stat(path).st_mode
    for test, kind in _ENDLESS:
        if test(mode):
            raise ValueError(f'{path} is {kind}; expected {expected}')
