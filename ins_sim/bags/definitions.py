"""Definitions of message types and their hashes, as a bag carries them."""

from functools import lru_cache


@lru_cache(maxsize=None)
def define(type_name):
    """
    Return (definition in the language ros2msg, RIHS01 hash) of a message type of ROS 2 Jazzy.

    Raises ValueError for a type that is not among its common interfaces.
    """
    store = typestore()
    if type_name not in store.types:
        raise ValueError(f'the type {type_name!r} is not known; expected one of the common '
                         'interfaces of ROS 2 Jazzy, or its definition')
    definition, _ = store.generate_msgdef(type_name, ros_version=2)
    return definition, store.hash_rihs01(type_name)


@lru_cache(maxsize=None)
def typestore():
    """Return the types of ROS 2 Jazzy as rosbags has them."""
    from rosbags.typesys import get_typestore, Stores
    return get_typestore(Stores.ROS2_JAZZY)
