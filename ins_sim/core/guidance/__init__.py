"""Guidance: autopilots, and the steering that gives them a navigation solution."""
