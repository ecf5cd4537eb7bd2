"""
What the launch files start: their arguments, checked, and what these mean for each node.

Read ``arguments`` first, then ``plan``; ``actions`` alone imports launch.
"""
