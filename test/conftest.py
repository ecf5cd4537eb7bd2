"""Fixtures shared by all tests."""

import os
from pathlib import Path

from hypothesis import settings
from ins_sim.ros.process.domains import own_domain
from ins_sim.ros.transport.repairs import use_profile
import pytest
from support.places import ROOT

pytest_plugins = ('support.figures', 'pytester')

# Set before rclpy is imported: no test communicates with another machine, setters check types, and
# lost messages of a test are resent as fast as those of a node.
use_profile()
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'

# The examples are the same in every run, so that no test fails by chance (for new examples:
# pytest --hypothesis-profile default).
settings.register_profile('repeatable', derandomize=True)
settings.load_profile('repeatable')


@pytest.fixture
def ros_domain(monkeypatch):
    """Return a ROS domain that no other test on this machine uses, set in the environment."""
    with own_domain() as domain:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
        yield domain


@pytest.fixture(scope='session')
def shared_data():
    """Return the folder of recorded data next to the repository, or skip the test."""
    folder = Path(os.environ.get('INS_SIM_SHARED_DATA', ROOT.parent / 'shared' / 'data'))
    if not folder.is_dir():
        pytest.skip(f'no recorded data: {folder} does not exist')
    return folder
