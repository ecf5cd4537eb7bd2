"""Write .npz files block by block, and compress the arrays that shrink enough."""

from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile
import zlib

from numpy.lib import format as npy_format

from ins_sim.core.timeseries.histories import BLOCK

# The fastest level of deflate; level 6 takes twice the time and saves 1 % more.
LEVEL = 1
# An array that would keep more than this part of its size is not compressed. Its low bits are
# practically random, and deflate is slowest for such data.
WORTH = 0.75


def write_arrays(path, arrays):
    """Write {name: array, or SpooledColumn} into an .npz file."""
    with ZipFile(path, 'w', compresslevel=LEVEL) as archive:
        for name, array in arrays.items():
            archive.compression = _method(array)
            # The size is known only afterwards and may exceed the limit of the short zip header.
            with archive.open(f'{name}.npy', 'w', force_zip64=True) as member:
                npy_format.write_array_header_1_0(member, {
                    'descr': npy_format.dtype_to_descr(array.dtype), 'fortran_order': False,
                    'shape': array.shape})
                for first in range(0, len(array), BLOCK):
                    member.write(array[first:first + BLOCK].tobytes())


def _method(array):
    """Return the zip method for an array, decided by compressing the block in its middle."""
    middle = max(0, (len(array) - BLOCK) // 2)
    sample = array[middle:middle + BLOCK].tobytes()
    return ZIP_DEFLATED if len(zlib.compress(sample, LEVEL)) < WORTH * len(sample) else ZIP_STORED
