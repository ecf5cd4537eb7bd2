"""The command navigate on odd recordings: a correct result, or the parameter that accepts them."""

from dataclasses import replace
import json

import numpy as np
import pytest
from support.readings.imu_records import resting
from support.recordings import FIX, fix_messages, IMU, imu_messages, message, TF, tf_messages, \
    write_bag

from ins_sim.cli.main import main

GIVEN = ('initial.position:=given', 'initial.latitude_deg:=55.0')
HEADED = ('initial.heading:=given', 'initial.heading_deg:=30.0', 'alignment.longest_s:=6.0')
T_NS = np.arange(1000) * 20_000_000 + 1_700_000_000_000_000_000
FORCE = np.tile([0.0, 0.0, 9.8], (1000, 1))
NOISE = 1e-3 * np.random.default_rng(1).standard_normal((2, 1000, 3))


def at_rest(f=FORCE + NOISE[0], omega=NOISE[1], t_ns=T_NS, **changes):
    """Return IMU messages of a sensor at rest."""
    return imu_messages(t_ns, omega, f, **changes)


@pytest.fixture
def navigated(tmp_path, capsys):
    """Return a function that runs navigate on topics and returns exit code and messages."""
    def run(topics, *assignments):
        path = tmp_path / 'bag'
        if not path.exists():
            write_bag(path, topics)
        words = [word for a in assignments for word in ('-p', a)]
        code = main(['navigate', str(path), '-o', str(tmp_path / 'out'), '--force', *words])
        said = capsys.readouterr()
        if code:
            assert code == 2 and said.err.count('\n') == 1
            return said.err
        return json.loads((tmp_path / 'out' / 'summary.json').read_text())
    return run


def notes_of(summary):
    return '; '.join(summary['notes'])


# Fixes without a valid position.

def fixes(**changes):
    """Return 20 s of fixes at 1 Hz at 55 N 37 E."""
    values = dict(lat=np.full(20, np.radians(55.0)), lon=np.full(20, np.radians(37.0)),
                  height=np.full(20, 150.0))
    for name, (rows, value) in changes.items():
        values[name][rows] = value
    return fix_messages(T_NS[::50], **values)


def with_status(messages, rows, status):
    for k in rows:
        t_ns, content = messages[k]
        messages[k] = t_ns, replace(content, status=message(
            'sensor_msgs/msg/NavSatStatus', status=status, service=1))
    return messages


BAD_FIXES = {
    'before the first good one': (fixes(lat=(slice(5), 0.0), lon=(slice(5), 0.0)),
                                  '5 of 20 fixes dropped: 5 at latitude 0, longitude 0'),
    'amid good ones': (fixes(lat=(slice(3, 9, 2), 0.0), lon=(slice(3, 9, 2), 0.0)),
                       '3 of 20 fixes dropped: 3 at latitude 0, longitude 0'),
    'no altitude': (fixes(height=(slice(5), np.nan)),
                    '5 of 20 fixes dropped: 5 whose height is not a number'),
    'no latitude': (fixes(lat=(slice(5), np.nan)), '5 whose latitude or longitude is not a'),
    'beyond the pole': (fixes(lat=(slice(2), 2.0)), '2 outside the range of latitude, longitude '
                        'or height'),
    'unknown': (with_status(fixes(), range(4), -2), '4 of unknown status'),
    'no fix': (with_status(fixes(), range(7), -1), '7 without a fix by their status')}


@pytest.mark.parametrize('case', BAD_FIXES)
def test_fixes_that_are_no_position_are_dropped_with_a_count_and_a_reason(case, navigated):
    """Invalid fixes are dropped with a count and a reason; the start is that of valid ones."""
    messages, sentence = BAD_FIXES[case]
    got = navigated({('/imu', IMU): at_rest(), ('/fix', FIX): messages}, *HEADED)
    assert sentence in notes_of(got)
    rows = got['errors']['/fix']
    assert all(row['horizontal_m'] < 100.0 for row in rows)


@pytest.mark.parametrize('messages, sentence', [
    (fixes(height=(slice(None), np.nan)), '/fix: 20 of 20 fixes dropped: 20 whose height is not'),
    (with_status(fixes(), range(20), -2), '/fix: 20 of 20 fixes dropped: 20 of unknown status'),
    ([], '/fix has no message')])
