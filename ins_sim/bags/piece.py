"""Messages of a bag in memory: data in one buffer, everything else in columns."""

from dataclasses import dataclass

import numpy as np

from ins_sim.visible_text import visible


@dataclass(frozen=True)
class Channel:
    """
    A topic as declared in a file.

    Attributes
    ----------
    id : number in the file
    name, type_name : names as in ROS
    encoding : encoding of the messages ('cdr')
    definition : definition of the type in the language definition_encoding ('ros2msg')
    type_hash : RIHS01 hash, if the file has it
    qos : offered profiles as YAML, if the file has them
    """

    id: int
    name: str
    type_name: str
    encoding: str = 'cdr'
    definition: str = ''
    definition_encoding: str = 'ros2msg'
    type_hash: str = ''
    qos: str = ''

    @classmethod
    def as_read(cls, number, name, type_name, encoding, *more):
        """Return the Channel of a file, with invisible characters in its names escaped."""
        return cls(number, visible(name), visible(type_name), visible(encoding), *more)


@dataclass(frozen=True)
class BagPiece:
    """
    Some messages in the order of the file.

    data is an uint8 array; channel, log_ns, starts and sizes, (n,) int64, give the channel, the
    log time and the position in data of each message.
    """

    data: np.ndarray
    channel: np.ndarray
    log_ns: np.ndarray
    starts: np.ndarray
    sizes: np.ndarray

    def __len__(self):
        return len(self.log_ns)

    def __getitem__(self, rows):
        return BagPiece(self.data, self.channel[rows], self.log_ns[rows], self.starts[rows],
                        self.sizes[rows])


def in_log_order(pieces):
    """
    Yield (channel, log_ns, bytes) of pieces in the order of the log times.

    pieces yields (time, position, Piece), where neither this Piece nor a later one has a message
    before the time. Messages with equal log times keep the order of the positions.
    """
    waiting = []
    for not_before_ns, place, piece in pieces:
        if any(p.log_ns.min() < not_before_ns for _, p in waiting):
            yield from _merged([(k, p[p.log_ns < not_before_ns]) for k, p in waiting])
            waiting = [(k, p[p.log_ns >= not_before_ns]) for k, p in waiting]
            waiting = [(k, p) for k, p in waiting if len(p)]
        if len(piece):
            waiting.append((place, piece))
    yield from _merged(waiting)


def _merged(pieces):
    pieces = [p for _, p in sorted(pieces, key=lambda pair: pair[0]) if len(p)]
    if not pieces:
        return
    source = np.repeat(np.arange(len(pieces)), [len(p) for p in pieces])
    channel, log_ns, starts, sizes = (
        np.concatenate([getattr(p, name) for p in pieces])
        for name in ('channel', 'log_ns', 'starts', 'sizes'))
    order = np.argsort(log_ns, kind='stable')
    views = [memoryview(p.data) for p in pieces]
    for k, number, t_ns, start, stop in zip(
            source[order].tolist(), channel[order].tolist(), log_ns[order].tolist(),
            starts[order].tolist(), (starts + sizes)[order].tolist()):
        yield number, t_ns, bytes(views[k][start:stop])


def split_by_channel(piece):
    """Yield (channel id, Piece with its messages) for each channel of a Piece."""
    for number in np.unique(piece.channel).tolist():
        yield number, piece[piece.channel == number]


def join_pieces(pieces):
    """Join pieces with the same data to one Piece."""
    if len(pieces) == 1:
        return pieces[0]
    return BagPiece(pieces[0].data, *(np.concatenate([getattr(p, name) for p in pieces])
                                      for name in ('channel', 'log_ns', 'starts', 'sizes')))
