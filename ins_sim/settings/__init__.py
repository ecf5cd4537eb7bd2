"""
Settings: what a user can set, as frozen groups of values with unit, bounds and description.

Start with ``field`` (how one value is described) and ``catalogue`` (flat names and checks). One
file
holds the settings of one node; ``by_node`` lists them. Only the standard library is imported here.
"""
