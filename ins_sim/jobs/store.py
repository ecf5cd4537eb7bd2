"""Finished blocks of a study on disk, from which an interrupted study resumes."""

from contextlib import suppress
import json
import os
from pathlib import Path
from zipfile import BadZipFile
import zlib

import numpy as np

from ins_sim.settings.shown import shown

IDENTITY = 'study.json'
MOST_NAMED = 3


class BlockStore:
    """
    A folder of finished blocks, each a complete .npz file.

    Parameters
    ----------
    folder : str or path
        Created with the first block. Only one process may use it at a time.
    identity : dict
        What determines the numbers, from ``fingerprint``. Blocks of different identities are never
        mixed.
    replace : bool, optional
        Delete the blocks of another study instead of raising an error.

    Raises
    ------
    ValueError
        If the folder holds something else, or blocks of another study; the message names what
        differs.

    Attributes
    ----------
    found : int
        Number of blocks that the folder already held.

    """

    def __init__(self, folder, identity, replace=False):
        self.folder = Path(folder)
        # JSON returns tuples as lists; compare the identity in that form.
        identity = json.loads(json.dumps(identity))
        self._identity = identity
        before = self._before()
        self._there = {int(path.stem.removeprefix('block_'))
                       for path in self.folder.glob('block_*.npz')
                       if path.stem.removeprefix('block_').isdecimal()}
        if before is not None and before != identity:
            if self._there and not replace:
                raise ValueError(f'{folder} holds blocks of another study '
                                 f'({_changed(before, identity)}); expected the same settings, '
                                 'or another folder')
            self.remove()
            before = None
        self._begun = before is not None
        self.found = len(self._there)

    def __len__(self):
        """Return how many blocks are finished."""
        return len(self._there)

    def __contains__(self, number):
        """Return whether a block is finished."""
        return number in self._there

    def load(self, number):
        """Return {name: array} of a finished block, or None where its file is damaged."""
        try:
            with np.load(self._path(number), allow_pickle=False) as arrays:
                return dict(arrays)
        except (OSError, ValueError, EOFError, KeyError, BadZipFile, zlib.error):
            self._there.discard(number)
            return None

    def save(self, number, arrays):
        """Keep the arrays by name of a block; the first one creates the folder."""
        if not self._begun:
            self.folder.mkdir(parents=True, exist_ok=True)
            _write(self.folder / IDENTITY, lambda stream: stream.write(
                (json.dumps(self._identity, indent=1) + '\n').encode('utf-8')))
            self._begun = True
        _write(self._path(number), lambda stream: np.savez_compressed(stream, **arrays))
        self._there.add(number)

    def remove(self):
        """Delete the blocks, and the folder if it holds nothing else."""
        for path in (*self.folder.glob('block_*.npz*'), *self.folder.glob(f'{IDENTITY}*')):
            path.unlink(missing_ok=True)
        self._there.clear()
        self._begun = False
        with suppress(OSError):
            self.folder.rmdir()

    def _path(self, number):
        return self.folder / f'block_{number:06d}.npz'

    def _before(self):
        """Return the identity of the study in the folder, or None if there is none."""
        if not self.folder.exists():
            return None
        if self.folder.is_dir() and not any(self.folder.iterdir()):
            return None
        try:
            found = json.loads((self.folder / IDENTITY).read_text(encoding='utf-8'))
            if isinstance(found, dict):
                return found
        except (OSError, ValueError):
            pass
        raise ValueError(f'{self.folder} exists but holds no blocks of a study; expected a free '
                         'name: move or delete it')


def _changed(before, now):
    """Return what differs between two identities, in words."""
    keys = [key for key in {**before, **now} if before.get(key) != now.get(key)]
    said = [f'{key} is {shown(before.get(key))} there and {shown(now.get(key))} here'
            for key in keys[:MOST_NAMED]]
    if len(keys) > MOST_NAMED:
        said.append(f'and {len(keys) - MOST_NAMED} more')
    return ', '.join(said)


def _write(path, write):
    """Write a file completely or not at all."""
    part = path.with_name(f'{path.name}.part')
    with open(part, 'wb') as stream:
        write(stream)
    os.replace(part, path)
