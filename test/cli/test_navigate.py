"""The command navigate on bags: simulated recordings give the truth; faults give one message."""

import json
import math

import numpy as np
import pytest
from support.recordings import COVARIANCE_TWIST, covariance_twist_messages, FIX, \
    fix_messages, IMU, imu_messages, ODOMETRY, odometry_messages, STORE, TF, tf_messages, \
    TWIST, twist_messages, write_bag
from rosbags.rosbag2 import StoragePlugin, Writer
from scipy.spatial.transform import Rotation

from ins_sim import parameter_files, resources
from ins_sim.cli.main import main
from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.attitude.angles import from_compass
from ins_sim.settings.catalogue import flatten
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.settings.navigate import NAVIGATE, NavigateSettings
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.messages import convert, topics
from support.readings.imu_records import resting

SECOND = 1_000_000_000
EPOCH = 1432235498 * SECOND
MOUNTING = Rotation.from_euler('xyz', [90.0, 0.0, -90.0], degrees=True)


def motion_of(*assignments):
    """Return Settings and their Motion."""
    chosen = parameter_files.read([], ['source:=motion', *assignments])
    generator = chosen.motion_generator
    return chosen, make_motion(generator.motion, generator.datum, generator.earth)


def truth_topics(motion, length_s, rate_hz=100.0, start_ns=0):
    """Return the topics of a robot: IMU rotated by MOUNTING, fix and velocity at 5 Hz."""
    t_ns = start_ns + np.arange(round(length_s * rate_hz) + 1, dtype=np.int64) * round(
        SECOND / rate_hz)
    truth = motion.at(t_ns)
    some = slice(None, None, round(rate_hz / 5.0))
    back = MOUNTING.inv()
    q_ns = (Rotation.from_quat(truth.q_nb) * MOUNTING).as_quat()
    return truth, {
        ('/imu/data', IMU): imu_messages(t_ns, back.apply(truth.omega_ib_b),
                                         back.apply(truth.f_ib_b), q=q_ns),
        ('/fix', FIX): fix_messages(t_ns[some], truth.lat[some], truth.lon[some],
                                    truth.height[some]),
        ('/vel', TWIST): twist_messages(t_ns[some], truth.v_n[some]),
        ('/tf_static', TF): tf_messages(t_ns[0], {
            ('base_link', 'mast'): Rotation.from_euler('z', -90.0, degrees=True).as_quat(),
            ('mast', 'imu_link'): Rotation.from_euler('x', 90.0, degrees=True).as_quat()})}


def summary_of(folder):
    """Return the summary of a folder."""
    return json.loads((folder / 'summary.json').read_text())


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_moving_start_navigates_back_to_the_truth(storage, tmp_path, capsys):
    """
    Attitude from the orientation in the messages, mounting from two links of /tf_static.

    Bound: the truncation error of the trapezoidal rule falls with the square of the step, so that
    the error at 100 Hz is 4/3 of its excess over that at 200 Hz; fourth-order terms get a
    hundredth.
    """
    _, motion = motion_of('motion.kind:=sinusoids')
    _, recorded = truth_topics(motion, 20.0, start_ns=EPOCH)
    bag = write_bag(tmp_path / 'bag', recorded, storage)
    out = tmp_path / 'out'
    assert main(['navigate', str(bag), '-p', 'initial.attitude:=imu', '-o', str(out)]) == 0
    shown = ' '.join(capsys.readouterr().out.split())
    assert 'mounting: /tf_static from base_link to imu_link' in shown
    _, finer = truth_topics(motion, 20.0, 200.0, start_ns=EPOCH)
    finer = write_bag(tmp_path / 'finer', finer, storage)
    assert main(['navigate', str(finer), '-p', 'initial.attitude:=imu', '-o',
                 str(tmp_path / 'fine')]) == 0
    capsys.readouterr()
    with np.load(out / 'nav.npz') as a, np.load(tmp_path / 'fine' / 'nav.npz') as b:
        at_100, at_200 = (x['error_0_position'][-1] for x in (a, b))
    with capsys.disabled():
        print(f'\nbag ({storage}) after 20 s: {np.linalg.norm(at_100):.4f} m at 100 Hz, '
              f'{np.linalg.norm(at_200):.4f} m at 200 Hz')
    rest = at_100 - 4.0 / 3.0 * (at_100 - at_200)
    assert np.linalg.norm(rest) < 0.01 * np.linalg.norm(at_100)
    for name in ('navigation', 'track'):
        assert (out / f'{name}.png').read_bytes().startswith(b'\x89PNG')
    assert 'horizontally, ' in (out / 'report.html').read_text(encoding='utf-8')
    with np.load(out / 'nav.npz') as arrays:
        assert arrays['states_q_nb'].shape == (2001, 4)
        assert arrays['states_t_ns'][0] == EPOCH
        assert arrays['error_0_position'].shape == (101, 3)
    # The parameters of a run can be given to the command again.
    assert main(['navigate', str(bag), '--params-file', str(out / 'parameters.yaml'), '-o',
                 str(tmp_path / 'again')]) == 0
    with np.load(out / 'nav.npz') as a, np.load(tmp_path / 'again' / 'nav.npz') as b:
        assert np.array_equal(a['states_lat'], b['states_lat'])


