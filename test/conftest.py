"""Fixtures of all tests."""

import fcntl
import os
from pathlib import Path
import tempfile

from hypothesis import settings
from ins_sim.ros.transport.repairs import use_profile
import pytest
from support.places import ROOT

pytest_plugins = ('support.figures', 'pytester')

# Before anything imports rclpy: no test talks to another machine, setters check types, and what
# a test publishes is repaired as soon as what a node does.
use_profile()
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'

# the same examples in every run: what one run has passed the next one does not refuse by chance
# (new ones: pytest --hypothesis-profile default)
settings.register_profile('repeatable', derandomize=True)
settings.load_profile('repeatable')


@pytest.fixture
def ros_domain(monkeypatch):
    """Return a ROS domain that no other test on this machine uses, set in the environment."""
    folder = Path(tempfile.gettempdir()) / f'ins_sim-domains-{os.getuid()}'
    folder.mkdir(exist_ok=True)
    # Sessions start at different places, so that a domain is not reused at once; the lock falls
    # with the process, however it ends.
    for step in range(101):
        domain = 1 + (os.getpid() * 7 + _count() + step) % 101
        lock = open(folder / str(domain), 'w')
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            continue
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
        yield domain
        lock.close()
        return
    pytest.fail('the ROS domains 1 to 101 are all in use')


def _count(state=[0]):
    state[0] += 1
    return state[0]


@pytest.fixture(scope='session')
def shared_data():
    """Return the folder of recorded data beside the repository, or skip."""
    folder = Path(os.environ.get('INS_SIM_SHARED_DATA', ROOT.parent / 'shared' / 'data'))
    if not folder.is_dir():
        pytest.skip(f'no recorded data: {folder} does not exist')
    return folder
