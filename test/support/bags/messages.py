"""Messages of every type, and bags of them, for tests of the format."""

from ins_sim.bags import qos
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.messages import topics
from ins_sim.messages.cdr import LAYOUTS, Writer
import numpy as np
import pytest

typesys = pytest.importorskip('rosbags.typesys')
STORE = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
KINDS = [('mcap', 'none'), ('mcap', 'lz4'), ('mcap', 'zstd'), ('sqlite3', 'none')]
TYPES = sorted(LAYOUTS)
N = 5000
STAMPS = 1_700_000_000_000_000_000 + np.arange(N) * 10**7


def writer_of(type_name, frames=('map', 'base_link')):
    layout = LAYOUTS[type_name]
    return Writer(type_name, *frames[:layout.strings], runs=((0, layout.doubles),))


def values_of(type_name, n=N):
    return np.random.default_rng(TYPES.index(type_name)).normal(size=(n, LAYOUTS[
        type_name].doubles))


def topic_of(type_name):
    return '/a/' + type_name.rpartition('/')[2].lower()


def strings():
    """Return messages of the types without a layout, as the nodes publish them."""
    text = STORE.types[topics.STRING]
    time, header = STORE.types['builtin_interfaces/msg/Time'], STORE.types[topics.HEADER]
    pair = STORE.types['diagnostic_msgs/msg/KeyValue']
    status = STORE.types['diagnostic_msgs/msg/DiagnosticStatus']
    array = STORE.types['diagnostic_msgs/msg/DiagnosticArray']
    return {
        '/sim/status': (topics.STRING, [text(data) for data in ('', 'running', 'ä' * 999)]),
        '/diagnostics': ('diagnostic_msgs/msg/DiagnosticArray', [array(
            header(time(k, 5), ''), [status(k, 'n' * k, '', 'id', [pair('k', 'v' * k)])] * k)
            for k in range(4)])}


def write_everything(path, storage, compression, **options):
    """
    Write N messages of every layout in blocks and a few messages of other types.

    Return {topic: bytes} of all messages written.
    """
    expected = {}
    with BagWriter(path, storage, compression, **options) as bag:
        for type_name in TYPES:
            bag.add_topic(topic_of(type_name), type_name)
        for first in range(0, N, 777):
            rows, blocks = slice(first, first + 777), {}
            for type_name in TYPES:
                messages = writer_of(type_name).block(STAMPS[rows], values_of(type_name)[rows])
                blocks[topic_of(type_name)] = STAMPS[rows], messages
                expected.setdefault(topic_of(type_name), []).extend(m.tobytes() for m in messages)
            bag.write_blocks(blocks)
        for name, (type_name, messages) in strings().items():
            bag.add_topic(name, type_name, qos.LATCHED)
            for k, message in enumerate(messages):
                data = bytes(STORE.serialize_cdr(message, type_name))
                bag.write(name, int(STAMPS[-1]) + k, data)
                expected.setdefault(name, []).append(data)
    return expected


def by_topic(messages):
    found = {}
    for name, log_ns, data in messages:
        found.setdefault(name, []).append(bytes(data))
    return found
