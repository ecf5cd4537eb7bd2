"""
The command navigate on public recorded data; the errors are those of such sensors.

No parameter is tuned: mounting and frames are those published with the data, and the start is
given. There is no truth, so the bounds are those of free inertial navigation with the biases that
the record itself shows; the rest is printed.
"""

import json
import math

import numpy as np
import pytest

from ins_sim.cli.main import main
from ins_sim.io import csv_imu
from ins_sim.core.attitude.angles import to_compass

# From the public launch file that plays this bag, robot_localization's
# test/test_ekf_localization_node_bag1.test: the IMU "was intentionally rotated +90 degrees about
# the X axis, then rotated (extrinsically) -90 degrees about the Z axis", and a static transform
# from base_link to imu_link with roll 90, pitch 0, yaw -90 deg. The data agree: gravity is on +y.
HUSKY = ['mounting.rpy_deg:=[90.0, 0.0, -90.0]']
# Forward, right, down: half a turn about forward.
FRD = ['mounting.rpy_deg:=[180.0, 0.0, 0.0]']


def navigated(recording, out, *assignments):
    """Return the summary of a navigation."""
    words = [word for a in assignments for word in ('-p', a)]
    assert main(['navigate', str(recording), '-o', str(out), *words]) == 0
    return json.loads((out / 'summary.json').read_text())


def shown(capsys, title, summary):
    """Print the errors of a summary."""
    capsys.readouterr()
    with capsys.disabled():
        for name, rows in summary['errors'].items():
            print(f'\n{title}, less {name}')
            for row in rows:
                print('  ' + ', '.join(f'{k} {v:.4g}' for k, v in row.items() if v is not None))


def grown(t_s, bias_rad_s, tilt_rad, g=9.8):
    """Return the position error of a level gyro bias and a tilt after t_s, m: g b t^3/6 + ..."""
    return g * bias_rad_s * t_s ** 3 / 6.0 + g * tilt_rad * t_s ** 2 / 2.0


def test_husky_from_its_standstill(shared_data, tmp_path, capsys):
    """
    The only standstill of 10 s is found although the record starts in motion.

    The course of the fix gives the heading. Odometry at the standstill: 0 m/s. Bounds: errors
    below those of 0.1 deg/s and 2 deg (gyro noise, vibration at 30 Hz, a robot on a slope); the
    heading against the wheels within 20 deg over 150 s.
    """
    out = tmp_path / 'out'
    summary = navigated(shared_data / 'rosbags' / 'husky_test1_mcap', out, *HUSKY)
    shown(capsys, 'husky, aligned at rest', summary)
    figures = summary['figures']
    assert 8.0 < figures['stationary_s'] < 12.0
    # Odometry is at rest from 236.5 to 247 s of the record.
    assert 236.0 < summary['start_ns'] * 1e-9 - 1432235498.0 < 248.0
    assert abs(figures['roll_deg']) < 5.0 and abs(figures['pitch_deg']) < 5.0
    wheels = summary['errors']['/husky_velocity_controller/odom laid on the start']
    for row in wheels:
        assert row['horizontal_m'] < grown(row['after_s'], math.radians(0.1), math.radians(2.0))
        assert abs(row['heading_deg']) < 20.0


def test_husky_levelled_without_a_word_on_its_mounting(shared_data, tmp_path, capsys):
    """
    Gravity on +y: mounting.source level finds the rotation about x; only its yaw must be given.

    Compared with the stated mounting: the slope of the ground at the standstill, 5 deg at most.
    """
    from ins_sim.core.attitude import angles, quaternion
    summary = navigated(shared_data / 'rosbags' / 'husky_test1_mcap', tmp_path / 'out',
                        'mounting.source:=level', 'mounting.rpy_deg:=[0.0, 0.0, -90.0]')
    capsys.readouterr()
    stated = angles.from_rpy(math.radians(90.0), 0.0, math.radians(-90.0))
    off = quaternion.logarithm(quaternion.multiply(
        tuple(summary['figures']['mounting_xyzw']), quaternion.conjugate(stated)))
    assert np.linalg.norm(off) < math.radians(5.0)


