"""Arrays written as ``numpy.savez`` does, block by block, compressed where that gains much."""

from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile
import zlib

from numpy.lib import format as npy_format

from ins_sim.core.timeseries.histories import BLOCK

# The quickest level of deflate: level 6 takes twice the time and gains 1 % more.
LEVEL = 1
# An array that would keep more than this part of its size is not compressed: its low bits are as
# good as random, and deflate takes most time where it gains least.
WORTH = 0.75


def write_arrays(path, arrays):
    """Write {name: array, or SpooledColumn} into an .npz file."""
    with ZipFile(path, 'w', compresslevel=LEVEL) as archive:
        for name, array in arrays.items():
            archive.compression = _method(array)
            # The size is known only afterwards: it may be beyond what a small header can hold.
            with archive.open(f'{name}.npy', 'w', force_zip64=True) as member:
                npy_format.write_array_header_1_0(member, {
                    'descr': npy_format.dtype_to_descr(array.dtype), 'fortran_order': False,
                    'shape': array.shape})
                for first in range(0, len(array), BLOCK):
                    member.write(array[first:first + BLOCK].tobytes())


def _method(array):
    """Return how an array is stored, by how much the block in its middle shrinks."""
    middle = max(0, (len(array) - BLOCK) // 2)
    sample = array[middle:middle + BLOCK].tobytes()
    return ZIP_DEFLATED if len(zlib.compress(sample, LEVEL)) < WORTH * len(sample) else ZIP_STORED
