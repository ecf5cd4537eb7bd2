"""The command convert: round trips lose only rounding, and invalid input gives one message."""

import gzip
import json
import math

import numpy as np
import pytest
from support.studies import settings
from support.bags.truth_bags import record

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.cli.main import main
from ins_sim.io import csv_imu, csv_writer
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.motion.recorded.spline import RecordedMotion
from ins_sim.io.csv_flight import read_poses, read_rows, COLUMNS
from ins_sim.core.motion.recorded.quality import rounding_noise
from ins_sim.settings.place import Earth
from ins_sim.settings.motion import Recording
from ins_sim.messages import topics

SECOND = 1_000_000_000
FLIGHT = {'motion.kind': 'aggressive', 'datum.longitude_deg': 179.99}


def convert(*words):
    """Return the exit code of the command."""
    return main(['convert', *map(str, words)])


@pytest.mark.parametrize('name', ['flight.csv', 'flight.csv.gz'])
@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_truth_to_csv_to_bag_to_csv(name, storage, tmp_path, capsys):
    """
    The bag contains the values of the CSV file: positions to the bit, angles to rounding.

    Angles and quaternion are converted within 16 roundings of 2^-53. The second bag is made from
    the spline through the first: its positions are those of the samples to one rounding of 180 deg
    (2.9e-14) and of 1e4 m. At its samples a cubic spline errs by h^4 / 180 of the fifth derivative
    in the rate, of 25, 6, 5 deg at 1/7, 1/5, 1/6 Hz, twice for the products of the angles; the
    force has six standard deviations of two roundings of the longitude.
    """
    motion = record(tmp_path / 'bag', FLIGHT, 20.0)
    flight, second, last = tmp_path / name, tmp_path / 'second', tmp_path / f'last_{name}'
    assert convert(tmp_path / 'bag', flight) == 0
    assert '2001 rows of /truth/odometry' in capsys.readouterr().out
    rows = read_rows(flight)
    truth = motion.at(rows.t_ns)
    with open_bag(tmp_path / 'bag') as bag:
        fix, attitude = bag.arrays('truth/fix'), bag.arrays('truth/attitude')
    assert np.array_equal(rows.t_ns, fix['stamp_ns'])
    assert np.array_equal(rows.lat_deg, fix['latitude'])
    assert np.array_equal(rows.height_m, fix['altitude'])
    # Longitudes in the file jump by 360 deg at the date line; the reader removes the jump.
    assert np.abs(rows.lon_deg - np.degrees(truth.lon)).max() < 3e-14
    poses = csv_imu.read_reference(flight)[0]
    q = poses.attitude.values
    q *= np.sign((q * attitude['quaternion']).sum(1))[:, None]
    assert np.abs(q - attitude['quaternion']).max() < 16.0 * 2.0 ** -53
    assert np.abs(poses.velocity.values - truth.v_n).max() < 1e-12

    assert convert(flight, second, '--storage', storage, '-p', 'datum.longitude_deg:=179.99') == 0
    assert 'written' in capsys.readouterr().out
    with open_bag(second) as bag:
        assert bag.storage == storage
        again, imu = bag.arrays('truth/fix'), bag.arrays('truth/imu')
    assert np.array_equal(again['stamp_ns'], fix['stamp_ns'])
    assert np.abs(again['latitude'] - fix['latitude']).max() < 3e-14
    assert np.abs(again['altitude'] - fix['altitude']).max() < 1e-11
    inner = slice(300, -300)
    rate = np.abs(imu['angular_velocity'] - truth.omega_ib_b)[inner].max()
    force = np.abs(imu['linear_acceleration'] - truth.f_ib_b)[inner].max()
    most_rate = 2.0 * 0.01 ** 4 / 180.0 * sum(
        math.radians(a) * (2.0 * math.pi * f) ** 5
        for a, f in ((25.0, 1 / 7), (6.0, 1 / 5), (5.0, 1 / 6)))
    most_force = 6.0 * math.sqrt(2.0) * rounding_noise(
        (0.0, 2.0 ** -45, 0.0), truth.lat[0], 5000.0, 0.01, 0.0)[0]
    print(f'\nimu of the spline: {rate:.1e} rad/s ({most_rate:.1e}), {force:.1e} m/s^2 '
          f'({most_force:.1e})')
    assert rate < most_rate and force < most_force

    assert convert(second, last) == 0
    assert np.abs(read_rows(last).lat_deg - rows.lat_deg).max() < 3e-14
    assert (last.read_bytes()[:2] == b'\x1f\x8b') == name.endswith('.gz')


