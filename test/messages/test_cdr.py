"""Packed messages equal those of ROS to the byte, and those of ROS are read back."""

import math

from hypothesis import given, settings, strategies
from ins_sim.messages.cdr import LAYOUTS, Reader, Writer
import numpy as np
import pytest

FRAMES = ('', 'm', 'ab', 'map', 'base', 'base_link', 'a/long/name_of_a_frame')
TYPES = sorted(LAYOUTS)


def values_of(type_name):
    rng = np.random.default_rng(len(type_name))
    return tuple(rng.normal(size=LAYOUTS[type_name].doubles).tolist())


def writer_of(type_name, frame):
    layout = LAYOUTS[type_name]
    return Writer(type_name, *[frame, frame + 'x'][:layout.strings], runs=((0, layout.doubles),))


def ros_class(type_name):
    module, _, name = type_name.split('/')
    return getattr(pytest.importorskip(module + '.msg'), name)


def leaves(message):
    """Return stamp_ns, strings and doubles of a ROS message in the order of its fields."""
    strings, doubles, stamp = [], [], []

    def walk(value, name):
        if hasattr(value, 'get_fields_and_field_types'):
            for field in value.get_fields_and_field_types():
                walk(getattr(value, field), field)
        elif isinstance(value, str):
            strings.append(value)
        elif name in ('sec', 'nanosec'):
            stamp.append(value)
        elif name not in ('service', 'position_covariance_type') and \
                (name != 'status' or isinstance(value, float)):
            doubles.extend(np.ravel(value).tolist())
    walk(message, '')
    return stamp[0] * 10**9 + stamp[1], tuple(strings), tuple(doubles)


@pytest.mark.parametrize('frame', FRAMES)
@pytest.mark.parametrize('type_name', TYPES)
def test_ros_reads_what_is_packed(type_name, frame):
    """rclpy reads stamp, strings and doubles of our messages; the lengths are equal."""
    cls = ros_class(type_name)
    serialization = pytest.importorskip('rclpy.serialization')
    stamp, values = 12_345_678_901_234_567, values_of(type_name)
    data = writer_of(type_name, frame).pack(stamp, values)
    message = serialization.deserialize_message(data, cls)
    texts = (frame, frame + 'x')[:LAYOUTS[type_name].strings]
    assert leaves(message) == (stamp, texts, values)
    assert len(data) == len(serialization.serialize_message(message))


@pytest.mark.parametrize('frame', FRAMES)
@pytest.mark.parametrize('type_name', TYPES)
def test_what_ros_packs_is_read(type_name, frame):
    """Our reader reads stamp, strings and doubles of messages packed by rclpy."""
    cls = ros_class(type_name)
    serialization = pytest.importorskip('rclpy.serialization')
    stamp, values = 987_654_321, values_of(type_name)
    message = serialization.deserialize_message(
        writer_of(type_name, frame).pack(stamp, values), cls)
    data = serialization.serialize_message(message)
    assert Reader(type_name).read(data) == (stamp, values)
    assert Reader(type_name).strings(data) == (frame, frame + 'x')[:LAYOUTS[type_name].strings]


@pytest.mark.parametrize('type_name', TYPES)
def test_rosbags_reads_what_is_packed(type_name):
    """rosbags reads our messages, and we read them again after it has packed them."""
    typesys = pytest.importorskip('rosbags.typesys')
    store = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
    data = writer_of(type_name, 'map').pack(5, values_of(type_name))
    message = store.deserialize_cdr(data, type_name)
    again = store.serialize_cdr(message, type_name)
    assert Reader(type_name).read(bytes(again)) == (5, values_of(type_name))