def test_a_topic_without_a_usable_fix_says_why(messages, sentence, navigated):
    """The message states why no fix is usable, and not that there is no NavSatFix."""
    said = navigated({('/imu', IMU): at_rest(), ('/fix', FIX): messages})
    assert f'the latitude is unknown, because {sentence}' in said
    assert 'no NavSatFix' not in said


def test_fixes_at_zero_can_be_meant(navigated):
    """Fixes at latitude and longitude zero are dropped unless accept.zero_fixes is set."""
    bag = {('/imu', IMU): at_rest(),
           ('/fix', FIX): fixes(lat=(slice(None), 0.0), lon=(slice(None), 0.0))}
    assert 'accept.zero_fixes keeps them' in navigated(bag, *HEADED)
    assert navigated(bag, *HEADED, 'accept.zero_fixes:=true')['errors']['/fix']


# Tests of gravity.

@pytest.mark.parametrize('f, sentence', [
    (FORCE / 9.8, 'mean specific force at rest is 1.0 m/s^2; expected 9.8: is it in g? (units.'),
    (-FORCE / 9.8, 'mean specific force at rest is 1.0 m/s^2; expected 9.8: is it in g?'),
    (FORCE * 1000.0 / 9.8, 'is 1000.0 m/s^2; expected 9.8: is it in mg? (units.force:=mg'),
    (FORCE * 0.0, 'is 0.0 m/s^2; expected 9.8: was gravity removed? (the allowed difference is '),
    (FORCE * 3.0, 'mean specific force at rest is 29.4 m/s^2; expected 9.8 (the allowed')])
@pytest.mark.parametrize('start', [HEADED, ('initial.attitude:=given', 'initial.velocity:=given'),
                                   (*HEADED, 'mounting.source:=level')])
def test_the_mean_specific_force_at_rest_is_judged(f, sentence, start, navigated):
    """For any start an IMU at rest must measure gravity; if not, the message states a cause."""
    assert sentence in navigated({('/imu', IMU): at_rest(f + 1e-4 * NOISE[0])}, *GIVEN, *start)


def test_a_force_in_g_or_without_gravity_can_be_navigated(navigated):
    """units.force converts a force in g; alignment.gravity_m_s2 accepts it unchanged."""
    bag = {('/imu', IMU): at_rest(-FORCE / 9.8 + 1e-4 * NOISE[0])}
    got = navigated(bag, *GIVEN, *HEADED, 'units.force:=g')
    assert 'does the IMU measure gravity instead of specific force' in notes_of(got)
    assert abs(got['figures']['gravity_excess_m_s2']) < 0.03
    assert navigated(bag, *GIVEN, *HEADED, 'alignment.gravity_m_s2:=1e3')['figures']
    assert abs(abs(got['figures']['roll_deg']) - 180.0) < 0.1


# Tests of transforms.

@pytest.mark.parametrize('q, said', [((0.0, 0.0, 0.0, 0.0), '(0, 0, 0, 0)'),
                                     ((np.nan, 0.0, 0.0, 1.0), '(nan, 0, 0, 1)'),
                                     ((0.0, 0.0, np.inf, 1.0), '(0, 0, inf, 1)')])
def test_a_transform_that_is_no_rotation_is_refused_by_name(q, said, navigated):
    """
    A transform that is no rotation is refused by name; mounting.source given avoids it.

    Only transforms between the two frames are checked.
    """
    bag = {('/imu', IMU): at_rest(), ('/tf_static', TF): tf_messages(T_NS[0], {
        ('base_link', 'mast'): (0.0, 0.0, 0.0, 1.0), ('mast', 'imu_link'): q})}
    assert f'/tf_static from mast to imu_link has the rotation {said}, which is not a ' in \
        navigated(bag, *GIVEN, *HEADED)
    given = navigated(bag, *GIVEN, *HEADED, 'mounting.source:=given')
    assert given['figures']['mounting_xyzw'] == [0.0, 0.0, 0.0, 1.0]


