"""The Earth: the WGS-84 ellipsoid and its gravity, frames on it, rates, and great circles."""
