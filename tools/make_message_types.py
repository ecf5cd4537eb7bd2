"""
Generate ins_sim/bags/message_types.json, the message types of ROS 2 Jazzy, from rosbags.

Usage: .venv/bin/python tools/make_message_types.py
"""

import json

from ins_sim.bags.definitions import SEPARATOR, TABLE
from rosbags.typesys import get_typestore, Stores


def table():
    """Return {type: {'hash': RIHS01 hash, 'lines': lines of the definition without its parts}}."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types = {}
    for name in sorted(store.types):
        definition, _ = store.generate_msgdef(name, ros_version=2)
        own = definition.partition(f'{SEPARATOR}\n')[0]
        types[name] = {'hash': store.hash_rihs01(name), 'lines': own.splitlines()}
    return types


def text():
    """Return the text of the file."""
    return json.dumps(table(), indent=0) + '\n'


if __name__ == '__main__':
    TABLE.write_text(text(), encoding='utf-8')
