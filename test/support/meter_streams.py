"""Streams of truth pushed into a velocity meter."""

from dataclasses import astuple


def same(a, b):
    """Return whether two lists of fixes are equal to the bit, NaN included."""
    return repr([astuple(fix) for fix in a]) == repr([astuple(fix) for fix in b])
