"""Reserve a ROS domain for each run on a machine, so that runs do not receive each other."""

from contextlib import contextmanager
import fcntl
import itertools
import os
from pathlib import Path
import tempfile

# Domain ids up to this one are safe on every operating system.
DOMAINS = 101
_taken = itertools.count(1)


@contextmanager
def own_domain():
    """
    Reserve a ROS domain that no other process of this user has reserved in this way.

    Raises RuntimeError if all are in use.
    """
    folder = Path(tempfile.gettempdir()) / f'ins_sim-domains-{os.getuid()}'
    folder.mkdir(exist_ok=True)
    # Processes start their search at different domains, so that a domain is not reused at the
    # next start.
    # The operating system releases the lock when the process ends, however it ends.
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
