"""Positions anywhere on Earth: origin of the map frame, and longitudes at the 180th meridian."""

import math

import numpy as np
import pytest
from support.studies import FLIGHT, settings
from support.bags.truth_bags import record, recorded

from ins_sim.bags.bag_reader import open_bag
from ins_sim.cli.main import main
from ins_sim.core.earth import ellipsoid
from ins_sim.core.timeseries.fixes import GnssFix
from ins_sim.io.csv_flight import read_poses
from ins_sim.io.motion import read_motion
from ins_sim.messages import topics
from ins_sim.messages.convert import fix_one
from ins_sim.messages.gnss_fixes import GnssPairs, GnssWriter

SECOND = 1_000_000_000


def flown(path, latitude, longitude, *names):
    """Write a bag with 20 s of racetrack from a position; names: topics, by default all."""
    words = [f'datum.latitude_deg:={latitude}', f'datum.longitude_deg:={longitude}',
             'motion.kind:=racetrack', 'duration_s:=20.0', 'rate_hz:=20.0']
    given = [word for a in words for word in ('-p', a)]
    chosen = ['--topics', *names] if names else []
    assert main(['simulate', *given, '-o', str(path) + '_run', '--bag', str(path), *chosen]) == 0


def apart_m(poses, latitude, longitude):
    """Return the distance of the first pose from the start of the racetrack, m."""
    east, north, up = ellipsoid.offset(
        math.radians(latitude), math.radians(longitude), 6000.0,
        (math.radians(poses.lat_deg[0]), math.radians(poses.lon_deg[0]), poses.height_m[0]))
    return math.hypot(east, north, up)


@pytest.mark.parametrize('others', ([], ['truth/odometry', 'truth/fix']))
def test_the_solution_of_a_flight_at_55_n_37_e_lands_where_it_was(others, tmp_path, capsys):
    """
    A converted solution has its position; the origin is found from a fix in the bag.

    The default datum would be 90 km off.
    """
    names = others or ['ins/fix']
    flown(tmp_path / 'bag', 55.0, 37.0, 'ins/odometry', *names)
    target = tmp_path / 'flight.csv'
    assert main(['convert', str(tmp_path / 'bag'), str(target), '--topic', 'ins/odometry']) == 0
    said = capsys.readouterr().out
    assert 'origin of the frame of /ins/odometry is at 55, 37 deg' in said
    assert ('computed from /truth/fix' if others else 'computed from /ins/fix') in said
    # The solution starts at the truth; only rounding of 1e-9 m is in between.
    assert apart_m(read_poses(target), 55.0, 37.0) < 1e-6


def test_no_datum_is_assumed(tmp_path, capsys):
    """Without a fix the origin must be given; it is then used, with a note."""
    flown(tmp_path / 'bag', 55.0, 37.0, 'ins/odometry')
    words = ['convert', str(tmp_path / 'bag'), str(tmp_path / 'x.csv'), '--topic', 'ins/odometry']
    capsys.readouterr()
    assert main(words) == 2
    assert ('has no NavSatFix for /ins/odometry, so the origin of its frame is unknown; '
            'expected datum.latitude_deg') in capsys.readouterr().err
    assert not (tmp_path / 'x.csv').exists()
    given = ['-p', 'datum.latitude_deg:=55.0', '-p', 'datum.longitude_deg:=37.0']
    assert main([*words, *given]) == 0
    assert 'assumed at the given datum, 55, 37 deg, 0 m' in capsys.readouterr().out
    assert apart_m(read_poses(tmp_path / 'x.csv'), 55.0, 37.0) < 1e-6


def test_the_default_datum_can_be_meant(tmp_path, capsys):
    """motion.recording.origin datum uses the datum, even if a fix shows another position."""
    flown(tmp_path / 'bag', 55.75, 37.62, 'ins/odometry')
    flown(tmp_path / 'other', 55.0, 37.0)
    origin = ['-p', 'motion.recording.origin:=datum']
    for name, topic in (('bag', 'ins'), ('other', 'ins'), ('other', 'truth')):
        capsys.readouterr()
        target = tmp_path / f'{name}_{topic}.csv'
        assert main(['convert', str(tmp_path / name), str(target), '--topic',
                     f'{topic}/odometry', *origin]) == 0
        assert 'assumed at the given datum, 55.75, 37.62 deg, 0 m' in capsys.readouterr().out
        assert apart_m(read_poses(target), 55.75, 37.62) < 1e-6


