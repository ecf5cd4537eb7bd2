"""The last net round the callbacks of a node: what should never happen becomes a fault."""

from functools import wraps
from pathlib import Path
import traceback


def described(error):
    """Return an exception as one sentence that names where it was raised."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return (f'{type(error).__name__} ({error}) at line {frame.lineno} of '
            f'{Path(frame.filename).name}; what was being computed is dropped and the node starts '
            'anew: please report it')


def caught(call, rescue):
    """
    Return a function that calls call(*arguments), whatever it raises.

    rescue(sentence) is told of an exception.  Those that end a process pass.
    """
    @wraps(call)
    def guarded(*arguments):
        try:
            return call(*arguments)
        except Exception as error:
            rescue(described(error))

    return guarded
