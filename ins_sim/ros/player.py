"""The player as a process; the node is imported only after the signals are handled."""

from .runtime import node_main


def play(path, options, args):
    """Play a bag by Options, with ROS arguments; return the exit code."""
    return node_main(_load, args, path=path, options=options)


def _load():
    from .player_node import PlayerNode
    return PlayerNode
