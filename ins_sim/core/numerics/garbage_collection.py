"""
Python's cyclic garbage collector, switched off while a block of a run is computed.

The loops over samples make many small tuples and no cycles, and the collector would traverse them
repeatedly (12-29 % of the CPU time). Between two blocks it is on, so that garbage of the rest of
the program is collected.
"""

from functools import wraps
import gc
import threading


class CollectorPause:
    """
    Context manager that switches the collector off inside.

    One object serves nested blocks and several threads: the first to enter switches the collector
    off, and the last to leave restores its earlier state.
    """

    def __init__(self):
        self._lock, self._inside, self._enabled = threading.Lock(), 0, False

    def __enter__(self):
        with self._lock:
            if not self._inside:
                self._enabled = gc.isenabled()
                gc.disable()
            self._inside += 1

    def __exit__(self, *_):
        with self._lock:
            self._inside -= 1
            if not self._inside and self._enabled:
                gc.enable()


collector_paused = CollectorPause()


def paused_in_blocks(make_blocks):
    """Decorate a generator of blocks: the collector is off while a block is computed."""
    @wraps(make_blocks)
    def blocks(*arguments, **named):
        made = make_blocks(*arguments, **named)
        try:
            while True:
                with collector_paused:
                    block = next(made, None)
                if block is None:
                    return
                yield block
        finally:
            made.close()
    return blocks
