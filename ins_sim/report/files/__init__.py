"""The arrays of a run in files: as npz, as CSV tables, and as trajectories for evo."""