def test_a_recorded_flight_becomes_a_bag_at_a_rate(shared_data, tmp_path, capsys):
    """
    A real flight at its own 50 Hz: every row comes back, angles and positions to rounding.

    Flown from the bag and from the file, the poses agree to rounding.
    """
    flight = shared_data / 'flights' / 'uavcircuit_umn_thor_fl75.csv.gz'
    bag, back = tmp_path / 'bag', tmp_path / 'back.csv'
    assert convert(flight, bag, '-p', 'rate_hz:=50.0', '-p', 'time.epoch_s:=1000') == 0
    told = capsys.readouterr().out
    assert 'messages on truth/imu' in told and 'differentiated twice' in told
    assert convert(bag, back) == 0
    a, b = read_rows(flight), read_rows(back)
    at = np.searchsorted(a.t_ns, b.t_ns - 1000 * SECOND)
    same = a.t_ns[np.minimum(at, len(a.t_ns) - 1)] == b.t_ns - 1000 * SECOND
    assert same.mean() > 0.9
    for field, bound in (('lat_deg', 3e-14), ('lon_deg', 3e-14), ('height_m', 1e-11),
                         ('roll_deg', 1e-11), ('pitch_deg', 1e-11), ('heading_deg', 1e-11)):
        off = (getattr(b, field)[same] - getattr(a, field)[at[same]] + 180.0) % 360.0 - 180.0
        assert np.abs(off).max() < bound


def imu_of(n=5000):
    """Return a RecordedImu at an epoch, with a value that has no short decimal form."""
    rng = np.random.default_rng(1)
    return RecordedImu(1_432_235_498_000_000_001 + np.arange(n) * 10_000_019,
                       rng.standard_normal((n, 3)) / 3.0, 9.8 + rng.standard_normal((n, 3)) * 1e-9,
                       np.full((n, 4), np.nan))


@pytest.mark.parametrize('name', ['imu.csv', 'imu.csv.gz'])
def test_imu_to_bag_and_back_is_the_same_to_the_bit(name, tmp_path, capsys):
    """Stamps to the nanosecond and all samples, in several windows, are equal to the bit."""
    imu, path = imu_of(), tmp_path / name
    imu.omega[7, 1] = np.nan
    csv_writer.write_imu(path, imu)
    assert convert(path, tmp_path / 'bag', '--topic', 'left/imu', '--compression', 'zstd') == 0
    assert '5000 messages on left/imu' in capsys.readouterr().out
    assert convert(tmp_path / 'bag', tmp_path / f'back_{name}') == 0
    assert '5000 samples of /left/imu' in capsys.readouterr().out
    assert (tmp_path / f'back_{name}').read_bytes() == path.read_bytes()
    back, _ = csv_imu.read_imu(path)
    assert np.array_equal(back.t_ns, imu.t_ns)
    assert np.array_equal(back.omega, imu.omega, equal_nan=True)
    assert np.array_equal(back.f, imu.f)


def test_the_imu_of_a_run_navigates_from_csv_as_from_the_bag(tmp_path, capsys):
    """A CSV file and a bag with the same samples give the same solution to the bit."""
    given = ['motion.kind:=static', 'duration_s:=60.0', 'output:=integrated',
             'input:=integrated']
    words = [word for a in given for word in ('-p', a)]
    assert main(['simulate', *words, '-o', str(tmp_path / 'run'), '--bag',
                 str(tmp_path / 'bag')]) == 0
    assert convert(tmp_path / 'bag', tmp_path / 'imu.csv', '--topic', 'imu/data_raw') == 0
    begin = ['-p', 'input:=integrated', '-p', 'initial.position:=given', '-p',
             'topic:=imu/data_raw', '-p', 'initial.latitude_deg:=55.75', '-p',
             'alignment.longest_s:=20.0', '-p', 'reference.fix:=none', '-p',
             'reference.odometry:=none', '-p', 'alignment.gyro_bias_sigma_deg_h:=0.0']
    ends = []
    for k, source in enumerate(('bag', 'imu.csv')):
        assert main(['navigate', str(tmp_path / source), '-o', str(tmp_path / f'out{k}'),
                     *begin]) == 0
        with np.load(tmp_path / f'out{k}' / 'nav.npz') as arrays:
            ends.append(arrays['states_lat'])
    assert np.array_equal(*ends)
    assert json.loads((tmp_path / 'out1' / 'summary.json').read_text())
    capsys.readouterr()


