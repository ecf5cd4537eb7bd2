"""The nodes, one per file; ``stage`` and ``following`` are their base classes."""