def test_a_bag_of_our_own_nodes_aligns_itself_and_navigates(tmp_path, capsys):
    """
    The topics as bag_recorder writes them: the IMU at rest for 60 s, then 60 s of navigation.

    With a perfect IMU the increments have one rounding of their angles, 1e-16 rad in 0.01 s. This
    1e-14 rad/s relative to the level Earth rate of 4e-5 is a heading error of at most 2.5e-10 rad;
    with a tilt of 1e-15 the strapdown drifts by micrometres.
    """
    chosen, motion = motion_of('motion.kind:=static', 'motion.psi_deg:=-40.0',
                               'motion.theta_deg:=5.0', 'duration_s:=120.0', 'output:=integrated',
                               'input:=integrated')
    blocks = list(imu_blocks(chosen, motion))
    t_ns = np.concatenate([b.t_ns for b in blocks])
    truth = motion.at(t_ns)
    generator = chosen.motion_generator
    frame = MapFrame(generator.datum, True)
    values = {**convert.truth_blocks(frame, truth)}
    values[topics.IMU_RAW] = np.concatenate([convert.imu_block(b)[topics.IMU_RAW]
                                             for b in blocks])
    bag = tmp_path / 'bag'
    with Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for topic in (topics.TRUTH_ODOMETRY, topics.TRUTH_FIX, topics.IMU_RAW):
            connection = writer.add_connection('/' + topic.name, topic.type_name,
                                               typestore=STORE)
            for stamp, data in zip(t_ns.tolist(), topic.writer().pack_block(t_ns,
                                                                            values[topic])):
                writer.write(connection, stamp, data)
    out = tmp_path / 'out'
    assert main(['navigate', str(bag), '-p', 'input:=integrated', '-p',
                 'alignment.gyro_bias_sigma_deg_h:=0.0', '-o', str(out)]) == 0
    capsys.readouterr()
    summary = summary_of(out)
    figures = summary['figures']
    ends = {name: rows[-1] for name, rows in summary['errors'].items()}
    fix = ends['/truth/fix']
    odometry = ends['/truth/odometry laid on the start']
    with capsys.disabled():
        print(f'\nown bag: heading {figures["heading_deg"]:.9f} (true 40), position error after '
              f'60 s {fix["horizontal_m"]:.3g} m, attitude {odometry["tilt_deg"]:.3g} deg')
    assert figures['heading_source'] == 'gyrocompass'
    assert abs(figures['heading_deg'] - 40.0) < math.degrees(2.5e-10)
    assert abs(figures['pitch_deg'] - 5.0) < 1e-9
    assert fix['horizontal_m'] < 1e-5 and abs(fix['vertical_m']) < 1e-5
    assert odometry['horizontal_m'] < 1e-5 and odometry['tilt_deg'] < 1e-8


