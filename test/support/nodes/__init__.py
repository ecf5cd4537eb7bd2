"""Test nodes, recorders, and message types of other packages."""