def test_husky_as_if_its_imu_lay_flat(shared_data, tmp_path, capsys):
    """Without its mounting the IMU seems to lie on its side, and a message states this."""
    summary = navigated(shared_data / 'rosbags' / 'husky_test1_mcap', tmp_path / 'out')
    capsys.readouterr()
    assert abs(summary['figures']['roll_deg']) > 80.0
    assert any('Is the IMU mounted rotated?' in note for note in summary['notes'])


def test_husky_from_the_orientation_in_its_messages(shared_data, tmp_path, capsys):
    """A start in motion uses attitude of the IMU, velocity of the wheels, position of the fix."""
    summary = navigated(shared_data / 'rosbags' / 'husky_test1_mcap', tmp_path / 'out', *HUSKY,
                        'initial.attitude:=imu', 'duration_s:=60.0')
    shown(capsys, 'husky, from the first sample', summary)
    assert summary['start_ns'] * 1e-9 - 1432235498.0 < 0.2
    for row in summary['errors']['/husky_velocity_controller/odom laid on the start']:
        assert row['horizontal_m'] < grown(row['after_s'], math.radians(0.1), math.radians(2.0))


def test_the_uav_on_the_ground(shared_data, tmp_path, capsys):
    """
    The first 57 s of 90 s on the ground stay below a gyro drift of 0.2 deg/s and 0.5 deg of tilt.

    From 57 s on the UAV moves as if it were carried. Its course is then not its heading, and the
    bag cannot show this, so only earlier errors are meaningful. The drift is that of the gyro's
    warm-up.
    """
    summary = navigated(shared_data / 'rosbags' / 'umn_thor_fl75_first90s_sqlite3',
                        tmp_path / 'out')
    shown(capsys, 'UAV on the ground', summary)
    assert 'the course of /gps/fix, /gps/vel' in summary['figures']['heading_source']
    for row in summary['errors']['/gps/fix, /gps/vel'][:2]:
        assert row['horizontal_m'] < grown(row['after_s'], math.radians(0.2), math.radians(0.5))


def test_the_conventions_of_the_csv_files_are_in_the_data(shared_data):
    """
    The published axes are forward, right, down: gravity is on -z, and rates match the attitude.

    Correlation of each axis with the reference, by increments between its stamps: above 0.9 with
    the right sign for the road vehicle, above 0.8 for the UAV, whose filter corrects its attitude.
    """
    from scipy.spatial.transform import Rotation
    folder = shared_data / 'imu_ref'
    for imu, reference, least in (
            ('fogmems_imu.csv.gz', folder / 'fogmems_fogins_reference.csv', 0.9),
            ('umn_thor_fl75_imu.csv.gz',
             shared_data / 'flights' / 'uavcircuit_umn_thor_fl75.csv.gz', 0.8)):
        imu, _ = csv_imu.read_imu(folder / imu)
        track = csv_imu.read_reference(reference)[0].attitude
        assert imu.f[:, 2].mean() < -9.0
        flu = imu.turned((1.0, 0.0, 0.0, 0.0))
        inside = (track.t_ns > imu.t_ns[0]) & (track.t_ns < imu.t_ns[-1])
        t_ns, q = track.t_ns[inside], Rotation.from_quat(track.values[inside])
        turn = (q[:-1].inv() * q[1:]).as_rotvec()
        steps = np.diff(imu.t_ns, prepend=imu.t_ns[0])[:, None] * 1e-9
        summed = np.cumsum(flu.omega * steps, axis=0)
        own = np.diff([np.interp(t_ns, imu.t_ns, s) for s in summed.T], axis=1).T
        for axis in range(3):
            # Heading resets of the on-board filter on the ground are no rotation of the IMU.
            real = np.linalg.norm(turn, axis=1) < 0.1
            assert np.corrcoef(turn[real, axis], own[real, axis])[0, 1] > least


