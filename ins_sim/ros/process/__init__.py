"""A node process: start, parameters, diagnostics, end."""
