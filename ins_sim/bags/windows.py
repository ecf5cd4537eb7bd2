"""Write records of any length into a bag, one time window of all topics after another."""

import numpy as np

from ins_sim.messages.cdr import LAYOUTS
from . import qos
from .bag_writer import BagWriter


def write_windows(path, chosen, windows, storage='mcap', compression='none', replace=False):
    """
    Write windows into a bag and return {topic: number of messages}.

    The bag is created only if it is complete. A message is logged at its stamp.

    Parameters
    ----------
    path, storage, compression, replace : see BagWriter
    chosen : {Topic: Topic that is written for it}
    windows : iterable of {Topic: (stamps_ns (n,), values (n, k))} with all chosen topics; values
        may also be an array of bytes objects, the messages

    Raises
    ------
    ValueError, OSError
        See BagWriter and ``messages.cdr.Writer.block``.
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
                # Jitter may put the first stamp before the epoch, but not the log time.
                messages[written.name] = (
                    np.maximum(stamps_ns, 0),
                    values if packed else writers[topic].block(stamps_ns, values))
                counts[written.name] += len(stamps_ns)
            bag.write_blocks(messages)
        bag.close()
    except OSError:
        raise  # The disk is full; the written part is kept, as the message states.
    except BaseException:
        bag.discard()
        raise
    return counts
