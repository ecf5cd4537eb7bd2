"""Finished blocks of a study on disk, so that an interrupted one goes on where it was."""

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
    A folder of finished blocks, each an .npz that was written whole.

    Parameters
    ----------
    folder : str or path
        Made where it is not there. Only one process may use it.
    identity : dict
        What decides the numbers, of ``fingerprint``. Blocks of another are never mixed with these.
    replace : bool, optional
        Whether the blocks of another study are deleted, in place of an error.

    Raises
    ------
    ValueError
        Where the folder holds something else, or blocks of another study: the sentence names
        what differs.

    Attributes
    ----------
    found : int
        How many blocks were there already.

    """

    def __init__(self, folder, identity, replace=False):
        self.folder = Path(folder)
        # as it comes back from the file
        identity = json.loads(json.dumps(identity))
        before = self._before()
        if before is not None and before != identity:
            if not replace:
                raise ValueError(f'{folder} holds blocks of another study '
                                 f'({_changed(before, identity)}); expected the same settings, '
                                 'or another folder')
            self.remove()
            before = None
        if before is None:
            self.folder.mkdir(parents=True, exist_ok=True)
            _write(self.folder / IDENTITY, lambda stream: stream.write(
                (json.dumps(identity, indent=1) + '\n').encode('utf-8')))
        self._there = {int(path.stem.removeprefix('block_'))
                       for path in self.folder.glob('block_*.npz')
                       if path.stem.removeprefix('block_').isdecimal()}
        self.found = len(self._there)

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
        """Keep the arrays by name of a block."""
        _write(self._path(number), lambda stream: np.savez_compressed(stream, **arrays))
        self._there.add(number)

    def remove(self):
        """Delete the blocks, and the folder where it holds nothing else."""
        for path in (*self.folder.glob('block_*.npz*'), *self.folder.glob(f'{IDENTITY}*')):
            path.unlink(missing_ok=True)
        with suppress(OSError):
            self.folder.rmdir()

    def _path(self, number):
        return self.folder / f'block_{number:06d}.npz'

    def _before(self):
        """Return the identity of what is in the folder, or None where nothing is."""
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
        raise ValueError(f'{self.folder} is in the way: it holds no blocks of a study; expected '
                         'it to be moved')


def _changed(before, now):
    """Return what differs between two identities, in words."""
    keys = [key for key in {**before, **now} if before.get(key) != now.get(key)]
    said = [f'{key} is {shown(before.get(key))} there and {shown(now.get(key))} here'
            for key in keys[:MOST_NAMED]]
    if len(keys) > MOST_NAMED:
        said.append(f'and {len(keys) - MOST_NAMED} more')
    return ', '.join(said)


def _write(path, write):
    """Write a file whole or not at all."""
    part = path.with_name(f'{path.name}.part')
    with open(part, 'wb') as stream:
        write(stream)
    os.replace(part, path)
