"""Lost messages are resent soon while a node runs, and before it exits."""

from importlib import metadata
import os
import re
import signal
import time
import xml.etree.ElementTree as ElementTree

from ins_sim import resources
from ins_sim.bags.bag_reader import open_bag
from ins_sim.messages import topics
from ins_sim.ros.transport.repairs import BEFORE_3, FROM_3, profiles, use_profile
from support.live import Chain, GUARD_S
import pytest

pytest.importorskip('rclpy')

LENGTH_S = 4
RATE_HZ = 1000


@pytest.fixture
def chain(ros_domain, tmp_path, monkeypatch):
    """Yield a Chain whose nodes must find the middleware profile themselves, and end it."""
    for variable, _ in (BEFORE_3, FROM_3):
        monkeypatch.delenv(variable, raising=False)
    chain = Chain(ros_domain, tmp_path)
    yield chain
    chain.end()


RELEASES = {'7.1.6': [BEFORE_3], '9.1.2': [FROM_3], 'odd': [BEFORE_3, FROM_3],
            None: [BEFORE_3, FROM_3]}


@pytest.mark.parametrize('version', RELEASES)
def test_a_profile_that_the_user_has_named_stays(version, monkeypatch):
    """
    A profile set by the user is kept; otherwise ours is used, for Jazzy, Kilted, or both.

    Both are set if the version of rclpy is unknown.
    """
    def installed(name):
        if version is None:
            raise metadata.PackageNotFoundError(name)
        return version

    monkeypatch.setattr(metadata, 'version', installed)
    assert [*profiles()] == RELEASES[version]
    for variable, name in RELEASES[version]:
        monkeypatch.setenv(variable, '/theirs.xml')
        use_profile()
        assert os.environ[variable] == '/theirs.xml'
        monkeypatch.delenv(variable)
        use_profile()
        assert os.environ[variable] == str(resources.middleware_profile(name))


@pytest.mark.parametrize('name, element', [('fastdds', 'heartbeatPeriod'),
                                           ('fastdds3', 'heartbeat_period')])
def test_writers_ask_what_readers_miss_every_tenth_of_a_second(name, element):
    """The heartbeat of our profile is 0.1 s in the syntax of each release; the default is 3 s."""
    root = ElementTree.parse(resources.middleware_profile(name)).getroot()
    period, = (e for e in root.iter() if e.tag.endswith(element))
    assert {e.tag.split('}')[-1]: e.text for e in period} == {'nanosec': '100000000'}


@pytest.mark.live
def test_the_middleware_takes_the_profile(chain):
    """
    Fast DDS accepts the profile; one in the syntax of another release is refused.

    The heartbeat would then be 3 s.
    """
    node = chain.start('motion_generator', {'motion.kind': 'racetrack', 'duration_s': 0.1})
    assert node.wait(GUARD_S) == 0
    text = chain.text(node)
    assert 'XML' not in text and 'PROFILES_FILE' not in text


@pytest.mark.live
def test_the_last_messages_come_though_they_were_dropped(chain, tmp_path):
    """
    A recorder suspended until the generator would have ended receives every message.

    The shared-memory segment is 512 KiB; several times that is sent in the meantime.
    """
    wanted = [topic.name for topic in (*topics.TRUTH, topics.CLOCK_TOPIC)]
    recorder = chain.start_verb('record', *wanted, '-o', tmp_path / 'bag')
    chain.wait_text(recorder, 'waiting for')
    generator = chain.start('motion_generator', {
        'rate_hz': float(RATE_HZ), 'duration_s': float(LENGTH_S), 'publish_clock': 'true'})
    end, file = time.monotonic() + GUARD_S, tmp_path / 'bag' / 'bag_0.mcap'
    while not file.exists() or file.stat().st_size < 10000:
        assert time.monotonic() < end, chain.text(recorder)
        time.sleep(0.05)
    recorder.send_signal(signal.SIGSTOP)
    try:
        chain.wait_text(generator, 'finished')
        time.sleep(0.3)
        running = generator.poll() is None
    finally:
        recorder.send_signal(signal.SIGCONT)
    assert generator.wait(GUARD_S) == 0, chain.text(generator)
    assert set(chain.end().values()) == {0}
    text = chain.text(recorder)
    assert running
    assert re.findall(r'recorded, (\d+) lost', text) == ['0'] * len(wanted), text
    with open_bag(tmp_path / 'bag') as bag:
        assert {s.last_ns for s in bag.spans().values()} == {LENGTH_S * 10**9}
