"""Files with the arrays of a run: npz, CSV tables, and trajectories for evo."""
