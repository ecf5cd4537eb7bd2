"""How one setting is described: default, unit, bounds, choices and doc in one place."""

from dataclasses import dataclass, field, FrozenInstanceError


def setting(default, doc, unit='', low=None, high=None, choices=(), size=None,
            equal_axes=False):
    """
    Return a dataclass field carrying its unit, closed bounds, choices, array size and doc.

    choices is kept, not copied, so that entries added to a table later are accepted as well.
    equal_axes: whether one number may be given for all entries of the array.
    """
    return field(default=default, metadata={
        'doc': doc, 'unit': unit, 'low': low, 'high': high, 'choices': choices,
        'size': size, 'equal_axes': equal_axes})


def column(what):
    """Return a field for the header of the column of a CSV file that holds something."""
    return setting('', f'header of the column with the {what}; its unit may stand in brackets '
                   'behind it, as in "Time (s)" or "w_x [rad s^-1]"; empty: found by its name')


def group(cls):
    """Return a field holding a nested group of settings."""
    return field(default_factory=cls)


class SettingsGroup:
    """
    A frozen record of settings, compared and shown by value.

    A subclass overrides ``check`` where values must fit each other; it runs whenever an object is
    made. ``catalogue.build`` checks the range of each single value before.

    What dataclass(frozen=True) would write for each class stands here once: to make thirty such
    classes takes 25 ms, on the way of every node's start, and this a quarter of it.

    SETTABLE: names of what the node of these settings takes while it runs; SPANS: groups with
    lists ``start_s`` and ``end_s`` among them.
    """

    SETTABLE, SPANS = (), ()

    def __post_init__(self):
        """Check the values against each other."""
        self.check()

    def check(self):
        """Raise ValueError, in one sentence, where values do not go together."""

    def __setattr__(self, name, value):
        """Take each attribute once."""
        if name in self.__dict__:
            raise FrozenInstanceError(f'{type(self).__name__}.{name} cannot be changed')
        self.__dict__[name] = value

    def __delattr__(self, name):
        """Refuse."""
        raise FrozenInstanceError(f'{type(self).__name__}.{name} cannot be deleted')

    def __eq__(self, other):
        """Compare class and values."""
        return type(self) is type(other) and self.__dict__ == other.__dict__

    def __hash__(self):
        """Hash the values."""
        return hash(tuple(self.__dict__.values()))

    def __repr__(self):
        """Show the values as keyword arguments."""
        values = ', '.join(f'{name}={value!r}' for name, value in self.__dict__.items())
        return f'{type(self).__name__}({values})'


def settings_class(cls):
    """Return a subclass of Settings as a dataclass."""
    return dataclass(repr=False, eq=False, match_args=False)(cls)
