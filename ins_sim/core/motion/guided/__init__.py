"""Flight along a route, steered sideways by commands from outside."""
