"""Compress MCAP chunks, and decompress them with a limit on the memory."""

from functools import lru_cache
from importlib import import_module

NAMES = ('none', 'lz4', 'zstd')
# One of the modules suffices.  compression.zstd is in the standard library from Python 3.14;
# zstandard is the library that Debian and Ubuntu package.
MODULES = {'lz4': ('lz4.frame',), 'zstd': ('compression.zstd', 'backports.zstd', 'zstandard')}
APT_PACKAGES = {'lz4': 'python3-lz4', 'zstd': 'python3-zstandard'}
# Largest compression ratio that the format allows.
_LZ4_RATIO = 256
# A chunk of a bag has about 1 MB, and messages compress to a tenth; a ratio above a hundred is an
# attempt to fill the memory.
LARGEST = 1 << 30
_FREE, _RATIO = 1 << 26, 100


@lru_cache(maxsize=None)
def compression_library(name):
    """Return the module for 'lz4' or 'zstd'; raise ValueError if none is installed."""
    for module in MODULES[name]:
        try:
            return import_module(module)
        except ImportError:
            continue
    raise ValueError(f'compression by {name} needs a library that is not installed; install the '
                     f'extra "compression" of ins_sim with pip, or {APT_PACKAGES[name]} with apt')


def compress(data, name):
    """Return data compressed by 'lz4' or 'zstd' at the fastest level; unchanged for ''."""
    if name == 'lz4':
        return compression_library(name).compress(data, store_size=True)
    if name == 'zstd':
        zstd = compression_library(name)
        if zstd.__name__ == 'zstandard':
            return zstd.ZstdCompressor(level=1).compress(data)
        return zstd.compress(data, level=1)
    return data


def decompress(data, name, size):
    """
    Return the decompressed data, which has size bytes.

    Raises ValueError if the compression is unknown, or the data is corrupt or of another size.
    """
    most = min(LARGEST, max(_FREE, _RATIO * len(data))) if name else LARGEST
    if size > most:
        raise ValueError(f'it claims {size} bytes; expected at most {most} for its {len(data)} '
                         'bytes')
    if name == '':
        raw = data
    elif name == 'lz4':
        if size > _LZ4_RATIO * len(data):
            raise ValueError(f'{len(data)} bytes of lz4 cannot unpack to {size} bytes')
        raw = _whole(compression_library(name).LZ4FrameDecompressor(), data, size, RuntimeError)
    elif name == 'zstd':
        zstd = compression_library(name)
        if zstd.__name__ == 'zstandard':
            raw = _read(zstd, data, size)
        else:
            raw = _whole(zstd.ZstdDecompressor(), data, size, zstd.ZstdError)
    else:
        raise ValueError(f'its compression is {name!r}; expected lz4, zstd or none')
    if len(raw) != size:
        raise ValueError(f'it has {len(raw)} bytes; expected {size}')
    return raw


def _whole(decompressor, data, size, failure):
    try:
        # Reading one byte more than expected shows whether there is more.
        raw = decompressor.decompress(data, max_length=size + 1)
    except (failure, EOFError) as error:
        raise ValueError(f'its compressed data are corrupt ({error})') from None
    if not decompressor.eof:
        raise ValueError(f'its compressed data are corrupt; expected the end after {size} bytes')
    return raw


def _read(zstandard, data, size):
    """Return the decompressed data, at most one byte more than size."""
    try:
        # The other decompression functions of zstandard do not limit the memory.
        with zstandard.ZstdDecompressor().stream_reader(data) as reader:
            return reader.read(size + 1)
    except zstandard.ZstdError as error:
        raise ValueError(f'its compressed data are corrupt ({error})') from None
