"""An executor on a Dask cluster of the user (extra cluster)."""

import logging
import platform
import time
import warnings

import numpy as np

from ins_sim import __version__

# Longest time until the scheduler answers, and longest time without a worker, s.
CONNECT_S, NO_WORKER_S = 10.0, 60.0
# Interval at which the workers are counted, s.
COUNT_S = 5.0


class Cluster:
    """
    A Dask cluster; it recomputes the blocks of a dead worker on another one by itself.

    Parameters
    ----------
    address : address of the scheduler, such as tcp://host:8786

    Attributes
    ----------
    LOST : the error of a future whose workers have ended several times
    width : number of threads

    Raises
    ------
    ValueError
        If the cluster cannot be reached, has no worker, or has other versions of Python, NumPy or
        ins_sim.
    """

    def __init__(self, address):
        try:
            import distributed
        except ImportError:
            raise ValueError('a scheduler is given, but Dask is not installed; expected '
                             "pip install 'ins_sim[cluster]'") from None
        self._address, self._client = address, None
        self.LOST = (distributed.KilledWorker,)
        self._log = logging.getLogger('distributed')
        self._level = self._log.level
        # Errors are reported in one sentence instead of the log of the client.
        self._log.setLevel(logging.CRITICAL + 1)
        try:
            self._connect(distributed)
            self._pool = self._client.get_executor(pure=False)
            self._known, self._counted_s, self._seen_s = set(), None, time.monotonic()
            self._count()
            if not self._known:
                raise ValueError(f'the cluster at {address} has no worker; expected one or more, '
                                 f'such as "dask worker {address} --nthreads 1"')
        except BaseException:
            self.close()
            raise

    def _connect(self, distributed):
        try:
            with warnings.catch_warnings():
                # _check_versions compares the versions and refuses other ones.
                warnings.simplefilter('ignore')
                # A Client with an empty address would block when it is deleted.
                distributed.comm.get_address_host_port(self._address)
                self._client = distributed.Client(self._address, timeout=CONNECT_S,
                                                  set_as_default=False)
        except (OSError, TypeError, ValueError) as error:
            raise ValueError(f'there is no Dask scheduler at {self._address} '
                             f'({" ".join(str(error).split())}); expected an address such as '
                             'tcp://host:8786') from None

    def submit(self, work, block):
        """Return the Future of work on a block."""
        return self._pool.submit(work, block)

    def check(self):
        """Raise ValueError if the scheduler is lost, or no worker was there for NO_WORKER_S."""
        if self._client.status != 'running':
            raise self.gone()
        now = time.monotonic()
        if now - self._counted_s >= COUNT_S:
            self._count()
            if now - self._seen_s > NO_WORKER_S:
                raise ValueError(f'the cluster at {self._address} has had no worker for '
                                 f'{NO_WORKER_S:g} s; expected one or more')

    def renew(self):
        """Do nothing, as the cluster recovers itself; return False: other futures stay valid."""
        return False

    def gone(self):
        """Return the ValueError of a cluster that is lost."""
        return ValueError(f'the connection to the cluster at {self._address} is lost; expected it '
                          'to run until the study is complete')

    def close(self):
        """Disconnect from the cluster and cancel what it still computes."""
        if self._client is not None:
            self._client.close(timeout=CONNECT_S)
        self._log.setLevel(self._level)

    def _count(self):
        """Count the workers, and check the versions of new ones."""
        try:
            threads = self._client.nthreads()
            fresh = sorted(set(threads) - self._known)
            if fresh:
                _check_versions(self._client, self._address, fresh)
        except (OSError, AttributeError, TimeoutError):
            # The scheduler no longer answers.
            raise self.gone() from None
        self._known, self._counted_s = set(threads), time.monotonic()
        self.width = max(1, sum(threads.values()))
        if threads:
            self._seen_s = self._counted_s


def own_versions():
    """Return {name: version} of the software that determines the numbers."""
    return {'Python': '.'.join(platform.python_version_tuple()[:2]), 'NumPy': np.__version__,
            'ins_sim': __version__}


def _check_versions(client, address, workers):
    """Raise ValueError if the scheduler or one of these workers has other versions than ours."""
    packages = client.get_versions(check=False)
    _check_packages(f'the scheduler at {address}', packages['scheduler'])
    for worker in workers:
        _check_packages(_worker(address), packages['workers'].get(worker, {}))
    try:
        there = client.run_on_scheduler(_asked())
    except ImportError:
        there = None
    _compare(f'the scheduler at {address}', 'ins_sim', there)
    for there in client.run(_asked(), workers=workers, on_error='return').values():
        _compare(_worker(address), 'ins_sim', there if isinstance(there, str) else None)


def _worker(address):
    return f'a worker of the cluster at {address}'


def _check_packages(place, found):
    found = found.get('packages', {})
    _compare(place, 'Python', '.'.join(found.get('python', '').split('.')[:2]))
    _compare(place, 'NumPy', found.get('numpy'))


def _compare(place, name, version):
    ours = own_versions()[name]
    if version != ours:
        raise ValueError(f'{place} has {f"{name} {version}" if version else f"no {name}"}; '
                         f'expected {name} {ours}, as on this machine: other versions may give '
                         'other numbers, or cannot read the blocks')


def _asked():
    """Return a function that also runs on a worker without this module."""
    def version():
        import ins_sim
        return ins_sim.__version__

    return version
