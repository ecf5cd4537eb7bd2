"""The messages of the aiding sensors agree with ROS, and fixes are restored to the bit."""

from dataclasses import replace
from importlib import import_module
import math
import struct

from hypothesis import given, settings, strategies as st
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation.errors import position_error
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.aiding.fix_checks import check_gnss
from ins_sim.core.timeseries.fixes import GnssFix, no_gnss_fix, OUTAGE, VelocityFix
from ins_sim.messages import diagnostic_array, topics, velocity_record
from ins_sim.messages.cdr import Reader, Writer
from ins_sim.messages.diagnostic_array import Status
from ins_sim.messages.gnss_fixes import GnssPairs, GnssWriter
import numpy as np
import pytest

EPOCH = 1_700_000_000_000_000_000
SECOND = 1_000_000_000
WINDOW = VelocityFix(20 * SECOND, 30 * SECOND, 1000, (199.7, -1.0 / 3.0), (0.25, 0.27), 0.0123,
                     (3.910781e-4, 4.078256e-4), (-1.2e8, -1.3e8), arrival_ns=30_250_000_000)
NO_WINDOW = replace(WINDOW, velocity=(math.nan, math.nan), sigma=(math.nan, math.nan),
                    status='the peak is at an end lag')
FIX = GnssFix(7 * SECOND, math.radians(55.123), math.radians(37.456), 512.3, (120.0, -70.1, 0.3),
              (1.5, 1.7, 1.0 / 3.0), (0.05, 0.06, 0.1), arrival_ns=7_120_000_000)
ANY = st.floats(allow_nan=False)
PAIR = st.tuples(ANY, ANY)
TEXT = st.text(st.characters(codec='utf-8', exclude_characters='\x00'), max_size=20)


def ros(type_name):
    """Return the class of rclpy and its serialisers, or skip."""
    serialization = pytest.importorskip('rclpy.serialization')
    module, _, name = type_name.split('/')
    cls = getattr(import_module(module + '.msg'), name)
    return cls, lambda data: serialization.deserialize_message(data, cls), \
        serialization.serialize_message


def store():
    """Return the type store of rosbags."""
    typesys = pytest.importorskip('rosbags.typesys')
    return typesys.get_typestore(typesys.Stores.ROS2_JAZZY)


STATUSES = [Status(0, 'a', '', 'x' * 5, (('k', 'v'), ('', 'ä'))), Status(1, 'bcd', 'no', '', ())]


@pytest.mark.parametrize('statuses', [[], STATUSES[:1], STATUSES])
@pytest.mark.parametrize('frame', ['', 'abc', 'velocity_meter_link'])
def test_a_diagnostic_array_is_that_of_ros(statuses, frame):
    """ROS and rosbags read our DiagnosticArray, and we read theirs."""
    data = diagnostic_array.pack_diagnostics(EPOCH + 5, frame, statuses)
    message = store().deserialize_cdr(data, topics.DIAGNOSTICS)
    assert bytes(store().serialize_cdr(message, topics.DIAGNOSTICS)) == data
    assert diagnostic_array.read_diagnostics(data) == (EPOCH + 5, frame, statuses)
    _, load, dump = ros(topics.DIAGNOSTICS)
    message = load(data)
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1_700_000_000, 5)
    assert message.header.frame_id == frame
    assert [Status(s.level[0], s.name, s.message, s.hardware_id, tuple(
        (v.key, v.value) for v in s.values)) for s in message.status] == statuses
    # Their padding is uninitialised, also at the end.
    assert diagnostic_array.read_diagnostics(dump(message)) == (EPOCH + 5, frame, statuses)


@settings(max_examples=100, deadline=None)
@given(frame=TEXT, statuses=st.lists(st.builds(
    Status, st.integers(0, 255), TEXT, TEXT, TEXT, st.lists(st.tuples(TEXT, TEXT), max_size=4).map(
        tuple)), max_size=3))
def test_any_diagnostic_array_comes_back(frame, statuses):
    """Any DiagnosticArray is read back to the bit."""
    data = diagnostic_array.pack_diagnostics(7, frame, statuses)
    assert diagnostic_array.read_diagnostics(data) == (7, frame, statuses)


def test_a_diagnostic_array_cut_anywhere_is_refused():
    """A DiagnosticArray cut anywhere, with excessive lengths, or big-endian is refused."""
    data = velocity_record.pack_fix(WINDOW, EPOCH)
    for size in range(len(data)):
        with pytest.raises(ValueError, match='expected'):
            diagnostic_array.read_diagnostics(data[:size])
    many = diagnostic_array.pack_diagnostics(0, '', [])[:-4] + struct.pack('<I', 2**32 - 1)
    for bad in (many, b'\x00\x00' + data[2:]):
        with pytest.raises(ValueError, match='expected'):
            diagnostic_array.read_diagnostics(bad)


