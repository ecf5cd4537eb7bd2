"""What a table names by 'module:name', such as a motion or a filter in a file of one's own."""

from importlib import import_module


def located(location, entry):
    """
    Import and return what a location 'module:name' names.

    Parameters
    ----------
    location : str
    entry : str
        The entry of the table that holds it, for the sentence: 'motion.kind circle'.

    Raises
    ------
    ValueError
        In one sentence, where there is no such module or name. An error inside the module is its
        own.
    """
    module, colon, name = location.partition(':')
    if not (module and colon and name):
        raise ValueError(f'{entry} is at {location!r} in its table; expected module:name')
    try:
        found = import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or not f'{module}.'.startswith(f'{error.name}.'):
            raise
        raise ValueError(f'{entry} is at {location!r} in its table, and there is no module '
                         f'{error.name}; expected its file in a folder of PYTHONPATH') from error
    try:
        return getattr(found, name)
    except AttributeError as error:
        raise ValueError(f'{entry} is at {location!r} in its table, and module {module} has no '
                         f'{name}; expected module:name') from error
