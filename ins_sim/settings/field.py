"""Describe one parameter: default, unit, range, choices and description in one place."""

from dataclasses import dataclass, field, FrozenInstanceError


def setting(default, doc, unit='', low=None, high=None, choices=(), size=None,
            equal_axes=False):
    """
    Return a dataclass field with its description as metadata.

    Parameters
    ----------
    default : default value
    doc : description shown to users
    unit : unit, '' for none
    low, high : closed range; None for none
    choices : accepted values; a table is kept, not copied, so that entries added to it later are
        accepted as well
    size : length of an array; None for any length
    equal_axes : whether one number may be given for all entries of the array
    """
    return field(default=default, metadata={
        'doc': doc, 'unit': unit, 'low': low, 'high': high, 'choices': choices,
        'size': size, 'equal_axes': equal_axes})


def column(what):
    """Return a field for the header of the CSV column that holds a quantity."""
    return setting('', f'Header of the column with the {what}; the unit may follow in brackets, '
                   'as in "Time (s)" or "w_x [rad s^-1]"; empty = recognised by its name')


def group(cls):
    """Return a field holding a nested group of settings."""
    return field(default_factory=cls)


class SettingsGroup:
    """
    A frozen record of settings, compared and shown by value.

    A subclass overrides ``check`` if values must fit each other; ``check`` runs whenever an
    object is created. ``catalogue.build`` checks the range of each single value before that.

    The methods that dataclass(frozen=True) would generate for each class are written here once,
    which takes a quarter of the 25 ms that every node would spend at its start to generate them
    for thirty classes.

    ``SETTABLE`` lists the parameters that can be set while the node runs; ``SPANS`` those of its
    groups that hold the lists ``start_s`` and ``end_s``.
    """

    SETTABLE, SPANS = (), ()

    def __post_init__(self):
        """Check the values against each other."""
        self.check()

    def check(self):
        """Raise ValueError, with a message of one sentence, if values contradict each other."""

    def __setattr__(self, name, value):
        """Set an attribute that is not set yet; refuse to change one."""
        if name in self.__dict__:
            raise FrozenInstanceError(f'{type(self).__name__}.{name} cannot be changed')
        self.__dict__[name] = value

    def __delattr__(self, name):
        """Refuse to delete an attribute."""
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
    """Make a subclass of SettingsGroup a dataclass (class decorator)."""
    return dataclass(repr=False, eq=False, match_args=False)(cls)
