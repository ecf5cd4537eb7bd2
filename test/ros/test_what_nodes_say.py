"""Log messages of nodes are limited and name the fault, the publishers and the losses."""

from types import SimpleNamespace

from ins_sim.ros.lock_step.pacing import LockStep
from ins_sim.ros.process import said
from ins_sim.ros.process.net import caught
from ins_sim.ros.transport.gaps import Gaps
import pytest
from support.hostile.fed_nodes import ToldClock

pytest.importorskip('rclpy')


@pytest.fixture
def log(monkeypatch):
    """Return a list of log messages, and its clock."""
    clock, lines = ToldClock(), []
    monkeypatch.setattr(said, 'time', clock)
    return SimpleNamespace(clock=clock, lines=lines, said=said.Said(lines.append))


def test_a_kind_is_said_once_and_then_more_and_more_rarely(log):
    """Two warnings a second for ten minutes give fifteen lines, with the number of the others."""
    for k in range(1200):
        log.said.say(f'imu comes at another rate from {k / 2} s; expected 0.01 s')
        log.clock.now_s += 0.5
    assert len(log.lines) == 15
    assert log.lines[0].endswith('expected 0.01 s')
    # Logged after 1, 2, 4, ... 64 s, and then every 64 s.
    assert log.lines[1].endswith('(1 more of this kind before it)')
    assert log.lines[2].endswith('(3 more of this kind before it)')
    assert log.lines[-1].endswith('(127 more of this kind before it)')
    # After a pause the message is logged without a delay.
    log.clock.now_s += 200.0
    log.said.say('imu comes at another rate from 1 s; expected 0.01 s')
    log.clock.now_s += 1.0
    log.said.say('imu comes at another rate from 2 s; expected 0.01 s')
    assert len(log.lines) == 17


def test_thousands_of_different_texts_are_few_lines(log):
    """
    3000 kinds of message in 5 s give 20 lines at first, then two a second.

    The number of suppressed lines is stated.
    """
    for k in range(3000):
        log.said.say(f'a message holds what nobody knows: {"x" * (k % 300)}')
        log.clock.now_s += 5.0 / 3000
    assert len(log.lines) == 29
    assert log.lines[-1].endswith(' other faults were not logged)')
    assert len(log.said._kinds) <= said.KINDS


@pytest.mark.parametrize('text, shown', [
    ('plain', 'plain'), ('\x1b[31mred', '\\x1b[31mred'), ('a\nb\tc', 'a\\nb\\tc'),
    ('\u202eback', '\\u202eback'), ('\ud800', '\\ud800'), ('Grüße', 'Grüße')])
def test_texts_are_cut_and_made_visible(text, shown):
    """Escape sequences are made visible, and long texts are truncated."""
    assert said.short(text) == shown
    long = said.short(text * 10_000, 20)
    assert len(long) < 220 and long.isprintable() and long.endswith('characters)')


def test_the_lock_step_complaint_is_a_line():
    """Of 4000 names of 10 kB on sim/ack ten are shown, truncated, with the number of others."""
    lock = LockStep(('strapdown',), 10, 30.0)
    for k in range(4000):
        lock.ack(f'{k}\x1b' + 'x' * 10_000, 0, 5)
    complaint = lock.complaint(('strapdown',), 'the consumers')
    assert complaint.count('10001 characters)') + complaint.count('10002 characters)') == 10
    assert ' and others)' in complaint and len(complaint) < 1200 and complaint.isprintable()
    assert len(lock.strangers) == 10
    one = LockStep(('strapdown',), 10, 30.0)
    one.ack('recorder', 0, 5)
    assert one.complaint(('strapdown',), 'it').endswith('to run (heard: recorder)')


def test_two_publishers_are_named():
    """Two generators are reported by name by both of them and by their readers."""
    from ins_sim.ros.process.publishers import SolePublishers
    from ins_sim.ros.transport.qos import data_profile
    infos = [SimpleNamespace(node_name=name, node_namespace='/run', qos_profile=data_profile(1))
             for name in ('motion_generator', 'second\x1b')]
    node = SimpleNamespace(resolve_topic_name=lambda name: f'/run/{name}',
                           _parameter_overrides={},
                           count_publishers=lambda name: 2,
                           get_publishers_info_by_topic=lambda name: infos)
    queue = SimpleNamespace(gaps=Gaps(), subscription=object())
    wrong, values = SolePublishers(node, {'truth/imu': queue}).describe()
    assert wrong.startswith('/run/truth/imu has 2 publishers, /run/motion_generator, '
                            '/run/second\\x1b; expected one: two of them (two generators')
    assert queue.gaps.publishers == 2 and values == ()
    node.count_publishers = lambda name: 1
    assert SolePublishers(node, {'truth/imu': None}).describe() == ('', ())


def test_losses_are_told_from_a_wrong_rate():
    """
    Losses found by message numbers lead to advice about load and topics.depth.

    A wrong rate leads to other advice.
    """
    from ins_sim.ros.process.publishers import MessageLosses
    queue = SimpleNamespace(gaps=Gaps(), dropped=0)
    losses = MessageLosses({'truth/odometry': queue}, 500)
    for number in (1, 2, 3):
        queue.gaps.take(number)
    assert losses.describe()[0] == ''
    queue.gaps.take(50)
    wrong, values = losses.describe()
    assert wrong.startswith('46 messages of truth/odometry were lost: this node or the transport')
    assert wrong.endswith('or a topics.depth above 500') and values[0][1] == 46
    assert losses.describe()[0] == ''
    queue.dropped = 7
    assert losses.describe()[0].startswith('7 messages of truth/odometry were dropped: they had '
                                           'waited for more than 5 s')


@pytest.mark.parametrize('may_drop', [True, False])
def test_an_old_backlog_is_dropped_in_real_time_alone(may_drop, monkeypatch):
    """Messages older than 5 s are dropped unless somebody waits for an acknowledgement."""
    from ins_sim.messages import topics
    from ins_sim.ros.transport import backlog
    clock, taken = ToldClock(), []
    monkeypatch.setattr(backlog, 'time', clock)
    node = SimpleNamespace(resolve_topic_name=str, _parameter_overrides={},
                           create_subscription=lambda *_, **__: SimpleNamespace(
                               handle=SimpleNamespace(take_message=None)))
    queue = backlog.DrivingQueue(node, topics.TRUTH_IMU, 10, taken.append, lambda: None,
                                 lambda: may_drop)
    ages_s = [6.0, 5.5, 5.1, 4.9, 1.0, 0.0]
    waiting = [(age_s, {'publication_sequence_number': number,
                        'received_timestamp': clock.time_ns() - round(1e9 * age_s)})
               for number, age_s in enumerate(ages_s, 1)]
    queue._take = lambda cls, raw: waiting.pop(0) if waiting else None
    queue._wake(*waiting.pop(0))
    assert taken == (ages_s[3:] if may_drop else ages_s)
    assert queue.dropped == (3 if may_drop else 0) and queue.gaps.lost == 0


def test_the_net_takes_whatever_is_raised():
    """
    An unexpected exception gives one message with type, cause and place.

    Exceptions that end a process are passed on.
    """
    told = []

    def divide(a, b):
        return a / b

    guarded = caught(divide, told.append)
    assert guarded(4, 2) == 2 and not told
    assert guarded(1, 0) is None
    assert told[0].startswith('ZeroDivisionError (division by zero) at line ')
    assert 'of test_what_nodes_say.py; the current computation is discarded and' in told[0]
    with pytest.raises(KeyboardInterrupt):
        caught(lambda: (_ for _ in ()).throw(KeyboardInterrupt()), told.append)()