def test_a_transform_of_another_length_is_normalised_and_said(navigated):
    """A quaternion of length 3 is normalised with a note; invalid ones elsewhere do no harm."""
    got = navigated({('/imu', IMU): at_rest(), ('/tf_static', TF): tf_messages(T_NS[0], {
        ('base_link', 'imu_link'): (0.0, 0.0, 3.0, 0.0),
        ('base_link', 'camera'): (0.0, 0.0, 0.0, 0.0)})}, *GIVEN, *HEADED)
    assert got['figures']['mounting_xyzw'] == [0.0, 0.0, 1.0, 0.0]
    assert 'from base_link to imu_link has a quaternion of length 3: normalised' in notes_of(got)
    assert got['figures']['gravity_excess_m_s2'] == pytest.approx(-0.015, abs=1e-3)


# Tests of messages.

def changed(messages, **values):
    """Return messages with some fields changed; each value is a function of the message number."""
    return [(t, replace(content, **{name: value(k) for name, value in values.items()}))
            for k, (t, content) in enumerate(messages)]


MINUS_ONE = np.array([-1.0] + [0.0] * 8)


def test_a_covariance_of_minus_one_beside_data_can_be_passed(navigated):
    """
    Data marked as absent by a covariance of -1 are used if accept.unmeasured is set.

    The message states that there are numbers, and names the parameter.
    """
    bag = {('/imu', IMU): changed(at_rest(), linear_acceleration_covariance=lambda k: MINUS_ONE)}
    said = navigated(bag, *GIVEN, *HEADED)
    assert '1000 messages have no linear_acceleration; expected both; the fields contain ' \
        'numbers all the same, which accept.unmeasured:=true accepts' in said
    assert 'their numbers are used all the same' in notes_of(
        navigated(bag, *GIVEN, *HEADED, 'accept.unmeasured:=true'))


def test_a_first_frame_that_differs_can_be_passed(navigated):
    """If messages have two frames, accept.frames accepts all as the more frequent one."""
    bag = {('/imu', IMU): at_rest()[3:] + at_rest(frame='')[:3]}
    assert "'imu_link' (997 messages), '' (3 messages); expected one IMU on a topic (accept." \
        in navigated(bag, *GIVEN, *HEADED)
    assert "all treated as 'imu_link'" in notes_of(navigated(bag, *GIVEN, *HEADED,
                                                             'accept.frames:=true'))


def test_orientations_of_another_length_can_be_taken(navigated):
    """A quaternion of length 1.273 is reported, and normalised if accept.orientations is set."""
    bag = {('/imu', IMU): at_rest(q=np.tile([0.0, 0.0, 0.9, 0.9], (1000, 1)))}
    start = (*GIVEN, 'initial.attitude:=imu', 'initial.velocity:=given')
    assert '1000 orientations are not rotations, the first at 1700000000.000000000 s has the ' \
        'norm 1.273: not used (accept.orientations:=true' in navigated(bag, *start)
    assert 'has the norm 1.273: normalised' in notes_of(
        navigated(bag, *start, 'accept.orientations:=true'))


def test_a_reading_beyond_any_sensor_is_dropped_and_said(navigated):
    """Readings of 3.2e6 m/s^2 and 2e4 rad/s are dropped and reported."""
    f, omega = FORCE.copy(), NOISE[1].copy()
    f[500, 0], omega[700, 2] = 3.2e6, -2e4
    got = navigated({('/imu', IMU): at_rest(f, omega)}, *GIVEN, *HEADED)
    assert '1 readings of the specific force beyond 1e+06 m/s^2 dropped, the first at ' \
        '1700000010.000000000 s: 3.2e+06 m/s^2' in notes_of(got)
    assert '1 readings of the angular rate beyond 10000 rad/s dropped' in notes_of(got)
    assert got['figures']['samples'] == 998


def test_readings_that_are_zero_in_turns_are_recognised(navigated):
    """Alternating zeros of rate and force are recognised; accept.zero_readings fills them."""
    f, omega = FORCE + NOISE[0], NOISE[1].copy()
    f[1::2], omega[::2] = 0.0, 0.0
    bag = {('/imu', IMU): at_rest(f, omega)}
    assert 'the specific force is exactly zero in 500 of 1000 samples and the angular rate in ' \
        '500 others: the driver seems to send them alternately' in navigated(bag, *GIVEN, *HEADED)
    got = navigated(bag, *GIVEN, *HEADED, 'accept.zero_readings:=fill')
    assert 'interpolated linearly between their neighbours' in notes_of(got)
    assert abs(got['figures']['gravity_excess_m_s2'] + 0.015) < 1e-3


