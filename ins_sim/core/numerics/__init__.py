"""Tools without physics: Taylor series, noise by sample index, instants, units, and others."""