def drive(start_s=20.0, length_s=60.0, heading_deg=70.0):
    """Return times, velocity, position of a car: at rest, then straight at 1 m/s^2 to 10 m/s."""
    t = np.arange(round(length_s * 50.0) + 1) / 50.0
    moved = np.clip(t - start_s, 0.0, 10.0)
    speed = moved + 0.0
    way = 0.5 * moved ** 2 + 10.0 * np.maximum(t - start_s - 10.0, 0.0)
    s, c = math.sin(math.radians(heading_deg)), math.cos(math.radians(heading_deg))
    return t, np.outer(speed, [s, c, 0.0]), np.outer(way, [s, c]), (t >= start_s) & (
        t < start_s + 10.0)


def car(tmp_path, bias=0.002, with_fix=True, frame='imu_link'):
    """Return a bag of a level car with MEMS gyros biased about the vertical, and fixes at 5 Hz."""
    t, v, way, pushed = drive()
    t_ns = np.round(t * 1e9).astype(np.int64)
    lat0, n = math.radians(50.0), len(t)
    r_n, r_e = ellipsoid.radii(math.sin(lat0))
    lat = lat0 + way[:, 1] / r_n
    lon = way[:, 0] / (r_e * math.cos(lat0))
    rng = np.random.default_rng(2)
    q_nb = tuple(from_compass(0.0, 0.0, math.radians(70.0))[0].tolist())
    turning = quaternion.rotate_back(q_nb, (0.0, ellipsoid.ROTATION_RATE * math.cos(lat0),
                                            ellipsoid.ROTATION_RATE * math.sin(lat0)))
    omega = turning + np.array([0.0, 0.0, bias]) + 1e-3 * rng.standard_normal((n, 3))
    f = np.stack([pushed * 1.0, np.zeros(n), np.full(n, ellipsoid.gravity(math.sin(lat0), 0.0))],
                 axis=1) + 0.02 * rng.standard_normal((n, 3))
    recorded = {('/imu', IMU): imu_messages(t_ns, omega, f, frame=frame)}
    if with_fix:
        recorded['/fix', FIX] = fix_messages(t_ns[::10], lat[::10], lon[::10], np.zeros(n)[::10])
    return write_bag(tmp_path / 'car', recorded)


def test_a_car_of_coarse_gyros_takes_bias_and_course(tmp_path, capsys):
    """
    MEMS gyros need no gyrocompass: bias from the standstill, heading of 70 deg from the course.

    The heading bound is the random walk of the rate noise, 1e-3 rad/s at 50 Hz over the 27 s to 20
    m, plus the bias error after 20 s of averaging: sqrt(27 / 50) 1e-3 + 27 1e-3 / sqrt(1000),
    three times, 0.27 deg.
    """
    out = tmp_path / 'out'
    assert main(['navigate', str(car(tmp_path)), '-o', str(out)]) == 0
    shown = ' '.join(capsys.readouterr().out.split())
    assert 'too coarse to measure the rotation' in shown and 'the course of /fix' in shown
    figures = summary_of(out)['figures']
    bound = math.degrees(3.0 * (math.sqrt(27 / 50) * 1e-3 + 27e-3 / math.sqrt(1000)))
    assert abs(figures['heading_deg'] - 70.0) < bound
    assert abs(figures['gyro_bias_rad_s'][2] - 0.002) < 1e-4
    with capsys.disabled():
        print(f'\ncar: heading {figures["heading_deg"]:.3f} (true 70, bound {bound:.2f}), end '
              f'{summary_of(out)["errors"]["/fix"][-1]["horizontal_m"]:.1f} m')


