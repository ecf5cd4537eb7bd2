"""Find the known name nearest to a misspelt one, for error messages."""

from .shown import LONGEST, shown

SIMILAR = 0.75


def nearest_name(name, known):
    """Return the known text that is most similar to name."""
    return _matches(name, known, 0.0)[0]


def similar_name(name, known):
    """Return the known text that name may be a misspelling of, or None."""
    return next(iter(_matches(name, known, SIMILAR)), None)


def _matches(name, known, cutoff):
    # Imported only when there is an error to report: nodes start faster without it.
    from difflib import get_close_matches
    return get_close_matches(str(name)[:LONGEST], sorted(known), n=1, cutoff=cutoff)


def unknown_key(name, known):
    """Return the message about an unknown parameter, with the nearest known one."""
    near = nearest_name(name, known)
    return f'unknown parameter {shown(name)}; the nearest known one is {near!r}'
