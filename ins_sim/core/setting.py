"""How one setting is described: default, unit, bounds, choices and doc in one place."""

from dataclasses import field


def setting(default, doc, unit='', low=None, high=None, choices=(), size=None):
    """Return a dataclass field carrying its unit, closed bounds, choices, array size and doc."""
    return field(default=default, metadata={
        'doc': doc, 'unit': unit, 'low': low, 'high': high, 'choices': tuple(choices),
        'size': size})


def group(cls):
    """Return a field holding a nested group of settings."""
    return field(default_factory=cls)
