"""Records of any length into a bag, a window of all topics at a time."""

import numpy as np

from ins_sim.messages.cdr import LAYOUTS
from . import qos
from .bag_writer import BagWriter


def write_windows(path, chosen, windows, storage='mcap', compression='none', replace=False):
    """
    Write windows into a bag that appears only if it is whole; return {topic: message count}.

    chosen: {Topic: the Topic as which it is written}; windows: an iterable of {Topic: (stamps_ns
    (n,), values (n, k))}, in which every chosen one is; the rest as of BagWriter.  Where values
    are an array of objects they are the messages, bytes, of any length.  A message is logged at
    its own stamp.  Raises as BagWriter and ``messages.cdr.Writer.block`` do.
    """
    bag = BagWriter(path, storage, compression, replace)
    try:
        writers = {topic: written.writer() for topic, written in chosen.items()
                   if written.type_name in LAYOUTS}
        counts = {topic.name: 0 for topic in chosen.values()}
        for topic in chosen.values():
            bag.add_topic(topic.name, topic.type_name,
                          qos.LATCHED if topic.latched else qos.RELIABLE)
        for blocks in windows:
            messages = {}
            for topic, written in chosen.items():
                stamps_ns, values = blocks[topic]
                packed = values is not None and values.dtype == object
                # the first stamp may jitter to before the epoch, a time of logging can not
                messages[written.name] = (
                    np.maximum(stamps_ns, 0),
                    values if packed else writers[topic].block(stamps_ns, values))
                counts[written.name] += len(stamps_ns)
            bag.write_blocks(messages)
        bag.close()
    except OSError:
        raise  # a full disk: what is written is kept, and the error says so
    except BaseException:
        bag.discard()
        raise
    return counts
