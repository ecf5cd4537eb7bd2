"""The node velocity_meter alone: its records are the fixes of the core, bit for bit."""

from dataclasses import replace

from ins_sim.messages import topics, velocity_record
from support.live import Chain
import numpy as np
import pytest
from support.stream import DT, offline_fixes, SECOND, Stream

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

FLIGHT = {'motion.kind': 'racetrack'}
VALUES = {'window.cycles': 100, 'window.latency_ms': 50.0, 'seed': 3, 'limits.height_max_m': 2e4}
# Without covariances, like the published truth.
INS = replace(topics.INS_ODOMETRY, runs=None)
BOTH = (topics.TRUTH_ODOMETRY, INS)


class Record:
    """The record as a topic for the Listener: it has no doubles, so its bytes are compared."""

    name, type_name = topics.METER_RECORD.name, topics.METER_RECORD.type_name

    @staticmethod
    def reader():
        """Return a reader of the stamp only."""
        from ins_sim.messages.cdr import Reader
        return Reader('std_msgs/msg/Header')


HEARD = (Record, topics.METER_VELOCITY)


def records(stream):
    """Return the received VelocityFixes."""
    return [velocity_record.read_fix(data, 0) for data in stream.raw[Record.name].values()]


@pytest.mark.parametrize('mode, slide, count', [('surrogate', 0, 6), ('signal', 0, 6),
                                                ('surrogate', 20, 28)])
def test_the_records_are_the_fixes_of_the_core(mode, slide, count, ros_domain, tmp_path):
    """
    Every window is published when the truth reaches its arrival, with the angle of the INS.

    A window waits for the INS: truth alone gives no record and no acknowledgement.
    """
    stream = Stream(ros_domain, tmp_path, HEARD, FLIGHT, BOTH)
    values = {**VALUES, 'mode': mode, 'window.slide_cycles': slide}
    try:
        node = stream.chain.start('velocity_meter', values)
        stream.begin(node)
        stamps = np.arange(0, 651) * DT
        ins = stream.blocks(stamps)[topics.TRUTH_ODOMETRY]
        stream.send(stamps[:300], INS, ins[:300])
        stream.send(stamps[1:304])
        stream.wait_ack(299 * DT)
        stream.listener.poll_until(lambda: 2 * SECOND in stream.heard[Record.name])
        assert 3 * SECOND not in stream.heard[Record.name]
        assert max(stream.heard['sim/ack']) == 299 * DT
        stream.send(stamps[300:], INS, ins[300:])
        # The record of 3 s is still being delayed.
        stream.wait_ack(303 * DT)
        assert 3 * SECOND not in stream.heard[Record.name]
        stream.send(stamps[304:])
        stream.wait_counts({Record: count, topics.METER_VELOCITY: count})
        expected = offline_fixes(stream, stamps, values)
        assert repr(records(stream)) == repr(expected) and len(expected) == count
        assert all(f.valid and f.arrival_ns == f.end_ns + 50_000_000 for f in expected)
        assert len({f.tan_alpha for f in expected}) == count
        pack = topics.METER_VELOCITY.writer().pack
        for fix in expected:
            t_ns, *runs = velocity_record.velocity_one(fix)
            assert stream.raw['velocity_meter/velocity'][t_ns].startswith(pack(t_ns, *runs))
    finally:
        assert set(stream.close().values()) == {0}


def test_without_the_ins_it_says_so_and_goes_on(ros_domain, tmp_path):
    """
    After 5 s without the INS a warning is logged; windows are invalid until it returns.

    Each invalid window has a record.
    """
    stream = Stream(ros_domain, tmp_path, (Record,), FLIGHT, BOTH)
    try:
        node = stream.chain.start('velocity_meter', VALUES)
        stream.begin(node)
        stream.send(np.arange(1, 311) * DT)
        stream.chain.wait_text(node, 'no message on ins/odometry in 5 s; expected the solution')
        stream.wait_ack(310 * DT)
        stream.listener.poll_until(lambda: 3 * SECOND in stream.heard[Record.name])
        assert {f.status for f in records(stream)} == {'no INS velocity in the window'}
        assert all(f.cycles == 100 and np.isnan(f.velocity).all() for f in records(stream))
        stream.wait_diagnosis('no message on ins/odometry')
        # Windows are now published without a wait, and are valid again with the INS.
        stream.send(np.arange(311, 411) * DT)
        stream.listener.poll_until(lambda: 4 * SECOND in stream.heard[Record.name], 4.0)
        stamps = np.arange(401, 511) * DT
        stream.send(stamps, INS, stream.blocks(stamps)[topics.TRUTH_ODOMETRY])
        # The node does not wait for the INS until it has arrived again.
        stream.listener.poll_for(0.5)
        stream.send(np.arange(411, 511) * DT)
        stream.listener.poll_until(lambda: 5 * SECOND in stream.heard[Record.name])
        assert [f.valid for f in records(stream)] == [False] * 4 + [True]
    finally:
        stream.close()


