"""The folder in which compiled code is cached."""

from functools import lru_cache
import logging
import os
from pathlib import Path

LOG = logging.getLogger('ins_sim')


def cache_folder(digest):
    """
    Return the folder for code whose sources have this digest, or None if none is writable.

    It lies in XDG_CACHE_HOME or ~/.cache, so that a read-only installation has one too.
    """
    for root in (os.environ.get('XDG_CACHE_HOME'), os.path.expanduser('~/.cache')):
        if root and os.path.isabs(root):
            folder = Path(root) / 'ins_sim' / digest
            try:
                folder.mkdir(parents=True, exist_ok=True)
            except OSError:
                continue
            if os.access(folder, os.W_OK):
                return folder
    _say_no_folder()
    return None


@lru_cache(maxsize=None)
def _say_no_folder():
    LOG.warning('no cache folder can be written, neither in XDG_CACHE_HOME nor in ~/.cache: every '
                'process compiles its loops again')
