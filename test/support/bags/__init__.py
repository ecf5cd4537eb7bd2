"""Bags of truth for tests, and what programs of others say of ours."""
