"""Flight along a route beside its legs, steered sideways by commands from outside."""