def test_the_odometry_is_laid_on_the_start(tmp_path):
    """
    Reference odometry in a frame of unknown origin and heading is aligned to the start.

    The errors against it are then those of the truth.
    """
    _, motion = motion_of('motion.kind:=sinusoids')
    truth, recorded = truth_topics(motion, 20.0)
    generator = motion_of('motion.kind:=sinusoids')[0].motion_generator
    r_m, q_mb, v_b = MapFrame(generator.datum, True).pose(
        truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)
    turn = Rotation.from_euler('z', 130.0, degrees=True)
    recorded['/odom', ODOMETRY] = odometry_messages(
        truth.t_ns[::10], turn.apply(r_m)[::10] + [100.0, -50.0, 3.0],
        (turn * Rotation.from_quat(q_mb)).as_quat()[::10], v_b[::10])
    bag, out = write_bag(tmp_path / 'bag', recorded), tmp_path / 'out'
    assert main(['navigate', str(bag), '-p', 'initial.attitude:=imu', '-o', str(out)]) == 0
    errors = summary_of(out)['errors']
    end, fix = errors['/odom laid on the start'][-1], errors['/fix, /vel'][-1]
    # The plane of the map deviates by 1e-7 m in a metre.
    assert abs(end['horizontal_m'] - fix['horizontal_m']) < 1e-6
    assert abs(end['vertical_m'] - fix['vertical_m']) < 1e-6
    assert abs(end['speed_m_s'] - fix['speed_m_s']) < 1e-6
    assert end['tilt_deg'] < 1e-4 and abs(end['heading_deg']) < 1e-4


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_twist_with_covariance_is_the_same_velocity(storage, tmp_path, capsys):
    """TwistStamped and TwistWithCovarianceStamped give the same numbers."""
    _, motion = motion_of('motion.kind:=sinusoids')
    ends = []
    for name in (TWIST, COVARIANCE_TWIST):
        truth, recorded = truth_topics(motion, 10.0)
        if name == COVARIANCE_TWIST:
            del recorded['/vel', TWIST]
            recorded['/vel', name] = covariance_twist_messages(truth.t_ns[::20],
                                                               truth.v_n[::20])
        bag, out = tmp_path / name[-9:], tmp_path / f'out{name[-9:]}'
        write_bag(bag, recorded, storage)
        assert main(['navigate', str(bag), '-p', 'initial.attitude:=imu', '-o', str(out)]) == 0
        ends.append(summary_of(out)['errors'])
    capsys.readouterr()
    assert ends[0] == ends[1] and '/fix, /vel' in ends[0]


IMU_ONLY = dict(t_ns=np.arange(1000) * 20_000_000, omega=np.zeros((1000, 3)),
                f=np.tile([0.0, 0.0, 9.8], (1000, 1)))


def test_stamps_that_were_never_set_give_way_to_the_times_of_logging(tmp_path, capsys):
    """If stamps were never set, the log times are used, and a note states this."""
    bag = write_bag(tmp_path / 'bag', {('/imu', IMU): resting(stamps=np.zeros(1000))})
    assert main(['navigate', str(bag), '-o', str(tmp_path / 'out'), '-p',
                 'initial.position:=given', '-p', 'initial.heading:=given', '-p',
                 'alignment.longest_s:=10.0']) == 0
    assert 'the log times are used' in capsys.readouterr().out


def test_a_solution_is_not_overwritten_without_force(tmp_path, capsys):
    """A navigation is kept with exit code 2; --force replaces only a navigation."""
    bag = write_bag(tmp_path / 'bag', {('/imu', IMU): resting()})
    arguments = ['navigate', str(bag), '-o', str(tmp_path / 'out'), '-p',
                 'initial.position:=given', '-p', 'initial.heading:=given', '-p',
                 'alignment.longest_s:=10.0']
    assert main(arguments) == 0
    assert 'nothing to compare with' in capsys.readouterr().out
    assert main(arguments) == 2
    assert 'expected a new folder' in capsys.readouterr().err
    assert main([*arguments, '--force']) == 0


def test_the_shipped_file_holds_the_defaults(tmp_path, capsys):
    """config/navigate.yaml names every key, and an unknown section is refused."""
    read = parameter_files.read_nodes([resources.config('navigate')], [], NAVIGATE)
    assert read == {'navigate': NavigateSettings()}
    text = resources.config('navigate').read_text()
    for name in flatten(NavigateSettings):
        assert f' {name.rsplit(".", 1)[-1]}:' in text
    other = tmp_path / 'other.yaml'
    other.write_text('/**/navigator: {ros__parameters: {start_s: 1.0}}')
    assert main(['navigate', str(tmp_path), '--params-file', str(other)]) == 2
    assert "the nearest known one is 'navigate'" in capsys.readouterr().err
