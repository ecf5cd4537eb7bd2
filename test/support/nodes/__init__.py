"""Nodes that are not ours: who talks, who records, and the types that they speak."""
