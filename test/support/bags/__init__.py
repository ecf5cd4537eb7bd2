"""Bags for tests: messages of every type, bags of a true motion, and readers of other packages."""
