"""Life of a node process: start, parameters, diagnostics, end."""
