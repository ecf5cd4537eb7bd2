"""SHA-256 of bag files, and of the messages alone, to compare bags."""

import hashlib

import numpy as np

from .bag_reader import open_bag

READ_BYTES = 1 << 20


def file_digest(path):
    """Return the SHA-256 of a file as hexadecimal digits."""
    digest = hashlib.sha256()
    with open(path, 'rb') as stream:
        while data := stream.read(READ_BYTES):
            digest.update(data)
    return digest.hexdigest()


def payload_digest(path):
    """
    Return the SHA-256 of the messages of a bag, independent of storage and compression.

    For each topic in the order of names it covers name, type, and the log times, sizes and data
    of the messages as written.
    """
    whole = hashlib.sha256()
    with open_bag(path) as bag:
        parts = {name: [hashlib.sha256() for _ in range(3)] for name in bag.topics}
        for name, piece in bag.pieces():
            times, sizes, data = parts[name]
            times.update(piece.log_ns.astype('<i8').tobytes())
            sizes.update(piece.sizes.astype('<i8').tobytes())
            data.update(_joined(piece))
        for name in sorted(parts):
            whole.update(f'{name} {bag.topics[name].type_name}\n'.encode())
            for digest in parts[name]:
                whole.update(digest.digest())
    return whole.hexdigest()


def _joined(piece):
    """Return the concatenated data of the messages of a Piece."""
    size = int(piece.sizes[0])
    if size and (piece.sizes == size).all():
        return np.ndarray(len(piece.data) - size + 1, f'V{size}', piece.data,
                          strides=(1,))[piece.starts].tobytes()
    view = memoryview(piece.data)
    return b''.join(view[a:b] for a, b in zip(piece.starts.tolist(),
                                              (piece.starts + piece.sizes).tolist()))
