"""Guidance of a vehicle: autopilots, and the linear theory of the loop that they close."""