def test_a_flight_in_degrees_has_no_origin(tmp_path):
    """motion.recording.origin is refused for a CSV file, for which it would be ignored."""
    (tmp_path / 'x.csv').write_text('t_s\n')
    values = {'motion.recording.origin': 'datum'}
    with pytest.raises(ValueError, match='origin is datum, but .*x.csv is not a bag; expected'):
        read_motion(recorded(tmp_path / 'x.csv', {}, **values).motion_generator)


def test_an_origin_that_wanders_is_refused(tmp_path):
    """A fix that moves the origin by 111 m during the flight is refused."""
    def shifted(window):
        window[topics.TRUTH_FIX][1][-1, 0] += 1e-3

    record(tmp_path / 'bag', FLIGHT, 10.0, only=(topics.TRUTH_ODOMETRY, topics.TRUTH_FIX),
           change=shifted)
    with pytest.raises(ValueError, match='give origins of the map frame that are 111 m apart'):
        read_motion(recorded(tmp_path / 'bag', {}).motion_generator)


@pytest.mark.parametrize('longitude', (179.999, -179.999))
def test_a_flight_over_the_180th_meridian_is_read_again(longitude, tmp_path, capsys):
    """Over the 180th meridian, either way, longitudes stay in +-180 deg and are read back."""
    flown(tmp_path / 'bag', 60.0, longitude)
    with open_bag(tmp_path / 'bag') as bag:
        for name in ('/truth/fix', '/ins/fix'):
            degrees = bag.arrays(name, ('longitude',))['longitude']
            assert np.abs(degrees).max() <= 180.0
            # The racetrack starts northwards and turns to the east.
            assert (degrees.min() < 0.0 < degrees.max()) == (longitude > 0.0)
    values = {'motion.kind': 'racetrack', 'datum.latitude_deg': 60.0,
              'datum.longitude_deg': longitude}
    t_ns = np.arange(0, 14 * SECOND, SECOND // 7)
    x = read_motion(recorded(tmp_path / 'bag', values).motion_generator).at(t_ns)
    y = read_motion(settings(values).motion_generator).at(t_ns + 3 * SECOND)
    east, north, _ = ellipsoid.offset(y.lat, y.lon, y.height, (x.lat, x.lon, x.height))
    # Splines of degree 5 through 20 Hz; degrees with 16 digits are 1e-9 m.
    assert max(np.abs(east).max(), np.abs(north).max()) < 1e-6
    assert np.abs(x.v_n - y.v_n).max() < 1e-5
    capsys.readouterr()


def westwards(path):
    """Write a bag of truth that crosses the 180th meridian westwards; return its settings."""
    values = {'motion.kind': 'route', 'motion.route.points.latitude_deg': (60.0, 60.0),
              'motion.route.points.longitude_deg': (-179.99, 179.0)}
    record(path, values, 20.0)
    return recorded(path, values)


def test_a_flight_west_over_the_180th_meridian(tmp_path):
    """Where the published longitude jumps from -180 to 180 deg the motion is continuous."""
    chosen = westwards(tmp_path / 'bag')
    with open_bag(tmp_path / 'bag') as bag:
        degrees = bag.arrays('/truth/fix', ('longitude',))['longitude']
    assert degrees.min() < -179.9 and degrees.max() > 179.9 and np.abs(degrees).max() <= 180.0
    truth = read_motion(chosen.motion_generator).at(np.arange(0, 14 * SECOND, SECOND))
    assert np.abs(np.diff(truth.lon)).max() < 1e-4


def test_the_180th_meridian_in_single_messages():
    """Fixes beyond +-180 deg are published within these limits, also those of GNSS."""
    assert fix_one((0.0, math.radians(190.0), 5.0)) == pytest.approx((0.0, -170.0, 5.0))
    assert fix_one((0.0, math.radians(-190.0), 5.0)) == pytest.approx((0.0, 170.0, 5.0))
    assert fix_one((0.0, math.pi, 5.0))[1] == 180.0
    writer, pairs = GnssWriter(0), GnssPairs(0, 0)
    fix = GnssFix(SECOND, 0.5, math.radians(181.0), 10.0, (0.0, 0.0, 0.0), (1.0,) * 3, (0.1,) * 3,
                  arrival_ns=SECOND)
    assert pairs.push_velocity(writer.velocity(fix)) == []
    again, = pairs.push_fix(writer.fix(fix))
    assert math.degrees(again.lon) == pytest.approx(-179.0)
