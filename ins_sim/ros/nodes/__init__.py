"""The nodes, one a file; ``stage`` and ``following`` are their base classes."""
