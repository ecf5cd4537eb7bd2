"""ROS domains of their own for runs on one machine that must not hear each other."""

from contextlib import contextmanager
import fcntl
import itertools
import os
from pathlib import Path
import tempfile

# Domains that every system has ports for.
DOMAINS = 101
_taken = itertools.count(1)


@contextmanager
def own_domain():
    """
    Give a ROS domain that no other process of this user has taken in this way.

    Raises RuntimeError where all of them are taken.
    """
    folder = Path(tempfile.gettempdir()) / f'ins_sim-domains-{os.getuid()}'
    folder.mkdir(exist_ok=True)
    # Processes begin at different places, so that a domain is not used again at once; the lock
    # falls with the process, however it ends.
    first = os.getpid() * 7 + next(_taken)
    for step in range(DOMAINS):
        domain = 1 + (first + step) % DOMAINS
        with open(folder / str(domain), 'w') as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                continue
            yield domain
            return
    raise RuntimeError(f'the ROS domains 1 to {DOMAINS} are all in use; expected a free one')