def test_simulated_time_that_stands_still_holds_nothing_up(ros_domain, tmp_path):
    """In lock-step /clock stops while the generator waits; the node still gives up its wait."""
    stream = Stream(ros_domain, tmp_path, (Record,), FLIGHT, BOTH)
    try:
        node = stream.chain.start('velocity_meter', {**VALUES, 'use_sim_time': True})
        stream.begin(node)
        stamps = np.arange(0, 111) * DT
        stream.send(stamps[1:])
        stream.wait_ack(99 * DT)
        # Long after the time that the node waits within the callback.
        stream.listener.poll_for(0.3)
        assert max(stream.heard['sim/ack']) == 99 * DT
        stream.send(stamps, INS, stream.blocks(stamps)[topics.TRUTH_ODOMETRY])
        stream.wait_ack(110 * DT, 4.0)
        stream.wait_counts({Record: 1})
        assert [f.valid for f in records(stream)] == [True]
    finally:
        stream.close()


def test_invalid_windows_are_recorded_and_counted(ros_domain, tmp_path):
    """
    Over calm water each window has an invalid record and no velocity.

    /diagnostics state the last reason.
    """
    from diagnostic_msgs.msg import DiagnosticArray
    stream = Stream(ros_domain, tmp_path, HEARD, FLIGHT)
    values = {**VALUES, 'attack_angle': 'none', 'window.latency_ms': 0.0,
              'drop_outs.start_s': [1.5], 'drop_outs.end_s': [2.5]}
    said = {}
    try:
        node = stream.chain.start('velocity_meter', values)
        stream.listener.node.create_subscription(
            DiagnosticArray, '/diagnostics', lambda array: said.update(
                (v.key, v.value) for s in array.status for v in s.values), 10)
        stream.begin(node)
        stamps = np.arange(0, 401) * DT
        stream.send(stamps[1:])
        stream.wait_counts({Record: 4, topics.METER_VELOCITY: 2})
        expected = offline_fixes(stream, stamps, values, with_ins=False)
        assert repr(records(stream)) == repr(expected)
        assert [f.valid for f in expected] == [True, False, False, True]
        stream.listener.spin_until(lambda: said.get('windows') == '4')
        assert said['invalid fits'] == '2' and said['last reason'] == expected[2].status
        assert sorted(stream.heard['velocity_meter/velocity']) == [SECOND // 2, 7 * SECOND // 2]
    finally:
        stream.close()


def test_a_gap_starts_anew(ros_domain, tmp_path):
    """A window with a gap has no record: the sensor starts anew."""
    stream = Stream(ros_domain, tmp_path, HEARD, FLIGHT)
    try:
        node = stream.chain.start('velocity_meter', {**VALUES, 'attack_angle': 'none'})
        stream.begin(node)
        stream.send(np.arange(1, 151) * DT)
        stream.send(np.arange(160, 411) * DT)
        stream.chain.wait_text(node, 'truth has a gap from 1.500000000 s to 1.600000000 s')
        stream.listener.poll_until(lambda: 4 * SECOND in stream.heard[Record.name])
        assert [f.end_ns // SECOND for f in records(stream)] == [1, 3, 4]
    finally:
        stream.close()


def test_a_jump_back_begins_anew(ros_domain, tmp_path):
    """After a jump back the second run has every window of the first, whatever INS is late."""
    stream = Stream(ros_domain, tmp_path, (Record,), FLIGHT, BOTH)
    try:
        node = stream.chain.start('velocity_meter', VALUES)
        stream.begin(node)
        ins = stream.blocks(np.arange(0, 251) * DT)[topics.TRUTH_ODOMETRY]
        stamps = np.arange(0, 251) * DT
        stream.send(stamps[1:])
        stream.send(stamps[:200], INS, ins[:200])
        stream.listener.poll_until(lambda: SECOND in stream.raw[Record.name])
        first = records(stream)
        stream.raw[Record.name].clear()
        # The truth jumps back while the INS messages up to 2.3 s are still on their way.
        stream.send(stamps[:50])
        stream.chain.wait_text(node, 'truth jumps back from 2.500000000 s to 0.000000000 s')
        stream.send(stamps[200:230], INS, ins[200:230])
        stream.send(stamps, INS, ins)
        stream.send(stamps[50:])
        stream.listener.poll_until(lambda: 2 * SECOND in stream.raw[Record.name])
        assert repr(records(stream)[:len(first)]) == repr(first) and len(first) == 1
        assert [f.valid for f in records(stream)] == [True, True]
        assert 'INS velocity jumps' not in stream.chain.text(node)
    finally:
        stream.close()


@pytest.mark.parametrize('values, sentence', [
    ({'window.cycle': 10}, "the nearest known one is 'window.cycles'"),
    ({'mode': 'signals'}, 'nearest: signal'),
    ({'drop_outs.start_s': '[1.0]'}, 'drop_outs'),
])
def test_a_bad_parameter_is_one_sentence_and_code_2(values, sentence, ros_domain, tmp_path):
    """An invalid parameter of velocity_meter gives one message and exit code 2."""
    chain = Chain(ros_domain, tmp_path)
    process = chain.start('velocity_meter', values)
    assert process.wait(60.0) == 2
    text = chain.text(process)
    assert sentence in text and text.count('\n') == 1
