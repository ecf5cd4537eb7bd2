"""Refuse devices, pipes and sockets before anything is read from them."""

import os
import stat

# Kinds of paths that are neither a file nor a folder.
_ENDLESS = ((stat.S_ISCHR, 'a device'), (stat.S_ISBLK, 'a device'), (stat.S_ISFIFO, 'a pipe'),
            (stat.S_ISSOCK, 'a socket'))


def check_regular(path, expected):
    """
    Raise ValueError if a path is a device, a pipe or a socket, and OSError if it does not exist.

    Reading from these may never end or use all memory. expected describes the file for the
    message, such as 'a CSV file'.
    """
    mode = os.stat(path).st_mode
    for test, kind in _ENDLESS:
        if test(mode):
            raise ValueError(f'{path} is {kind}; expected {expected}')
