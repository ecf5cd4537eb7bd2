"""Compression of MCAP chunks, with no more memory on reading than a chunk says it needs."""

import lz4.frame

try:
    from compression import zstd
except ImportError:  # Python before 3.14
    from backports import zstd

NAMES = ('none', 'lz4', 'zstd')
# what the formats can gain at most
_LZ4_RATIO = 256
LARGEST = 1 << 30


def compress(data, name):
    """Return bytes compressed by 'lz4' or 'zstd' at the fastest level; '' leaves them."""
    if name == 'lz4':
        return lz4.frame.compress(data, store_size=True)
    if name == 'zstd':
        return zstd.compress(data, level=1)
    return data


def decompress(data, name, size):
    """
    Return size bytes.

    Raises ValueError if the compression is unknown, the data corrupt or of another size.
    """
    if size > LARGEST:
        raise ValueError(f'it says it has {size} bytes; expected at most {LARGEST}')
    if name == '':
        raw = data
    elif name == 'lz4':
        if size > _LZ4_RATIO * len(data):
            raise ValueError(f'{len(data)} bytes of lz4 cannot have {size} bytes')
        raw = _whole(lz4.frame.LZ4FrameDecompressor(), data, size)
    elif name == 'zstd':
        raw = _whole(zstd.ZstdDecompressor(), data, size)
    else:
        raise ValueError(f'its compression is {name!r}; expected lz4, zstd or none')
    if len(raw) != size:
        raise ValueError(f'it has {len(raw)} bytes; expected {size}')
    return raw


def _whole(decompressor, data, size):
    try:
        # one byte more than expected shows that there is more
        raw = decompressor.decompress(data, max_length=size + 1)
    except (RuntimeError, zstd.ZstdError, EOFError) as error:
        raise ValueError(f'its compressed data are corrupt ({error})') from None
    if not decompressor.eof:
        raise ValueError(f'its compressed data are corrupt; expected the end after {size} bytes')
    return raw
