"""Guard the callbacks of a node: report unexpected exceptions as faults."""

from functools import wraps
from pathlib import Path
import traceback


def described(error):
    """Return one sentence about an exception, with the file and line that raised it."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return (f'{type(error).__name__} ({error}) at line {frame.lineno} of '
            f'{Path(frame.filename).name}; the current computation is discarded and the node '
            'restarts; please report it')


def caught(call, rescue):
    """
    Return a function that calls call(*arguments) and catches its exceptions.

    rescue(sentence) is called with a description of an exception. Exceptions that end the process
    (KeyboardInterrupt, SystemExit) are not caught.
    """
    @wraps(call)
    def guarded(*arguments):
        try:
            return call(*arguments)
        except Exception as error:
            rescue(described(error))

    return guarded
