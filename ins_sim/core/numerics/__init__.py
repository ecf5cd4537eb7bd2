"""Tools without physics: Taylor series, noise by index, instants, units, names in tables."""
