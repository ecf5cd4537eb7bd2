"""
Meaning of the launch files: their arguments, the checks of these, and their effect on each node.

Read ``arguments`` first, then ``plan``; only ``actions`` imports launch.
"""