@pytest.mark.parametrize('fix', [WINDOW, NO_WINDOW])
def test_a_velocity_fix_comes_back_from_its_record(fix):
    """A velocity fix is restored to the bit; stamp and level give window end and validity."""
    data = velocity_record.pack_fix(fix, EPOCH)
    assert repr(velocity_record.read_fix(data, EPOCH)) == repr(fix)
    stamp_ns, frame, (status,) = diagnostic_array.read_diagnostics(data)
    assert (stamp_ns, frame) == (EPOCH + fix.end_ns, 'velocity_meter_link')
    assert (status.level, status.message) == (0 if fix.valid else 1, fix.status)
    keys = ['window_start_ns', 'window_end_ns', 'cycles', 'tan_alpha', 'velocity_x', 'velocity_y',
            'sigma_x', 'sigma_y', 'tau12', 'tau23', 'g12', 'g23', 'status', 'arrival_ns']
    assert [key for key, _ in status.values] == keys
    assert dict(status.values)['window_start_ns'] == str(EPOCH + fix.start_ns)


@settings(max_examples=200, deadline=None)
@given(velocity=PAIR, sigma=PAIR, tan=ANY, tau=PAIR, g=PAIR, start=st.integers(0, 10**16),
       cycles=st.integers(1, 10**5), latency=st.integers(0, 10**11))
def test_any_velocity_fix_comes_back(velocity, sigma, tan, tau, g, start, cycles, latency):
    """Any velocity fix is read back from its record to the bit."""
    end = start + cycles * 10**7
    fix = VelocityFix(start, end, cycles, velocity, sigma, tan, tau, g, arrival_ns=end + latency)
    assert velocity_record.read_fix(velocity_record.pack_fix(fix, EPOCH), EPOCH) == fix


def test_records_that_are_none_are_refused():
    """Records with another status, a missing key, or text in place of a number are refused."""
    def packed(name, values):
        return diagnostic_array.pack_diagnostics(0, '', [Status(0, name, '', '', tuple(values))])
    values = diagnostic_array.read_diagnostics(velocity_record.pack_fix(WINDOW, 0))[2][0].values
    assert velocity_record.read_fix(packed('velocity_meter', values), 0) == WINDOW
    for name, wrong, sentence in (
            ('imu', values, r"holds the statuses \['imu'\]; expected one of velocity_meter"),
            ('velocity_meter', values[1:], 'window_start_ns is None; expected a whole number'),
            ('velocity_meter', [(k, 'fast' if k == 'g23' else v) for k, v in values],
             "g23 is 'fast'; expected a number")):
        with pytest.raises(ValueError, match=sentence):
            velocity_record.read_fix(packed(name, wrong), 0)


def test_the_velocity_for_display():
    """The displayed velocity is stamped mid-window; unmeasured parts have a huge variance."""
    t_ns, *runs = velocity_record.velocity_one(WINDOW)
    data = topics.METER_VELOCITY.writer().pack(t_ns + EPOCH, *runs)
    message = ros(topics.TWIST)[1](data)
    assert message.header.frame_id == 'velocity_meter_link'
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1_700_000_025, 0)
    twist = message.twist
    v = twist.twist.linear
    assert (v.x, v.y, v.z) == (199.7, -1.0 / 3.0, -199.7 * 0.0123)
    covariance = np.reshape(twist.covariance, (6, 6))
    assert np.array_equal(np.diag(covariance), [0.25 * 0.25, 0.27 * 0.27, *[1e9] * 4])
    assert np.count_nonzero(covariance) == 6


def pairs(fixes, latency_ns=120_000_000, swapped=False):
    """Return the fixes that a reader makes from the messages of GnssFixes."""
    writer, reader = GnssWriter(EPOCH), GnssPairs(EPOCH, latency_ns)
    found = []
    for fix in fixes:
        pushes = [lambda: reader.push_fix(writer.fix(fix))]
        if fix.valid:
            pushes.append(lambda: reader.push_velocity(writer.velocity(fix)))
        for push in reversed(pushes) if swapped else pushes:
            found += push()
    return found


