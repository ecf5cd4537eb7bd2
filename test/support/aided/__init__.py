"""Aided flights for tests: their fixes, offline runs and live streams."""
