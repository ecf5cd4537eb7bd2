"""Import of objects given as 'module:name' in a table, such as a user's own motion or filter."""

from importlib import import_module


def located(location, entry):
    """
    Import and return the object at a location 'module:name'.

    Parameters
    ----------
    location : str
    entry : str
        The entry of the table that has this location, for messages: 'motion.kind circle'.

    Raises
    ------
    ValueError
        If there is no such module or name. Errors raised inside the module are passed on.
    """
    module, colon, name = location.partition(':')
    if not (module and colon and name):
        raise ValueError(f'{entry} is at {location!r} in its table; expected module:name')
    try:
        found = import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or not f'{module}.'.startswith(f'{error.name}.'):
            raise
        raise ValueError(f'{entry} is at {location!r} in its table, but there is no module '
                         f'{error.name}; expected its file in a folder of PYTHONPATH') from error
    try:
        return getattr(found, name)
    except AttributeError as error:
        raise ValueError(f'{entry} is at {location!r} in its table, but module {module} has no '
                         f'{name}; expected module:name') from error
