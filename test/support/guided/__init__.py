"""Guided flights for tests, and their lateral channel simulated alone."""