@pytest.mark.parametrize('type_name', TYPES)
def test_a_block_is_the_single_messages(type_name):
    """Messages packed as a block have the bytes of messages packed one by one."""
    layout = LAYOUTS[type_name]
    writer = Writer(type_name, *['map', 'base_link'][:layout.strings])
    width = sum(b - a for a, b in layout.runs)
    values = np.random.default_rng(1).normal(size=(7, width))
    stamps = np.arange(7) * 10**9 // 3 - 10**9
    singles = []
    for stamp, row in zip(stamps.tolist(), values.tolist()):
        cuts = np.cumsum([0] + [b - a for a, b in layout.runs])
        singles.append(writer.pack(stamp, *[row[a:b] for a, b in zip(cuts, cuts[1:])]))
    assert writer.pack_block(stamps, values) == singles


def test_constants_stand_in_every_message():
    """Constants of a Writer are in every message, with zeros between the runs."""
    writer = Writer('sensor_msgs/msg/Imu', 'imu_link', constants={3: 1.0, 4: -1.0},
                    runs=((13, 16), (25, 28)))
    message = writer.pack(0, (1.0, 2.0, 3.0), (4.0, 5.0, 6.0))
    _, doubles = Reader('sensor_msgs/msg/Imu').read(message)
    expected = [0.0] * 37
    expected[3:5] = 1.0, -1.0
    expected[13:16] = 1.0, 2.0, 3.0
    expected[25:28] = 4.0, 5.0, 6.0
    assert doubles == tuple(expected)


@settings(max_examples=200, deadline=None)
@given(stamp=strategies.integers(0, 2**31 * 10**9 - 1), frame=strategies.text(max_size=30).filter(
    lambda s: '\x00' not in s and s.isprintable()),
    values=strategies.lists(strategies.floats(allow_nan=False, allow_infinity=False),
                            min_size=49, max_size=49))
def test_runs_come_back_whatever_the_strings(stamp, frame, values):
    """Any stamp and runs of doubles are read back to the bit, for any frame name."""
    runs = ((0, 7), (43, 49))
    a, b = tuple(values[:7]), tuple(values[43:])
    data = Writer('nav_msgs/msg/Odometry', frame, 'b').pack(stamp, a, b)
    assert Reader('nav_msgs/msg/Odometry', runs).read(data) == (stamp, a, b)


@pytest.mark.parametrize('type_name', TYPES)
def test_a_message_cut_anywhere_is_refused(type_name):
    """A message truncated at any byte raises a ValueError."""
    data = writer_of(type_name, 'map').pack(1, values_of(type_name))
    reader = Reader(type_name)
    reader.read(data)
    for size in range(len(data)):
        with pytest.raises(ValueError, match='expected'):
            reader.read(data[:size])


def test_big_endian_is_refused():
    """A big-endian message is refused with the encapsulation that is expected."""
    data = writer_of('std_msgs/msg/Header', 'map').pack(1, ())
    with pytest.raises(ValueError, match='little-endian'):
        Reader('std_msgs/msg/Header').read(b'\x00\x00' + data[2:])


def test_the_wrong_number_of_strings_is_refused():
    """A Writer without all frame names of the message is refused."""
    with pytest.raises(ValueError, match='has 2 strings'):
        Writer('nav_msgs/msg/Odometry', 'map')


@pytest.mark.parametrize('wrong', [math.nan, math.inf, -math.inf])
def test_what_is_no_number_is_not_packed(wrong):
    """Values that are not finite are not packed; finite numbers with a huge sum are."""
    writer = Writer('geometry_msgs/msg/Vector3Stamped', 'enu')
    for values in ((wrong, 0.0, 0.0), (0.0, wrong, -wrong)):
        with pytest.raises(ValueError, match='would hold .* expected finite numbers'):
            writer.pack(5 * 10**9, values)
    assert writer.pack(0, (1.5e308, 1.5e308, 5e-324))


def test_nanoseconds_are_less_than_a_second():
    """Stamps with 1e9 nanoseconds or more are refused; ours never have as many."""
    data = bytearray(Writer('std_msgs/msg/Header', 'map').pack(1))
    data[8:12] = (1_000_000_000).to_bytes(4, 'little')
    with pytest.raises(ValueError, match='1000000000 nanoseconds in its stamp; expected less'):
        Reader('std_msgs/msg/Header').read(bytes(data))
