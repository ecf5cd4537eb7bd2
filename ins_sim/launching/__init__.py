"""
Meaning of the launch files: their arguments, how these are checked, and what they change.

Read ``arguments`` first, then ``plan``; only ``actions`` imports launch.
"""
