"""Definitions of message types and their hashes, as a bag carries them."""

from functools import lru_cache
import json
from pathlib import Path

# Written by tools/make_message_types.py; a test keeps it equal to what rosbags has.
TABLE = Path(__file__).with_name('message_types.json')
SEPARATOR = '=' * 80


@lru_cache(maxsize=None)
def message_definition(type_name):
    """
    Return the definition and the hash of a message type of ROS 2 Jazzy.

    Parameters
    ----------
    type_name : for example 'sensor_msgs/msg/Imu'

    Returns
    -------
    definition : its text in the language ros2msg, followed by those of the types it holds
    type_hash : RIHS01 hash

    Raises
    ------
    ValueError : the type is not among the common interfaces of ROS 2 Jazzy
    """
    table = _table()
    if type_name not in table:
        raise ValueError(f'the type {type_name!r} is not known; expected one of the common '
                         'interfaces of ROS 2 Jazzy, or its definition')
    held = {}
    _collect(type_name, held)
    parts = ''.join(f'{SEPARATOR}\nMSG: {name.replace("/msg/", "/")}\n{_text(name)}'
                    for name in held)
    return _text(type_name) + parts, table[type_name]['hash']


@lru_cache(maxsize=None)
def _table():
    return json.loads(TABLE.read_text(encoding='utf-8'))


def _text(type_name):
    return ''.join(f'{line}\n' for line in _table()[type_name]['lines'])


def _collect(type_name, held):
    """Add the types that a type holds to the keys of a dictionary, each before its own parts."""
    for line in _table()[type_name]['lines']:
        package, slash, name = line.partition(' ')[0].partition('[')[0].partition('/')
        part = f'{package}/msg/{name}'
        if slash and part not in held:
            held[part] = None
            _collect(part, held)
