"""Delay signals during a step that must not be interrupted."""

from contextlib import contextmanager
import signal
import threading

HELD = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)


@contextmanager
def signals_held():
    """
    Hold back the signals HELD, and deliver them at the end of the block.

    A signal mask is not enough: threads of NumPy's libraries receive signals as well.
    """
    # Python handles signals, and allows handlers to be set, only in the main thread.
    main = threading.current_thread() is threading.main_thread()
    # A handler that was not set by Python is None here; it raises no exception.
    held, before = [], {number: handler for number in HELD
                        if main and (handler := signal.getsignal(number)) is not None}
    try:
        for number in before:
            signal.signal(number, lambda number, frame: held.append(number))
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        for number in held:
            signal.raise_signal(number)
