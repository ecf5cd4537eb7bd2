"""Records over many instants: histories of truth, readings, states and errors, and fixes."""
