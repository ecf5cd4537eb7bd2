"""Fixtures of the node tests."""

import pytest
from support.live import Chain
from support.nodes.talker import Talker


@pytest.fixture
def talker(ros_domain):
    talker = Talker(ros_domain)
    yield talker
    talker.close()


@pytest.fixture
def chain(ros_domain, tmp_path):
    chain = Chain(ros_domain, tmp_path)
    yield chain
    chain.end()
