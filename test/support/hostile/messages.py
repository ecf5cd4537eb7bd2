"""
Hostile messages: good messages changed in every way, by kind, from one seed.

They are bytes as received from DDS, used by test/ros/test_hostile_nodes.py and
tools/fuzz_nodes.py.
"""

from collections import deque
import math
import random
import struct

from ins_sim.messages import diagnostic_array, topics
from ins_sim.messages.cdr import LAYOUTS, Writer
import numpy as np

SECOND = 1_000_000_000
NUMBERS = (math.nan, math.inf, -math.inf, 1e10, -1e10, 1e150, 1e200, -1e308, 5e-324, -1e-310, 0.0,
           -0.0, 1e5, 99999.0, -9999.0, 9.99e5, 9.9e7, 180.0, -91.0, 1e-9)
INSTANTS = ('9' * 400, '-' + '9' * 400, '1e300', 'nan', '', '0', '-1', str(2**63),
            str(2**31 * SECOND))
TEXTS = ('\x1b[31mred\x1b[0m', '\x1b]0;title\x07', 'a\nb\r\tc', '\u202ereversed', 'x' * 10_000,
         '%s %n {0}', "it's", '', '\ud800'.encode('utf-8', 'surrogatepass').decode('latin-1'))
# Shifts of stamps, ns.
SHIFTS = (1, -1, 10**6, -10**6, 5 * 10**6, 10**7, -10**7, 3 * 10**7, -5 * 10**7, SECOND, -SECOND,
          60 * SECOND, -60 * SECOND, 3600 * SECOND, 10**6 * SECOND, 1_020_000 * SECOND)


def with_stamp(data, sec, nanosec):
    """Return a message with another stamp, whether valid or not."""
    return data[:4] + struct.pack('<iI', sec, nanosec) + data[12:]


