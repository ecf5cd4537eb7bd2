"""Fingerprint of what determines the numbers of a study, and digest of its results."""

from hashlib import sha256
from pathlib import Path

import numpy as np

from ins_sim import __version__
from ins_sim.core.numerics.noise import NOISE
from ins_sim.core.timeseries.histories import BLOCK
from ins_sim.settings.catalogue import values_of


def fingerprint(settings, **inputs):
    """
    Return {name: value} of everything that determines the numbers of a study, for ``BlockStore``.

    Values are JSON types. For a recorded motion the content of the file is included.

    Parameters
    ----------
    settings : {name of a node: its settings}
    inputs : everything else, such as the number of runs
    """
    found = {'ins_sim': __version__, 'noise': NOISE, **inputs}
    for node, group in settings.items():
        for key, value in values_of(group).items():
            found[f'{node}: {key}'] = value
            if key == 'motion.recording.path' and value and Path(value).is_file():
                found[f'{node}: {key} (SHA-256)'] = sha256(Path(value).read_bytes()).hexdigest()
    return found


def array_digest(arrays):
    """
    Return the SHA-256 of {name: array} as hexadecimal text.

    It covers names, types, shapes and bytes. Columns on disk, which may exceed the memory, are
    read block by block.
    """
    total = sha256()
    for name, array in sorted(arrays.items()):
        if isinstance(array, np.ndarray):
            array = np.ascontiguousarray(array)
        total.update(f'{name} {array.dtype.str} {array.shape}\n'.encode())
        for first in range(0, len(array), BLOCK):
            total.update(np.ascontiguousarray(array[first:first + BLOCK]).data)
    return total.hexdigest()