def test_a_flight_of_the_bag_is_the_flight_of_the_csv(tmp_path, capsys):
    """Motion time zero is kept: start_s counts from the first row of either file."""
    record(tmp_path / 'bag', FLIGHT, 20.0)
    assert convert(tmp_path / 'bag', tmp_path / 'flight.csv') == 0
    capsys.readouterr()
    chosen = settings({**FLIGHT, 'motion.kind': 'recording', 'motion.recording.path':
                       str(tmp_path / 'bag')}).motion_generator
    from ins_sim.io.motion import read_motion
    t_ns = np.arange(0, 14 * SECOND, SECOND // 13)
    x = read_motion(chosen).at(t_ns)
    y = RecordedMotion(read_poses(tmp_path / 'flight.csv'),
                       Recording(path=str(tmp_path / 'flight.csv')), Earth()).at(t_ns)
    assert np.abs(x.lat - y.lat).max() < 1e-15 and np.abs(x.v_n - y.v_n).max() < 1e-6
    # Both cubics err by h^4 / 384.
    assert np.abs(x.omega_ib_b - y.omega_ib_b).max() < 1e-5


def test_nothing_is_overwritten_without_force(tmp_path, capsys):
    """An existing file is kept, exit code 2; --force replaces a file or a bag by its own kind."""
    csv_writer.write_imu(tmp_path / 'imu.csv', imu_of(10))
    assert convert(tmp_path / 'imu.csv', tmp_path / 'bag') == 0
    before = (tmp_path / 'bag' / 'metadata.yaml').read_bytes()
    for source, target, sentence in (('imu.csv', 'bag', 'expected a new path for the bag'),
                                     ('bag', 'imu.csv', 'expected a new file (or --force)')):
        assert convert(tmp_path / source, tmp_path / target) == 2
        assert sentence in capsys.readouterr().err
    assert (tmp_path / 'bag' / 'metadata.yaml').read_bytes() == before
    assert convert(tmp_path / 'imu.csv', tmp_path / 'bag', '--force') == 0
    (tmp_path / 'imu.csv').write_text('old')
    assert convert(tmp_path / 'bag', tmp_path / 'imu.csv', '--force') == 0
    assert len(csv_imu.read_imu(tmp_path / 'imu.csv')[0]) == 10
    (tmp_path / 'folder.csv').mkdir()
    assert convert(tmp_path / 'bag', tmp_path / 'folder.csv', '--force') == 2
    assert 'is not a file; --force replaces only files' in capsys.readouterr().err
    (tmp_path / 'data').mkdir()
    (tmp_path / 'data' / 'thesis.txt').write_text('years')
    assert convert(tmp_path / 'imu.csv', tmp_path / 'data', '--force') == 2
    assert 'has no marker .ins_sim' in capsys.readouterr().err
    assert sorted(p.name for p in tmp_path.iterdir()) == ['bag', 'data', 'folder.csv', 'imu.csv']


IMU_TEXT = 't_s,' + ','.join(csv_imu.IMU) + '\n'


def empty_bag(path, name='odom', type_name=topics.VECTOR):
    """Write a bag with one topic and no message."""
    with BagWriter(path) as bag:
        bag.add_topic(name, type_name)


def early(path):
    """Write a flight that begins before time zero."""
    t = np.arange(200) * 0.1 - 5.0
    path.write_text('\n'.join([','.join(COLUMNS), *(
        f'{x:.1f},55,37,100,0,0,0,,,' for x in t)]) + '\n')


@pytest.mark.parametrize('make, words, sentence', [
    (None, ['absent.csv', 'bag'], 'absent.csv does not exist; expected a rosbag2 bag or a CSV'),
    (lambda p: (p / 'x.txt').write_text('x'), ['x.txt', 'bag'],
     'x.txt is neither a bag nor named .csv or .csv.gz'),
    (lambda p: (p / 'x.csv').write_text('x'), ['x.csv', 'y.csv'],
     'x.csv and y.csv are both CSV files; expected a bag and a CSV file'),
    (lambda p: (p / 'x').mkdir(), ['x', 'y'], 'x and y are both bags'),
    (lambda p: (p / 'x').mkdir(), ['x', 'y.csv'], 'x is not a bag'),
    (lambda p: (p / 'x.csv').write_text(''), ['x.csv', 'y'], 'x.csv is empty'),
    (lambda p: (p / 'x.csv').write_text('a,b\n1,2\n'), ['x.csv', 'y'],
     "x.csv, line 1: unknown column 'a'"),
    (lambda p: (p / 'x.csv').write_text(IMU_TEXT), ['x.csv', 'y'],
     'x.csv has a header but no rows'),
    (lambda p: (p / 'x.csv').write_text(IMU_TEXT + '-1,0,0,0,0,0,9\n'), ['x.csv', 'y'],
     'x.csv begins at -1 s; expected 0 s or later in a bag (time.epoch_s is added)'),
    (lambda p: (p / 'x.csv').write_text(IMU_TEXT + '1,0,0,zero,0,0,9\n'), ['x.csv', 'y'],
     "x.csv, line 2 (t_s = '1'): gz_rps is 'zero'"),
    (lambda p: (p / 'x.csv').write_text(IMU_TEXT + '3e9,0,0,0,0,0,9\n'), ['x.csv', 'y'],
     'which a ROS stamp can hold'),
    (lambda p: early(p / 'x.csv'), ['x.csv', 'y'], 'x.csv begins at -5 s'),
    (lambda p: early(p / 'x.csv'), ['x.csv', 'y', '--topic', 'odom'],
     '--topic is odom, but x.csv is a recorded flight'),
    (lambda p: early(p / 'x.csv'), ['x.csv', 'y', '-p', 'motion.recording.start_s:=18.0'],
     'motion.recording.start_s is 18 s; expected 3 to'),
    (lambda p: early(p / 'x.csv'), ['x.csv', 'y', '--storage', 'sqlite3', '--compression', 'lz4'],
     'sqlite3 cannot be compressed by lz4'),
    (lambda p: empty_bag(p / 'x'), ['x', 'y.csv'], 'x has neither a nav_msgs/Odometry whose name '
     'ends in truth/odometry nor a sensor_msgs/Imu; it has /odom'),
    (lambda p: empty_bag(p / 'x'), ['x', 'y.csv', '--topic', 'odom'], 'x: /odom, the value of '
     '--topic, has type geometry_msgs/Vector3Stamped; expected nav_msgs/Odometry or sensor_msgs'),
    (lambda p: empty_bag(p / 'x', 'imu', topics.IMU), ['x', 'y.csv'], '/imu is empty'),
    (lambda p: empty_bag(p / 'x', 'imu', topics.IMU), ['x', 'y.csv', '--topic', 'none'],
     "x has no topic 'none', the value of --topic; the nearest is '/imu'"),
    (lambda p: empty_bag(p / 'x', 'truth/odometry', topics.ODOMETRY), ['x', 'y.csv'],
     '/truth/odometry is empty'),
])
def test_bad_input_is_one_sentence_and_exit_code_2(make, words, sentence, tmp_path, capsys,
                                                   monkeypatch):
    """Invalid input gives one message and exit code 2, and nothing is written."""
    monkeypatch.chdir(tmp_path)
    if make is not None:
        make(tmp_path)
    assert convert(*words) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.startswith('ins_sim convert: ') and error.count('\n') == 1
    assert not (tmp_path / 'y').exists() and not (tmp_path / 'y.csv').exists()


def test_a_write_that_fails_leaves_the_old_file(tmp_path, monkeypatch):
    """The file is written completely or not at all."""
    path = tmp_path / 'imu.csv.gz'
    csv_writer.write_imu(path, imu_of(10))
    before = path.read_bytes()
    monkeypatch.setattr(gzip, 'compress', lambda data, mtime: 'no bytes')
    with pytest.raises(TypeError):
        csv_writer.write_imu(path, imu_of(20))
    assert path.read_bytes() == before and len(list(tmp_path.iterdir())) == 1


def test_a_part_of_another_process_is_left_alone(tmp_path):
    """Two processes that write one file have temporary files of their own; the last one wins."""
    other = tmp_path / '.imu.csv.part'
    other.write_text('of another process')
    csv_writer.write_imu(tmp_path / 'imu.csv', imu_of(10))
    assert other.read_text() == 'of another process' and len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize('content', ['flight', 'imu'])
def test_stamps_of_an_unset_clock_are_told(content, tmp_path, capsys):
    """Stamps before 2005 give a note; time.epoch fixed shifts them, and valid stamps are kept."""
    rows = [f'{0.1 * k:.1f},55.0,37.0,100.0,0,0,90,0,10.0,0' for k in range(200)]
    head = ','.join(COLUMNS)
    if content == 'imu':
        rows = [f'{0.01 * k:.2f},0,0,0.1,0,0,9.8' for k in range(200)]
        head = 't_s,gx_rps,gy_rps,gz_rps,ax_mps2,ay_mps2,az_mps2'
    path = tmp_path / 'x.csv'
    path.write_text('\n'.join([head, *rows, '']))
    assert convert(path, tmp_path / 'a') == 0
    said = ' '.join(capsys.readouterr().out.split())
    assert f'its stamps begin at 0 s, before 2005, as in {path};' in said
    assert '-p time.epoch:=fixed adds 1735689600 s' in said
    assert convert(path, tmp_path / 'b', '-p', 'time.epoch:=fixed') == 0
    assert 'before 2005' not in capsys.readouterr().out
    with open_bag(tmp_path / 'b') as bag:
        assert {span.first_ns for span in bag.spans().values()} == {1735689600 * SECOND}
