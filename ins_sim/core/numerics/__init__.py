"""Numerical tools without physics: Taylor series, noise by index, instants and units."""
