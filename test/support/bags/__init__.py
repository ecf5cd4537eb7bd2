"""Bags for tests: messages of every type, truth, and readers of other packages."""
