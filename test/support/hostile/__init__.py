"""Shared by tests and tools/fuzz_nodes.py: nodes fed without DDS, and hostile messages."""
