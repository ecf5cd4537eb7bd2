"""
Settings: all parameters of nodes and commands, in frozen groups with unit, range and description.

Start with ``field`` (how one parameter is described) and ``catalogue`` (dotted names and checks).
Each file holds the settings of one node or command; ``by_node`` lists those of the nodes. Modules
of this package import only the standard library.
"""
