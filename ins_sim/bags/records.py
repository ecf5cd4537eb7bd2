"""Messages on their way into a bag: many topics in one run of bytes, by log time."""

from dataclasses import dataclass

import numpy as np

from . import mcap_format as form

HEAD = np.dtype([('opcode', 'u1'), ('length', '<u8'), ('channel', '<u2'), ('sequence', '<u4'),
                 ('log_ns', '<u8'), ('publish_ns', '<u8')])


@dataclass(frozen=True)
class Records:
    """
    Message records of MCAP, one behind another.

    data: their bytes; channel, log_ns, starts (n,) int64: channel, log time and first byte.
    """

    data: memoryview
    channel: np.ndarray
    log_ns: np.ndarray
    starts: np.ndarray


@dataclass(frozen=True)
class Order:
    """
    The order of the messages of several blocks by log time, ties as the blocks stand.

    channel, log_ns, sizes (n,): of each record in order; ranks: for each block the places of its
    messages, which ascend; blocks: their messages in this order.
    """

    channel: np.ndarray
    log_ns: np.ndarray
    sizes: np.ndarray
    ranks: list
    blocks: list


def arrange_records(blocks):
    """
    Return the Order of blocks (channel id, log_ns (n,), messages (n,)).

    messages: of type V, or of bytes as objects where not all are equally long.
    """
    counts = [len(log_ns) for _, log_ns, _ in blocks]
    log_ns = np.concatenate([log_ns for _, log_ns, _ in blocks])
    which = np.repeat(np.arange(len(blocks)), counts)
    order = np.argsort(log_ns, kind='stable')
    which = which[order]
    numbers = np.array([number for number, _, _ in blocks])
    sizes = HEAD.itemsize + np.concatenate([_lengths(messages) for _, _, messages in blocks])
    sorted_blocks, ranks, start = [], [], 0
    for k, (number, times, messages) in enumerate(blocks):
        rank = np.flatnonzero(which == k)
        if (np.diff(times) < 0).any():
            messages = messages[order[rank] - start]
        ranks.append(rank)
        sorted_blocks.append(messages)
        start += counts[k]
    return Order(numbers[which], log_ns[order], sizes[order], ranks, sorted_blocks)


def _lengths(messages):
    """Return how many bytes each message takes (n,)."""
    if messages.dtype != object:
        return np.full(len(messages), messages.dtype.itemsize)
    return np.array([len(message) for message in messages], dtype=np.int64)


def fill_records(order, first, stop, data, starts):
    """Put the records first to stop of an Order into data (uint8), where they start in it."""
    for rank, messages in zip(order.ranks, order.blocks):
        a, b = np.searchsorted(rank, (first, stop))
        if a == b:
            continue
        rows = rank[a:b] - first
        heads = np.zeros(b - a, dtype=HEAD)
        heads['opcode'] = form.MESSAGE
        heads['length'] = order.sizes[rank[a:b]] - form.RECORD.size
        heads['channel'] = order.channel[rank[a]]
        heads['log_ns'] = heads['publish_ns'] = order.log_ns[rank[a:b]]
        _scatter(data, starts[rows], heads)
        bodies = starts[rows] + HEAD.itemsize
        if messages.dtype != object:
            _scatter(data, bodies, messages[a:b])
            continue
        for start, message in zip(bodies.tolist(), messages[a:b]):
            data[start:start + len(message)] = np.frombuffer(message, dtype=np.uint8)


def _scatter(data, starts, items):
    size = items.dtype.itemsize
    items = items.view(f'V{size}')  # copied as it is, not field by field
    step = int(starts[1] - starts[0]) if len(starts) > 1 else size
    if (np.diff(starts) == step).all():
        # regular, as topics of one rate are: a stride instead of an index for each
        np.ndarray(len(starts), f'V{size}', data, int(starts[0]), (step,))[...] = items
        return
    np.ndarray((len(data) - size + 1,), f'V{size}', data, strides=(1,))[starts] = items
