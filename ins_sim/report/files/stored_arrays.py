"""Read arrays from a run.npz that is not trusted: allocate no more than the file can contain."""

import math
from zipfile import BadZipFile, ZipFile
import zlib

import numpy as np
from numpy.lib import format as npy_format

from ins_sim.regular_file import check_regular
from ins_sim.settings.shown import shown

# The arrays may unpack to _FREE bytes or, if that is more, to _RATIO times their packed size; a
# larger file is refused as a zip bomb. Those of a real run are far below this ratio.
_FREE, _RATIO = 1 << 26, 100


def read_arrays(path, shapes, optional=()):
    """
    Return {name: array} of a file of arrays.

    Parameters
    ----------
    path : path of the .npz file
    shapes : {name: (kinds of dtype, shape)}; None in a shape stands for a length that is not
        prescribed but must be the same in all arrays
    optional : names that may be missing

    Raises
    ------
    ValueError : the file is not an .npz file, or an array is missing or has another type or
        shape; the message is one sentence
    """
    check_regular(path, 'the arrays of a run')
    arrays, length = {}, None
    try:
        with ZipFile(path) as archive:
            _check_size(archive, shapes)
            for name, (kinds, shape) in shapes.items():
                if name in optional and f'{name}.npy' not in archive.namelist():
                    continue
                array = arrays[name] = _member(archive, f'{name}.npy')
                wanted = tuple(length if n is None and length is not None else n for n in shape)
                if array.dtype.kind not in kinds or len(array.shape) != len(shape) or any(
                        n not in (None, m) for n, m in zip(wanted, array.shape)):
                    raise ValueError(f'{name} has the type {array.dtype} and the shape '
                                     f'{shown(array.shape)}')
                length = len(array)
    except (BadZipFile, EOFError, KeyError, OSError, NotImplementedError, RuntimeError,
            zlib.error) as error:
        raise ValueError(' '.join(str(error).split())) from None
    return arrays


def _check_size(archive, names):
    """Raise ValueError if the named arrays unpack to more than those of a run can."""
    there = set(archive.namelist())
    members = [archive.getinfo(f'{name}.npy') for name in names if f'{name}.npy' in there]
    packed, size = (sum(getattr(info, key) for info in members)
                    for key in ('compress_size', 'file_size'))
    if size > max(_FREE, _RATIO * packed):
        raise ValueError(f'{members[0].filename} and the other arrays have {packed} bytes, which '
                         f'unpacks to {size}')


def _member(archive, name):
    info = archive.getinfo(name)
    with archive.open(info) as stream:
        version = npy_format.read_magic(stream)
        if version not in ((1, 0), (2, 0)):
            raise ValueError(f'{name} has the format {version}')
        read = (npy_format.read_array_header_1_0 if version == (1, 0)
                else npy_format.read_array_header_2_0)
        shape, fortran, dtype = read(stream)
        size = math.prod(shape) * dtype.itemsize
        if dtype.hasobject or min(shape, default=0) < 0 or size > info.file_size:
            raise ValueError(f'{name} states a shape of {shown(shape)} of {dtype}, which is more '
                             'than the file contains')
        data = stream.read(size)
    if len(data) != size:
        raise ValueError(f'{name} ends too early')
    return np.frombuffer(bytearray(data), dtype).reshape(shape, order='F' if fortran else 'C')
