"""Nodes accept only plausible messages: every field, stamp and length is checked."""

import math
import struct

from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND
from ins_sim.messages.plausible import BOUNDS, PlausibleReader
import numpy as np
import pytest

RUNS = {topics.TRUTH_IMU: ((0, 4), (13, 16), (25, 28)),
        topics.TRUTH_ODOMETRY: ((0, 3), (3, 7), (43, 46), (46, 49))}
FIELDS = [(topic, run, k) for topic, runs in RUNS.items() for run in runs for k in range(*run)]


def message(topic, place=None, value=0.0, stamp_ns=5 * SECOND):
    """Return the bytes of a message whose doubles are 0.1 except for one."""
    data = topic.writer().pack(stamp_ns)
    count = {topics.TRUTH_IMU: 37, topics.TRUTH_ODOMETRY: 85}[topic]
    values = np.full(count, 0.1)
    if place is not None:
        values[place] = value
    return data[:len(data) - 8 * count] + values.tobytes()


@pytest.mark.parametrize('topic, run, place', FIELDS,
                         ids=[f'{topic.name}-{k}' for topic, _, k in FIELDS])
def test_every_field_has_a_bound(topic, run, place):
    """A value at the bound is refused with name and instant; one below it is read to the bit."""
    name, bound, unit = BOUNDS[topic.type_name, run]
    reader = PlausibleReader(topic, RUNS[topic])
    for wrong in (bound, -bound, 1e150, -1e200, 1.7e308, math.inf, -math.inf, math.nan):
        with pytest.raises(ValueError) as raised:
            reader.read(message(topic, place, wrong))
        sentence = str(raised.value)
        assert sentence.startswith(f'{topic.name} at 5.000000000 s holds the {name} (')
        assert f'expected finite numbers below {bound:g}{unit}; the message was dr' in sentence
    for right in (0.9 * bound, -0.9 * bound, 5e-324, -1e-310, 0.0):
        stamp_ns, *runs = reader.read(message(topic, place, right))
        assert stamp_ns == 5 * SECOND
        assert runs[RUNS[topic].index(run)][place - run[0]] == right


def test_what_is_not_read_may_hold_anything():
    """Fields that are not read, such as covariances, are not checked."""
    data = message(topics.TRUTH_IMU, 5, math.nan)
    assert PlausibleReader(topics.TRUTH_IMU, RUNS[topics.TRUTH_IMU]).read(data)[0] == 5 * SECOND


def test_a_run_without_a_bound_is_never_read():
    """A field without a bound in the table cannot be read."""
    with pytest.raises(KeyError):
        PlausibleReader(topics.TRUTH_IMU, ((16, 25),))


@pytest.mark.parametrize('sec, nanosec, sentence', [
    (-2, 0, 'truth/imu holds the instant -2000000000 ns; expected one from 0 to'),
    (-2**31, 5, 'truth/imu holds the instant'),
    (5, SECOND, '1000000000 nanoseconds in its stamp; expected less than 1e9'),
    (2**31 - 1, 2**32 - 1, '4294967295 nanoseconds in its stamp')])
def test_stamps_that_no_run_has(sec, nanosec, sentence):
    """Stamps that are negative, or have 1e9 nanoseconds or more, are refused."""
    data = message(topics.TRUTH_IMU)
    with pytest.raises(ValueError, match=sentence):
        PlausibleReader(topics.TRUTH_IMU).read(
            data[:4] + struct.pack('<iI', sec, nanosec) + data[12:])


def test_the_first_and_the_last_stamp():
    """Stamps from -1 s (jitter at the start) to the last second of 32 bits are read."""
    for stamp_ns in (-SECOND, -1, 0, 2**31 * SECOND - 1):
        data = message(topics.TRUTH_IMU, stamp_ns=stamp_ns)
        assert PlausibleReader(topics.TRUTH_IMU).read(data)[0] == stamp_ns


@pytest.mark.parametrize('data', [
    b'', b'\x00\x01\x00', b'\x00\x00', message(topics.TRUTH_IMU)[:-1],
    b'\x00\x00' + message(topics.TRUTH_IMU)[2:], b'\x00\x07' + message(topics.TRUTH_IMU)[2:],
    message(topics.TRUTH_IMU)[:12] + b'\xff' * 4 + message(topics.TRUTH_IMU)[16:]],
    ids=['nothing', '3 bytes', '2 bytes', 'cut', 'big-endian', 'XCDR2', 'endless text'])
def test_malformed_messages_are_one_sentence(data):
    """Malformed messages raise a ValueError and no other exception."""
    with pytest.raises(ValueError, match='expected'):
        PlausibleReader(topics.TRUTH_IMU).read(data)
