"""The node gnss alone: its fixes are those of the core, bit for bit, at the right time."""

from ins_sim.settings.catalogue import build
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.settings.gnss import GnssSettings
from ins_sim.messages import topics
from ins_sim.messages.gnss_fixes import GnssPairs, GnssWriter
from support.live import Chain
import numpy as np
import pytest
from support.stream import DT, SECOND, Stream

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

HEARD = (topics.GNSS_FIX, topics.GNSS_VELOCITY)
FLIGHT = {'motion.kind': 'aggressive'}
VALUES = {'gnss.rate_hz': 2.0, 'gnss.latency_ms': 120.0, 'lever_arm_m': [1.0, -0.5, 2.0],
          'errors.position_drift_m': [2.0, 2.0, 4.0], 'outages.start_s': [3.0, 5.5],
          'outages.end_s': [4.0, 6.0], 'jump.start_s': 7.0, 'jump.end_s': 8.0,
          'jump.offset_m': [30.0, 0.0, 0.0], 'seed': 5}


def offline(stream, stamps_ns, values):
    """Return the GnssFixes of the core from the same odometry."""
    receiver, fixes = Gnss(build(GnssSettings, values)), []
    for t_ns, r_m, q_mb, v_b, rate in stream.odometry(stamps_ns):
        fixes += receiver.push(t_ns, (*stream.frame.geodetic_one(r_m, q_mb, v_b), rate))
    return fixes


def heard_fixes(stream):
    """Return the fixes that a reader makes from the received messages."""
    pairs, found = GnssPairs(0, 120_000_000), []
    for data in stream.raw['gnss/velocity'].values():
        pairs.push_velocity(data)
    for data in stream.raw['gnss/fix'].values():
        found += pairs.push_fix(data)
    return found


def test_the_fixes_are_those_of_the_core(ros_domain, tmp_path):
    """
    The fixes have the bytes of the core, each sent when the truth has reached its arrival.

    During outages invalid fixes are published. The service starts and ends an outage; /diagnostics
    count.
    """
    from std_srvs.srv import SetBool
    stream = Stream(ros_domain, tmp_path, HEARD, FLIGHT)
    try:
        node = stream.chain.start('gnss', VALUES)
        stream.begin(node)
        stamps = np.arange(0, 1051) * DT
        expected = offline(stream, stamps, VALUES)
        stream.send(stamps[1:1012])
        stream.wait_ack(1011 * DT)
        fix = stream.heard['gnss/fix']
        stream.listener.poll_until(lambda: 19 * SECOND // 2 in fix)
        # At 10.11 s the fix of 10.0 s, late by 120 ms, has not arrived.
        assert max(fix) == 19 * SECOND // 2 and len(fix) == 20
        stream.send(stamps[1012:])
        stream.wait_counts({topics.GNSS_FIX: 21, topics.GNSS_VELOCITY: 18})
        writer = GnssWriter(0)
        for fix_ in expected[:21]:
            # DDS pads messages to a multiple of four bytes.
            assert stream.raw['gnss/fix'][fix_.t_ns].startswith(writer.fix(fix_))
            assert (fix_.t_ns in stream.raw['gnss/velocity']) == fix_.valid
            assert not fix_.valid or stream.raw['gnss/velocity'][fix_.t_ns].startswith(
                writer.velocity(fix_))
        assert [f.t_ns / SECOND for f in expected[:21] if not f.valid] == [3.0, 3.5, 5.5]
        got = heard_fixes(stream)
        assert [f.status for f in got] == [f.status for f in expected[:21]]
        assert [f.arrival_ns for f in got] == [f.arrival_ns for f in expected[:21]]
        answer = stream.listener.call(SetBool, 'gnss/outage', SetBool.Request(data=True))
        assert answer.success and answer.message == 'no fixes from now on'
        stream.send(np.arange(1051, 1201) * DT)
        stream.listener.poll_until(lambda: 23 * SECOND // 2 in fix)
        stream.listener.call(SetBool, 'gnss/outage', SetBool.Request(data=False))
        stream.send(np.arange(1201, 1301) * DT)
        stream.wait_counts({topics.GNSS_FIX: 26, topics.GNSS_VELOCITY: 20})
        # The fix of 10.5 s was being delayed when the outage started, that of 12.0 s when it
        # ended.
        last = heard_fixes(stream)[21:]
        assert [f.valid for f in last] == [True, False, False, False, True]
        v = offline(stream, np.arange(1200, 1301) * DT, VALUES)[1].v_n
        assert last[-1].v_n == v
    finally:
        assert set(stream.close().values()) == {0}


def test_diagnostics_count_fixes_and_outages(ros_domain, tmp_path):
    """/diagnostics has the numbers of fixes and outages, and whether one is forced."""
    from diagnostic_msgs.msg import DiagnosticArray
    stream = Stream(ros_domain, tmp_path, HEARD)
    said = {}
    try:
        node = stream.chain.start('gnss', {'outages.start_s': [2.0], 'outages.end_s': [4.0]})
        stream.listener.node.create_subscription(
            DiagnosticArray, '/diagnostics', lambda array: said.update(
                (v.key, v.value) for s in array.status for v in s.values), 10)
        stream.begin(node)
        stream.send(np.arange(1, 551) * DT)
        # Fix 0 is sent as often as sample 0.
        stream.listener.spin_until(lambda: said.get('outages') == '2')
        assert int(said['fixes']) >= 4 and said['outage forced'] == 'False'
    finally:
        stream.close()


def test_a_jump_back_starts_anew_and_nan_is_dropped(ros_domain, tmp_path):
    """After a jump back delayed fixes of the old run are dropped, as is truth with NaN."""
    stream = Stream(ros_domain, tmp_path, HEARD)
    try:
        node = stream.chain.start('gnss', {'gnss.latency_ms': 500.0})
        stream.begin(node)
        stream.send(np.arange(1, 231) * DT)
        stream.wait_ack(230 * DT)
        fix = stream.heard['gnss/fix']
        stream.listener.poll_until(lambda: SECOND in fix)
        fix.clear()
        stream.send(np.arange(0, 301) * DT, poison=230)
        stream.chain.wait_text(node, 'truth jumps back from 2.300000000 s to 0.000000000 s')
        stream.chain.wait_text(node, 'truth/odometry at 2.300000000 s holds')
        stream.chain.wait_text(node, 'gap from 2.290000000 s to 2.310000000 s')
        stream.wait_diagnosis('gap')
        stream.wait_ack(300 * DT)
        stream.listener.poll_until(lambda: SECOND in fix)
        # The fix of 2.0 s was being delayed in both runs and is dropped both times.
        assert sorted(fix) == [0, SECOND]
    finally:
        stream.close()


@pytest.mark.parametrize('values, sentence', [
    ({'gnss.rate_hertz': 1.0}, "the nearest known one is 'gnss.rate_hz'"),
    ({'gnss.rate_hz': 3.0}, 'expected a multiple of the period of rate_hz, 0.01 s'),
    ({'outages.start_s': '[1.0]'}, 'outages.start_s has 1 entries and outages.end_s 0; expected'),
])
def test_a_bad_parameter_is_one_sentence_and_code_2(values, sentence, ros_domain, tmp_path):
    """An invalid parameter of gnss gives one message and exit code 2."""
    chain = Chain(ros_domain, tmp_path)
    process = chain.start('gnss', values)
    assert process.wait(60.0) == 2
    text = chain.text(process)
    assert sentence in text and text.count('\n') == 1
