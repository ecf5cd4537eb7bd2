"""Arrange messages of many topics as one sequence of MCAP records, by log time."""

from dataclasses import dataclass

import numpy as np

from . import mcap_format as form

HEAD = np.dtype([('opcode', 'u1'), ('length', '<u8'), ('channel', '<u2'), ('sequence', '<u4'),
                 ('log_ns', '<u8'), ('publish_ns', '<u8')])


@dataclass(frozen=True)
class Records:
    """
    A sequence of MCAP message records.

    data holds their bytes; channel, log_ns and starts, (n,) int64, give channel, log time and
    first byte of each.
    """

    data: memoryview
    channel: np.ndarray
    log_ns: np.ndarray
    starts: np.ndarray


@dataclass(frozen=True)
class Order:
    """
    Order of the messages of several blocks by log time; ties keep the order of the blocks.

    channel, log_ns and sizes, (n,), describe the records in this order; ranks holds, for each
    block, the ascending positions of its messages in this order, and blocks its messages in this
    order.
    """

    channel: np.ndarray
    log_ns: np.ndarray
    sizes: np.ndarray
    ranks: list
    blocks: list


def arrange_records(blocks):
    """
    Return the Order of blocks (channel id, log_ns (n,), messages (n,)).

    messages is an array of type V, or of bytes objects if their lengths differ.
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
    """Return the number of bytes of each message, (n,)."""
    if messages.dtype != object:
        return np.full(len(messages), messages.dtype.itemsize)
    return np.array([len(message) for message in messages], dtype=np.int64)


def fill_records(order, first, stop, data, starts):
    """Write the records [first, stop) of an Order into data (uint8) at the given starts."""
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
    items = items.view(f'V{size}')  # Copied as a whole, not field by field.
    step = int(starts[1] - starts[0]) if len(starts) > 1 else size
    if (np.diff(starts) == step).all():
        # Topics of one rate lie at regular steps: a stride replaces an index for each message.
        np.ndarray(len(starts), f'V{size}', data, int(starts[0]), (step,))[...] = items
        return
    np.ndarray((len(data) - size + 1,), f'V{size}', data, strides=(1,))[starts] = items
