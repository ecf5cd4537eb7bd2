"""Studies that repeat a published table or compare algorithms over many runs."""