# Tests of stamps.

def test_one_stamp_in_all_messages_is_named_and_the_log_time_offered(navigated):
    """999 repeated stamps are not counted as out of order; the log time is proposed."""
    bag = {('/imu', IMU): at_rest(stamps=np.full(1000, 5))}
    said = navigated(bag, *GIVEN, *HEADED)
    assert '0 out of order, and 999 with the stamp of the one before, 0.000000005 s' in said
    assert 'stamps.source log uses the log times' in said
    for ways in (('stamps.source:=log',), ('stamps.source:=even', 'stamps.rate_hz:=50.0')):
        assert navigated(bag, *GIVEN, *HEADED, *ways)['figures']['step_ms'] == 20.0


def test_repeated_stamps_are_dropped_or_spread(navigated):
    """Stamps rounded to 40 ms at 50 Hz are dropped, or spread if stamps.on_repeat is spread."""
    bag = {('/imu', IMU): at_rest(stamps=T_NS // 40_000_000 * 40_000_000)}
    got = navigated(bag, *GIVEN, *HEADED)
    assert (got['figures']['repeated'], got['figures']['out_of_order']) == (500, 0)
    got = navigated(bag, *GIVEN, *HEADED, 'stamps.on_repeat:=spread')
    assert got['figures']['repeated'] == 0 and got['figures']['step_ms'] == 20.0
    assert '500 repeated stamps are spread up to the next one' in notes_of(got)


def test_stamps_that_go_back_say_where_and_offer_the_log_time(navigated):
    """
    Stamps that jump back by 1 s are reported with the sample, and the log time is proposed.

    Five samples of every second have a stamp that is one second too early.
    """
    stamps = T_NS - np.where(T_NS % 10 ** 9 < 100_000_000, 10 ** 9, 0)
    bag = {('/imu', IMU): at_rest(stamps=stamps)}
    said = navigated(bag, *GIVEN, *HEADED)
    assert '; expected a longer recording or a shorter alignment' in said
    assert 'out of order (the first by 0.98 s after 17' in said
    assert 'stamps.source:=log uses the log times instead' in said
    assert navigated(bag, *GIVEN, *HEADED, 'stamps.source:=log')['figures']['out_of_order'] == 0


def test_nanoseconds_of_more_than_a_second_are_named(navigated):
    """A nanosec field of 1e9 or more is added to the seconds, with a note."""
    def late(content):
        stamp = content.header.stamp
        if stamp.sec % 2 == 0:
            return content.header
        return replace(content.header, stamp=replace(stamp, sec=stamp.sec - 1,
                                                     nanosec=stamp.nanosec + 10 ** 9))
    bag = {('/imu', IMU): [(t, replace(content, header=late(content)))
                           for t, content in at_rest()]}
    got = navigated(bag, *GIVEN, *HEADED)
    assert '500 stamps have nanosec >= 1e9, which is added to their seconds' in notes_of(got)
    assert got['figures']['step_ms'] == 20.0 and got['figures']['gaps'] == 0


def test_what_was_found_on_the_way_is_said_with_a_refusal(navigated):
    """The refusal of a record that the alignment uses up lists what was found before."""
    said = navigated({('/imu', IMU): resting()}, *GIVEN, 'initial.heading:=given')
    assert 'fewer than 10 samples after the start at 19.980000000 s' in said
    assert 'Notes: 1000 samples of bag /imu in 19.980 s' in said
    assert 'stationary from 0.000000000 s for 19.980 s' in said


def test_a_bag_of_ros_1_is_named(tmp_path, capsys):
    """A bag of ROS 1 is refused with a message that names ROS 1, without a traceback."""
    (tmp_path / 'run.bag').write_bytes(b'#ROSBAG V2.0\n' + bytes(100))
    for words in (['info'], ['navigate', '-o', str(tmp_path / 'out')]):
        assert main([words[0], str(tmp_path / 'run.bag'), *words[1:]]) == 2
        error = capsys.readouterr().err
        assert 'run.bag is a bag of ROS 1; expected a rosbag2 bag' in error