@pytest.mark.parametrize('swapped', [False, True])
def test_a_gnss_fix_comes_back(swapped):
    """A GNSS fix is restored to the bit except the angles, which err by less than 1e-9 m."""
    none = no_gnss_fix(8 * SECOND, OUTAGE, 8_120_000_000)
    later = replace(FIX, t_ns=9 * SECOND, arrival_ns=9_120_000_000)
    found = pairs([FIX, none, later], swapped=swapped)
    assert repr(found[1]) == repr(none) and len(found) == 3
    off = np.abs(position_error(*(getattr(f, n) for f in (found[0], FIX)
                                  for n in ('lat', 'lon', 'height')))).max()
    print(f'\n{off:.1e} m by way of degrees (1e-9)')
    assert off < 1e-9
    for got, sent in zip(found[::2], (FIX, later)):
        assert replace(got, lat=sent.lat, lon=sent.lon) == sent


@settings(max_examples=300, deadline=None)
@given(lat=st.floats(-1.57, 1.57), lon=st.floats(-math.pi, math.pi),
       sigma=st.floats(0.0, 1e6).filter(lambda s: s == 0.0 or s > 1e-100))
def test_anywhere_on_earth(lat, lon, sigma):
    """
    Anywhere on Earth angles err by 1.5 ulp of pi and half an ulp of 180 deg.

    Two conversions round twice each, and a degree is rounded. Sigmas are restored to the bit.
    """
    fix = replace(FIX, lat=lat, lon=lon, position_sigma=(sigma,) * 3)
    found, = pairs([fix])
    most = 2.0**-52 * (3.0 + math.pi)
    assert abs(found.lat - lat) * ellipsoid.SEMI_MAJOR < most * ellipsoid.SEMI_MAJOR / 2.0
    assert abs(found.lon - lon) < most
    assert found.position_sigma == fix.position_sigma


def test_repeated_lost_and_restarted_messages():
    """Repeated messages and fixes without velocity are skipped; a jump back starts anew."""
    writer, reader = GnssWriter(0), GnssPairs(0, 0)
    fixes = [replace(FIX, t_ns=k * SECOND, arrival_ns=k * SECOND) for k in range(5)]
    both = [(writer.fix(f), writer.velocity(f)) for f in fixes]
    assert not reader.push_velocity(both[0][1]) and not reader.push_velocity(both[0][1])
    assert len(reader.push_fix(both[0][0])) == 1
    assert not reader.push_fix(both[0][0]) and not reader.push_velocity(both[0][1])
    assert not reader.push_fix(both[1][0]) and not reader.push_fix(both[1][0])
    assert not reader.push_fix(both[2][0])
    found = reader.push_velocity(both[2][1])
    assert [f.t_ns for f in found] == [2 * SECOND] and reader.lost == 1
    assert not reader.push_fix(both[3][0]) and not reader.push_fix(both[0][0])
    assert [f.t_ns for f in reader.push_velocity(both[0][1])] == [0]
    with pytest.raises(ValueError, match='expected'):
        reader.push_fix(both[0][0][:50])


def test_the_status_of_a_fix_as_ros_reads_it():
    """A valid fix has status 0, GPS, and known variances; an invalid one -1, NaN, and unknown."""
    _, load, _ = ros(topics.FIX)
    writer = GnssWriter(EPOCH)
    message = load(writer.fix(FIX))
    assert (message.status.status, message.status.service) == (0, 1)
    assert message.position_covariance_type == 2 and message.header.frame_id == 'gnss_link'
    assert message.position_covariance.tolist() == [
        1.5 * 1.5, 0.0, 0.0, 0.0, 1.7 * 1.7, 0.0, 0.0, 0.0, (1.0 / 3.0) ** 2]
    assert (message.latitude, message.altitude) == (math.degrees(FIX.lat), 512.3)
    message = load(writer.fix(no_gnss_fix(0, OUTAGE, 0)))
    assert message.status.status == -1 and message.position_covariance_type == 0
    assert all(map(math.isnan, (message.latitude, message.longitude, message.altitude)))
    velocity = ros(topics.TWIST)[1](writer.velocity(FIX))
    assert velocity.header.frame_id == 'enu' and velocity.twist.twist.linear.y == -70.1
    assert np.array_equal(np.diag(np.reshape(velocity.twist.covariance, (6, 6))),
                          [0.05 * 0.05, 0.06 * 0.06, 0.1 * 0.1, 1e9, 1e9, 1e9])
    small = (1e-6, 0.0, 0.0, 0.0, 1e-6, 0.0, 0.0, 0.0, 1e-6)
    known = (4.0, 1.0, 0.0, 1.0, 4.0, 0.0, 0.0, 0.0, 9.0)
    for topic, run, covariance, kind in ((topics.TRUTH_FIX, (), small, b'\x02'),
                                         (topics.INS_FIX, (known,), known, b'\x03')):
        data = topic.writer().pack(3, (1.0, 2.0, 3.0), *run)
        assert data == (b'\x00\x01\x00\x00' + struct.pack('<iI', 0, 3) + b'\x0a\x00\x00\x00'
                        b'base_link\x00' + bytes(10)
                        + struct.pack('<12d', 1.0, 2.0, 3.0, *covariance) + kind)


