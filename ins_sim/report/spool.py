"""
Store histories that do not fit into memory in temporary files.

The files have no name in the folder and are deleted when the process ends, however it ends.
"""

import tempfile

import numpy as np

from ins_sim.core.timeseries.histories import BLOCK


class Spool:
    """
    Context manager that provides stores for ``core.simulation.inertial.simulate`` and ``predict``.

    ``folder`` is the directory of the temporary files, on a disk with room for the run. The
    histories of these stores can be sliced into blocks until the context ends.
    """

    def __init__(self, folder):
        self._folder, self._files = folder, []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for file in self._files:
            file.close()

    def store(self):
        """Return a store for the blocks of one history."""
        return _SpooledHistory(self._new_column)

    def _new_column(self, block):
        file = tempfile.TemporaryFile(dir=self._folder)
        self._files.append(file)
        return SpooledColumn(file, block.dtype, block.shape[1:])


class _SpooledHistory:
    """Collects the blocks of one history, see ``core.timeseries.collecting.Collected``."""

    def __init__(self, new_column):
        self._new_column, self._kind, self._columns = new_column, None, {}

    def append(self, block):
        """Append the next block, a History."""
        arrays = block.arrays()
        if self._kind is None:
            self._kind = type(block)
            self._columns = {name: self._new_column(values) for name, values in arrays.items()}
        for name, values in arrays.items():
            self._columns[name].append(values)

    def history(self):
        """Return the History of all blocks, its fields being SpooledColumns, or None."""
        return None if self._kind is None else self._kind(**self._columns)


class SpooledColumn:
    """
    An array in a file that grows by blocks of rows; slices and rows of it are arrays.

    Parameters
    ----------
    file : binary file, open for reading and writing
    dtype : numpy.dtype
    row : shape of a row

    """

    def __init__(self, file, dtype, row):
        self._file, self.dtype, self._row, self._count = file, dtype, row, 0
        self._size = dtype.itemsize * int(np.prod(row, dtype=int))

    def __len__(self):
        return self._count

    @property
    def shape(self):
        """Return the shape of the whole array."""
        return self._count, *self._row

    def append(self, rows):
        """Write further rows."""
        self._file.seek(0, 2)
        self._file.write(np.ascontiguousarray(rows).data)
        self._count += len(rows)

    def __getitem__(self, index):
        if not isinstance(index, slice):
            row = range(self._count)[index]
            return self._read(row, row + 1)[0]
        start, stop, step = index.indices(self._count)
        if step < 1:
            raise ValueError(f'the step of the slice is {step}; expected at least 1')
        if step == 1:
            return self._read(start, max(start, stop))
        # Select block by block, because the rows in between may not fit into memory.
        length = step * max(1, BLOCK // step)
        parts = [self._read(first, min(first + length, stop))[::step].copy()
                 for first in range(start, stop, length)]
        return np.concatenate(parts) if parts else self._read(0, 0)

    def _read(self, start, stop):
        rows = np.empty((stop - start, *self._row), self.dtype)
        self._file.seek(start * self._size)
        if self._file.readinto(rows.data) != rows.nbytes:
            raise OSError('a temporary file of the run was truncated')
        return rows
