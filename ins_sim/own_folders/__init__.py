"""Output folders that are written atomically, without deleting foreign files."""
