"""Bags of truth for tests, and readers of other packages."""