class HostileMessages:
    """
    Creates hostile messages from good messages of some Topics.

    seed: determines all messages; wanted: Topics. ``heard(name, data)`` must be called with every
    good message; ``message()`` returns a kind, the name of a topic and bytes.
    """

    def __init__(self, seed, wanted):
        self.random = self._random = random.Random(seed)
        self._topics = {topic.name: topic for topic in wanted}
        self.names = set(self._topics)
        self._good = {topic.name: deque(maxlen=50) for topic in wanted}
        self.kinds = {'field': self._field, 'fields': self._fields, 'stamp': self._stamp,
                      'shifted': self._shifted, 'text': self._text, 'malformed': self._malformed,
                      'order': self._order, 'duplicate': self._duplicate,
                      'publisher': self._publisher}

    def heard(self, name, data):
        """Store a good message."""
        self._good[name].append(bytes(data))

    def last(self, name):
        """Return the last good message of a topic."""
        return self._good[name][-1]

    def message(self):
        """
        Return kind, topic name and bytes of a hostile message; None before the first good message.
        """
        name = self._random.choice(list(self._topics))
        good = self._good[name]
        if not good:
            return None
        kind = self._random.choice(list(self.kinds))
        return kind, name, self.kinds[kind](self._topics[name], good)

    def _doubles(self, topic, data):
        """Return the offset of the doubles of a message and their number."""
        count = LAYOUTS[topic.type_name].doubles if topic.type_name in LAYOUTS else 0
        end = len(data) - LAYOUTS[topic.type_name].fix if count else len(data)
        return end - 8 * count, count

    def _number(self):
        choose = self._random
        if choose.random() < 0.3:
            return choose.uniform(-1.0, 1.0) * 10.0 ** choose.uniform(-300, 300)
        return choose.choice(NUMBERS)

    def _field(self, topic, good):
        return self._spoilt(topic, good[-1], 1)

    def _fields(self, topic, good):
        return self._spoilt(topic, good[-1], self._random.randint(2, 90))

    def _spoilt(self, topic, data, times):
        if topic == topics.METER_RECORD:
            return self._record(data, times)
        offset, count = self._doubles(topic, data)
        if not count:
            return self._shifted(topic, (data,))
        spoilt = bytearray(data)
        for _ in range(times):
            struct.pack_into('<d', spoilt, offset + 8 * self._random.randrange(count),
                             self._number())
        if self._random.random() < 0.5:
            # With a present stamp, so that the message is not rejected for its stamp alone.
            return self._moved(bytes(spoilt), self._random.choice((10**7, 2 * 10**7)))
        return bytes(spoilt)

    def _record(self, data, times):
        choose = self._random
        stamp_ns, frame, (status,) = diagnostic_array.read_diagnostics(data)
        values = list(status.values)
        for _ in range(times):
            at = choose.randrange(len(values))
            key, _ = values[at]
            values[at] = key, choose.choice((
                repr(self._number()), choose.choice(INSTANTS), choose.choice(TEXTS)))
        if choose.random() < 0.2:
            del values[choose.randrange(len(values))]
        if choose.random() < 0.1:
            values *= 100
        return self._packed(stamp_ns, frame, [(status.level, status.name, status.message, values)])

    def _packed(self, stamp_ns, frame, statuses):
        return diagnostic_array.pack_diagnostics(stamp_ns, frame, [
            diagnostic_array.Status(level, name, message, '', tuple(values))
            for level, name, message, values in statuses])

    def _stamp(self, topic, good):
        sec = self._random.choice((0, 1, -1, -2, 2**31 - 1, -2**31, 10**6,
                                   struct.unpack_from('<i', good[-1], 4)[0]))
        nanosec = self._random.choice((0, 1, 999_999_999, SECOND, 2**32 - 1, 2**31))
        return with_stamp(good[-1], sec, nanosec)

    def _moved(self, data, shift_ns):
        sec, nanosec = struct.unpack_from('<iI', data, 4)
        sec, nanosec = divmod(sec * SECOND + nanosec + shift_ns, SECOND)
        return with_stamp(data, max(-2**31, min(sec, 2**31 - 1)), nanosec)

    def _shifted(self, topic, good):
        shift = self._random.choice(SHIFTS)
        if self._random.random() < 0.2:
            shift = round(10.0 ** self._random.uniform(0, 18)) * self._random.choice((1, -1))
        return self._moved(good[-1], shift)

    def _text(self, topic, good):
        texts = [self._random.choice(TEXTS) for _ in range(2)]
        if topic == topics.METER_RECORD:
            stamp_ns, frame, (status,) = diagnostic_array.read_diagnostics(good[-1])
            name = self._random.choice((status.name, texts[0]))
            many = self._random.choice((1, 1, 2, 50))
            return self._packed(stamp_ns, texts[1], [(self._random.randrange(256), name, texts[1],
                                                      status.values)] * many)
        layout = LAYOUTS[topic.type_name]
        offset, count = self._doubles(topic, good[-1])
        data = Writer(topic.type_name, *texts[:layout.strings], runs=((0, count),)).pack_block(
            [0], np.array([struct.unpack_from(f'<{count}d', good[-1], offset)]))[0]
        return self._moved(data[:4] + good[-1][4:12] + data[12:], 10**7)

    def _malformed(self, topic, good):
        choose, data = self._random, good[-1]
        how = choose.randrange(9)
        if how == 0:
            return data[:3]
        if how == 1:
            return b''
        if how == 2:
            return data[:choose.randrange(len(data))]
        if how == 3:
            return data + bytes(choose.randrange(256) for _ in range(choose.randrange(1, 40)))
        if how == 4:
            # Big-endian, XCDR2, parameter lists, and invalid encapsulations.
            return bytes((choose.choice((0, 1, 7, 255)), choose.choice((0, 2, 3, 6, 7, 9, 255)))
                         ) + data[2:]
        if how == 5:
            return bytes(choose.randrange(256) for _ in range(choose.randrange(300)))
        if how == 6:
            # The length of the first string of the message.
            return data[:12] + struct.pack('<I', choose.choice(
                (0, 2**32 - 1, 2**31, len(data), choose.randrange(2**32)))) + data[16:]
        spoilt = bytearray(data)
        for _ in range(choose.randrange(1, 9)):
            spoilt[choose.randrange(len(data))] = choose.randrange(256)
        return bytes(spoilt)

    def _order(self, topic, good):
        return self._random.choice(good)

    def _duplicate(self, topic, good):
        return good[-1]

    def _publisher(self, topic, good):
        """
        Return a message as from a second publisher: between two samples, or from another time.
        """
        return self._moved(good[self._random.randrange(-min(5, len(good)), 0)],
                           self._random.choice((5 * 10**6, 2 * 10**6, 100 * SECOND, -2 * SECOND)))