@pytest.mark.parametrize('bias', ['keep', 'subtract'])
def test_the_circuit_flight_from_the_air(bias, shared_data, tmp_path, capsys):
    """
    From 200 s to 320 s of the flight the errors stay below those of a gyro bias of 0.3 deg/s.

    The start is airborne, after the climb, with given values. Bound: gyro bias of 0.3 deg/s, as at
    the standstill on the ground, and 2 deg of tilt (the reference is an on-board estimate that is
    corrected at 1 Hz).
    """
    flight = shared_data / 'flights' / 'uavcircuit_umn_thor_fl75.csv.gz'
    track = csv_imu.read_reference(flight)[0]
    start_ns = 200_019_999_000
    lat, lon, height = track.position.at([start_ns])[0]
    roll, pitch, heading = np.degrees(to_compass(np.array(track.attitude_at(start_ns))))
    v = track.velocity_at([start_ns])[0].tolist()
    given = ['initial.attitude:=given', 'initial.velocity:=given', 'initial.position:=given',
             f'initial.latitude_deg:={math.degrees(lat)!r}',
             f'initial.longitude_deg:={math.degrees(lon - 2 * math.pi * round(lon / 6.2832))!r}',
             f'initial.height_m:={float(height)!r}', f'initial.roll_deg:={float(roll)!r}',
             f'initial.pitch_deg:={float(pitch)!r}', f'initial.heading_deg:={float(heading)!r}',
             f'initial.velocity_m_s:={v}']
    common = [*FRD, f'reference.path:={flight}', 'start_s:=200.01', 'duration_s:=120.0',
              f'alignment.gyro_bias:={bias}']
    imu = shared_data / 'imu_ref' / 'umn_thor_fl75_imu.csv.gz'
    summary = navigated(imu, tmp_path / 'given', *common, *given)
    shown(capsys, f'circuit flight from the air, gyro bias {bias}', summary)
    rows, = summary['errors'].values()
    assert [r['after_s'] for r in rows[:3]] == [10.0, 30.0, 60.0]
    for row in rows[:3]:
        assert row['horizontal_m'] < grown(row['after_s'], math.radians(0.3), math.radians(2.0))
        assert row['tilt_deg'] < 2.0 + 0.3 * row['after_s']
    # The state of the reference at this time gives the same start.
    other = navigated(imu, tmp_path / 'reference', *common, 'initial.attitude:=reference')
    capsys.readouterr()
    assert abs(other['errors'][track.name][0]['horizontal_m'] - rows[0]['horizontal_m']) < 1e-3


def test_the_road_vehicle_beside_a_fibre_optic_ins(shared_data, tmp_path, capsys):
    """
    A car with MEMS at 100 Hz, started at 11 m/s, stays within the errors of 0.1 deg/s and 1 deg.

    The start is that of the reference, a fibre-optic INS. Heading and tilt are bounded by the same
    gyro bias.
    """
    folder = shared_data / 'imu_ref'
    summary = navigated(folder / 'fogmems_imu.csv.gz', tmp_path / 'out', *FRD,
                        f'reference.path:={folder / "fogmems_fogins_reference.csv"}',
                        'initial.attitude:=reference')
    shown(capsys, 'MEMS compared with the fibre-optic INS', summary)
    rows, = summary['errors'].values()
    for row in rows:
        assert row['horizontal_m'] < grown(row['after_s'], math.radians(0.1), math.radians(1.0))
        assert row['tilt_deg'] < 1.0 + 0.1 * row['after_s']
        assert abs(row['heading_deg']) < 1.0 + 0.1 * row['after_s']


def test_a_car_that_never_stops_is_refused(shared_data, tmp_path, capsys):
    """A record without a standstill is refused with one message that describes the best window."""
    folder = shared_data / 'imu_ref'
    assert main(['navigate', str(folder / 'fogmems_imu.csv.gz'), '-o', str(tmp_path / 'out'), '-p',
                 f'reference.path:={folder / "fogmems_fogins_reference.csv"}']) == 2
    assert 'no stationary interval of 5 s' in capsys.readouterr().err
