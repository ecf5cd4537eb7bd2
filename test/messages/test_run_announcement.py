"""sim/run: the announcement is restored, and invalid ones are refused."""

from dataclasses import replace

from ins_sim.messages.diagnostic_array import pack_diagnostics, read_diagnostics, Status
from ins_sim.messages.run_announcement import read_announcement, RunAnnouncement, UNANNOUNCED
import pytest
from support.bags.messages import STORE

RUN = RunAnnouncement(1735689600 * 10**9 + 123, 5 * 10**9, 200.0 / 3.0, 3600 * 10**9)


def changed(**values):
    """Return the message with changed texts; the value None removes a text."""
    _, frame, (status,) = read_diagnostics(RUN.pack())
    pairs = {**dict(status.values), **values}
    return pack_diagnostics(0, frame, [replace(status, values=tuple(
        (k, v) for k, v in pairs.items() if v is not None))])


def test_a_run_comes_back_bit_for_bit():
    """An announcement is restored to the bit; ROS decodes it, stamped with the first sample."""
    assert read_announcement(RUN.pack()) == RUN
    message = STORE.deserialize_cdr(RUN.pack(), 'diagnostic_msgs/msg/DiagnosticArray')
    assert message.header.stamp.sec == 1735689605 and message.header.stamp.nanosec == 123
    values = {pair.key: pair.value for pair in message.status[0].values}
    assert values == {'epoch_ns': '1735689600000000123', 'start_ns': '5000000000',
                      'end_ns': '3600000000000', 'rate_hz': repr(200.0 / 3.0)}
    assert UNANNOUNCED.epoch_ns == 0


@pytest.mark.parametrize('data, sentence', [
    (changed(epoch_ns=None), "sim/run holds epoch_ns '', start_ns '5000000000'"),
    (changed(rate_hz='fast'), "rate_hz 'fast'; expected a number for each"),
    (changed(rate_hz='nan'), 'announces a run from 5000000000 to 3600000000000 ns at nan Hz'),
    (changed(rate_hz='0'), 'at 0 Hz'), (changed(end_ns='1'), 'expected stamps that ROS can hold'),
    (changed(epoch_ns='9' * 400), 'expected stamps that ROS can hold, in order'),
    (changed(epoch_ns='-6000000000'), 'expected stamps that ROS can hold, in order'),
    (pack_diagnostics(0, '', [Status(0, 'x', '', '')]), "expected one with the name 'run'"),
    (pack_diagnostics(0, '', []), 'sim/run holds 0 statuses'),
    (RUN.pack()[:40], 'ends too early')])
def test_what_is_no_announcement(data, sentence):
    """An invalid announcement is refused with the field and the expectation."""
    with pytest.raises(ValueError, match=sentence):
        read_announcement(data)