@pytest.mark.parametrize('frame', ['', 'm', 'ab', 'map', 'gnss_link'])
def test_the_numbers_of_a_fix(frame):
    """The values of a fix are read back for any frame: from us, rosbags, and blocks."""
    writer = Writer(topics.FIX, frame, numbers=(-1, 5, 2))
    data = writer.pack(1, (1.0, 2.0, 3.0))
    again = bytes(store().serialize_cdr(store().deserialize_cdr(data, topics.FIX), topics.FIX))
    assert again == data
    assert Reader(topics.FIX).numbers(data) == (-1, 5, 2)
    block = writer.block([1, 2], np.array([[1.0, 2.0, 3.0]] * 2))
    assert block['status'].tolist() == [-1, -1]
    block['status'][1], block['position_covariance_type'][1] = 2, 1
    assert block[0].tobytes() == data
    assert Reader(topics.FIX).numbers(block[1].tobytes()) == (2, 5, 1)
    with pytest.raises(ValueError, match='expected'):
        Reader(topics.FIX).numbers(data[:-1])


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_bags_keep_them(storage, tmp_path):
    """A bag returns records, fixes with status and covariance, and velocities as columns."""
    writer = GnssWriter(EPOCH)
    none = no_gnss_fix(8 * SECOND, OUTAGE, 8 * SECOND)
    data = {topics.METER_RECORD: [velocity_record.pack_fix(f, EPOCH) for f in (WINDOW, NO_WINDOW)],
            topics.GNSS_FIX: [writer.fix(FIX), writer.fix(none)],
            topics.GNSS_VELOCITY: [writer.velocity(FIX)]}
    with BagWriter(tmp_path / 'bag', storage) as bag:
        for topic, messages in data.items():
            bag.add_topic(topic.name, topic.type_name)
            for message in messages:
                bag.write(topic.name, EPOCH, message)
    with open_bag(tmp_path / 'bag') as bag:
        kept = [bytes(m) for name, _, m in bag.messages() if name.endswith('record')]
        assert [repr(velocity_record.read_fix(m, EPOCH)) for m in kept] == [
            repr(WINDOW), repr(NO_WINDOW)]
        fix, velocity = bag.arrays('gnss/fix'), bag.arrays('gnss/velocity')
    assert fix['status'].tolist() == [0, -1]
    assert fix['position_covariance_type'].tolist() == [2, 0]
    assert np.isnan(fix['latitude']).tolist() == [False, True]
    assert fix['position_covariance'][0, 4] == 1.7 * 1.7
    assert velocity['linear'].tolist() == [[120.0, -70.1, 0.3]]
    assert velocity['twist_covariance'][0, 14] == 0.1 * 0.1


@pytest.mark.parametrize('variance', [0.0, -1.0, math.nan])
def test_a_variance_that_is_none_is_refused_by_the_navigator(variance):
    """A fix with a variance of zero or less is read, and dropped with one message."""
    reader = GnssPairs(EPOCH, 0)
    stamp, place = 7 * SECOND + EPOCH, (55.0, 37.0, 100.0)
    # Packed like other receivers do: our own writer refuses values that are not finite.
    reader.push_fix(*topics.GNSS_FIX.writer().pack_block(
        [stamp], np.array([[*place, *(variance,) * 3]])))
    fix, = reader.push_velocity(topics.GNSS_VELOCITY.writer().pack(
        stamp, (1.0, 2.0, 3.0), *((1.0,),) * 3))
    with pytest.raises(StreamFault, match='gnss: fix at 7.000000000 s has standard deviations of '
                                          'position .* expected positive ones; it was dropped'):
        check_gnss(fix)


def test_the_bound_of_a_velocity_is_that_of_its_norm():
    """Each component of the velocity is below 1e5 m/s; a norm beyond it is refused."""
    check_gnss(replace(FIX, v_n=(5e4, 5e4, 5e4)))
    with pytest.raises(StreamFault, match='has a velocity of .* expected less than 100000;'):
        check_gnss(replace(FIX, v_n=(7e4, 7e4, 7e4)))
