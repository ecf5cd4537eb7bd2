"""Self-alignment at a standstill obeys the textbook error equations for any mounting."""

from dataclasses import replace
import math

from hypothesis import example, given, settings, strategies as st
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from ins_sim import parameter_files, resources
from ins_sim.core.attitude import angles, quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation import alignment
from ins_sim.core.postprocessing import standstill
from ins_sim.core.postprocessing import mounting
from ins_sim.core.attitude.angles import from_compass, to_compass
from ins_sim.settings.catalogue import build
from ins_sim.core.postprocessing.sources import Sources
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.postprocessing.navigate import navigate
from ins_sim.settings.navigate import AlignmentSettings, NavigateSettings
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.simulation.inertial import imu_blocks

OMEGA = ellipsoid.ROTATION_RATE
DEG_H = math.radians(1.0) / 3600.0


def resting(q_nb, lat, count=600, rate_hz=10.0, bias=(np.zeros(3), np.zeros(3)), noise=(0.0, 0.0),
            seed=0):
    """Return the RecordedImu of an IMU at rest in b with biases and white noise."""
    rng = np.random.default_rng(seed)
    rate = quaternion.rotate_back(q_nb, (0.0, OMEGA * math.cos(lat), OMEGA * math.sin(lat)))
    force = quaternion.rotate_back(q_nb, (0.0, 0.0, ellipsoid.gravity(math.sin(lat), 0.0)))
    t_ns = np.arange(count, dtype=np.int64) * round(1e9 / rate_hz)
    return RecordedImu(t_ns, rate + bias[0] + noise[0] * rng.standard_normal((count, 3)),
                       force + bias[1] + noise[1] * rng.standard_normal((count, 3)),
                       np.full((count, 4), np.nan))


def errors(q, q_true):
    """Return tilt and heading error of q_nb, rad."""
    e = quaternion.logarithm(quaternion.multiply(q, quaternion.conjugate(q_true)))
    return math.hypot(e[0], e[1]), abs(e[2])


@settings(max_examples=30, deadline=None)
@given(turn=st.tuples(*[st.floats(-180.0, 180.0)] * 3), lat=st.floats(-1.3, 1.3),
       heading=st.floats(0.0, 6.28), how=st.sampled_from(['given', 'tf']))
def test_any_mounting_navigates_alike(turn, lat, heading, how):
    """
    With a perfect IMU in any mounting the attitude is exact to rounding and nothing drifts.

    A rounding error of 1e-15 in the rotated rate causes 1e-15 / cos(lat) rad of heading error; the
    solution at rest then drifts by less than g 1e-14 t^2 / 2, far below a micrometre in 50 s.
    """
    q_nb = tuple(from_compass(0.2, -0.1, heading)[0].tolist())
    rotation = Rotation.from_euler('xyz', turn, degrees=True)
    q_bs = tuple(rotation.as_quat().tolist())
    imu = resting(q_nb, lat).turned(quaternion.conjugate(q_bs))
    chosen = build(NavigateSettings, {
        'mounting.source': how, 'alignment.longest_s': 10.0, 'initial.position': 'given',
        'alignment.gyro_bias_sigma_deg_h': 0.0,
        'initial.latitude_deg': math.degrees(lat),
        'mounting.rpy_deg': turn if how == 'given' else (0.0, 0.0, 0.0)})
    tree = {('base_link', 'imu'): q_bs} if how == 'tf' else {}
    got = navigate(chosen, Sources('the record', imu, 'imu', transforms=tree))
    tilt, azimuth = errors(tuple(got.states[0].q_nb[-1].tolist()), q_nb)
    assert got.figures['heading_source'] == 'gyrocompass'
    assert tilt < 1e-13 and azimuth < 1e-11 / math.cos(lat)
    assert abs(got.states[0].lat[-1] - lat) * ellipsoid.SEMI_MAJOR < 1e-6


UNIT = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: 0.1 < np.linalg.norm(v))
ANGLE = st.floats(-3.1, 3.1)


@settings(max_examples=200, deadline=None)
@given(roll=ANGLE, pitch=st.floats(-1.5, 1.5), heading=ANGLE, lat=st.floats(-1.3, 1.3),
       force=UNIT, rate=UNIT, size=st.tuples(st.floats(0.0, 5e-3), st.floats(0.0, 1.0)))
@example(roll=0.0, pitch=0.0, heading=0.0, lat=1.0, force=(0.0, 1.0, 0.0), rate=(0.0, 1.0, 0.0),
         size=(0.00390625, 1.0))
def test_level_within_bias_over_g_and_heading_within_bias_over_omega_cos_lat(
        roll, pitch, heading, lat, force, rate, size):
    """
    At any attitude and latitude the errors obey the equations of coarse alignment.

    tilt <= asin(b_a / |f|): adding a vector b_a to f rotates f by no more.
    heading <= b_g / (Omega cos lat) + tan(lat) b_a / g + second order, which is bounded by the
    square of both errors together.
    """
    q_nb = tuple(from_compass(roll, pitch, heading)[0].tolist())
    b_a = size[0] * np.array(force) / np.linalg.norm(force)
    b_g = size[1] * DEG_H * np.array(rate) / np.linalg.norm(rate)
    imu = resting(q_nb, lat, bias=(b_g, b_a))
    still = standstill.find_standstill(imu, AlignmentSettings())
    compass = alignment.gyrocompass(still, lat)
    tilt, azimuth = errors(compass.q_nb, q_nb)
    g = ellipsoid.gravity(math.sin(lat), 0.0)
    tilt_bound = math.asin(size[0] / (g - size[0]))
    first = size[1] * DEG_H / (OMEGA * math.cos(lat)) + math.tan(abs(lat)) * size[0] / g
    # The level part of a rotation vector of length d is d/2 / sin(d/2) times the tilt.
    half = 0.5 * math.hypot(tilt, azimuth)
    assert tilt <= tilt_bound * (half / math.sin(half) if half else 1.0) + 1e-12
    assert azimuth <= first + 2.0 * (first + tilt_bound) ** 2 + 1e-9


@settings(max_examples=100, deadline=None)
@given(roll=ANGLE, pitch=st.floats(-1.4, 1.4), heading=st.floats(0.0, 6.28))
def test_level_takes_the_given_heading(roll, pitch, heading):
    """An exact force and a given heading determine the whole attitude."""
    q_nb = from_compass(roll, pitch, heading)[0]
    force = np.array(quaternion.rotate_back(q_nb, (0.0, 0.0, 9.8)))
    back = to_compass(np.array(alignment.level_attitude(force, heading)))
    turn = Rotation.from_quat(q_nb).inv() * Rotation.from_quat(from_compass(*back)[0])
    assert turn.magnitude() < 1e-12


def test_a_vertical_forward_axis_has_no_heading():
    """If the forward axis is vertical, ValueError is raised, because there is no heading."""
    with pytest.raises(ValueError, match='forward axis is within 1 deg of the vertical'):
        alignment.level_attitude(np.array([9.8, 0.01, 0.0]), 0.0)


def test_the_standard_error_of_gyrocompassing_is_that_of_its_errors(capsys):
    """
    Over 200 seeds of white noise the normalised squared heading error has mean 1.

    The standard error is estimated from sine and cosine at five frequencies, so that the ratio is
    Student's t with 10 degrees of freedom: variance 10/8. Its sum over the seeds must be within
    the 99.9 % quantiles of chi-square with 200 degrees of freedom, widened by that variance.
    """
    lat, q_nb = 0.9, tuple(from_compass(0.1, -0.2, 1.0)[0].tolist())
    squares, sizes = [], []
    for seed in range(200):
        imu = resting(q_nb, lat, count=2000, rate_hz=100.0, noise=(1e-5, 1e-3), seed=seed)
        still = standstill.find_standstill(imu, AlignmentSettings())
        compass = alignment.gyrocompass(still, lat)
        e = quaternion.logarithm(quaternion.multiply(compass.q_nb, quaternion.conjugate(q_nb)))[2]
        squares.append((e / compass.sigma) ** 2)
        sizes.append(compass.sigma)
    mean = np.mean(squares) * 8.0 / 10.0
    with capsys.disabled():
        print(f'\ngyrocompassing, 200 seeds: standard error {math.degrees(np.mean(sizes)):.3f} '
              f'deg, normalised squared error {mean:.3f} (expected 1)')
    low, high = chi2.ppf([0.0005, 0.9995], 200) / 200
    assert low / 1.25 < mean < high * 1.25


def test_a_simulated_navigation_grade_imu_aligns_itself(capsys):
    """
    The shipped ring-laser preset at rest for 120 s at heading 77 deg aligns within its bounds.

    Bounds: the tilt is within the mean accelerometer error over g; the heading is within the mean
    gyro error over Omega cos(lat) plus tan(lat) times the tilt bound. Both mean errors are known,
    as reading minus truth. The heading is also within 3 standard errors plus that bias.
    """
    chosen = parameter_files.read([resources.config('imu_navigation_rlg')], [
        'motion.kind:=static', 'motion.psi_deg:=-77.0', 'motion.theta_deg:=3.0',
        'motion.gamma_deg:=-2.0', 'duration_s:=120.0', 'seed:=5', 'output:=integrated',
        'source:=motion', 'input:=integrated'])
    generator = chosen.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    blocks = list(imu_blocks(chosen, motion))
    t_ns, omega, f = (np.concatenate([getattr(b, n) for b in blocks])
                      for n in ('t_ns', 'omega', 'f'))
    truth = motion.at(t_ns)
    imu = RecordedImu(t_ns, omega, f, np.full((len(t_ns), 4), np.nan))
    still = standstill.find_standstill(imu, AlignmentSettings(longest_s=120.0))
    lat = float(truth.lat[0])
    compass = alignment.gyrocompass(still, lat)
    assert alignment.is_trusted(compass, still, lat, math.radians(2.0))
    tilt, azimuth = errors(compass.q_nb, tuple(truth.q_nb[0].tolist()))
    used = slice(still.first, still.last)
    b_a = np.linalg.norm((f - truth.f_ib_b)[used].mean(axis=0))
    b_g = np.linalg.norm((omega - truth.omega_ib_b)[used].mean(axis=0))
    level = b_a / ellipsoid.gravity(math.sin(lat), 0.0)
    bound = b_g / (OMEGA * math.cos(lat)) + math.tan(lat) * level
    with capsys.disabled():
        print(f'\nnavigation-grade IMU at rest {(still.end_ns - still.start_ns) * 1e-9:.0f} s: '
              f'tilt {math.degrees(tilt) * 3600:.2f} arcsec (b_a/g '
              f'{math.degrees(level) * 3600:.2f}), heading {math.degrees(azimuth):.4f} deg '
              f'(b_g/(Omega cos lat) + tan(lat) b_a/g {math.degrees(bound):.4f}), standard error '
              f'{math.degrees(compass.sigma):.4f}')
    assert tilt <= level * (1.0 + level) + 1e-12
    assert azimuth <= bound + 2.0 * (bound + level) ** 2


@pytest.mark.parametrize('bias, trust', [(0.0, True), (0.1, True), (5.0, False), (500.0, False)])
def test_gyros_too_coarse_are_not_trusted(bias, trust):
    """
    The heading is rejected if the bias that is visible would turn it by heading_sigma_deg.

    2 deg at latitude 50 deg correspond to 15.04 cos(50) sin(2) = 0.34 deg/h.
    """
    lat = math.radians(50.0)
    imu = resting((0.0, 0.0, 0.0, 1.0), lat, bias=(np.array([0.0, 0.0, bias * DEG_H]),
                                                   np.zeros(3)))
    still = standstill.find_standstill(imu, AlignmentSettings())
    compass = alignment.gyrocompass(still, lat)
    assert alignment.is_trusted(compass, still, lat, math.radians(2.0)) == trust


def test_the_bias_is_the_mean_rate_less_that_of_the_earth():
    """The gyro bias, mean rate minus Earth rate, is exact at any attitude."""
    lat, q_nb = -0.5, tuple(from_compass(2.0, 0.3, 4.0)[0].tolist())
    bias = np.array([1e-3, -2e-3, 3e-3])
    still = standstill.find_standstill(resting(q_nb, lat, bias=(bias, np.zeros(3))),
                                       AlignmentSettings())
    found = alignment.gyro_bias(still, q_nb, lat, OMEGA)
    assert np.abs(found - bias).max() < 1e-15


def moving(seconds_each, rate_hz=50.0, seed=3):
    """Return a record that alternates between rest and shaking, and the phases."""
    rng = np.random.default_rng(seed)
    parts = []
    for k, length in enumerate(seconds_each):
        n = round(length * rate_hz)
        shake = 1.0 if k % 2 else 0.01
        parts.append((0.1 * shake * rng.standard_normal((n, 3)),
                      [0.0, 0.0, 9.8] + shake * rng.standard_normal((n, 3))))
    omega, f = (np.concatenate(x) for x in zip(*parts))
    t_ns = np.arange(len(f), dtype=np.int64) * round(1e9 / rate_hz)
    return RecordedImu(t_ns, omega, f, np.full((len(f), 4), np.nan))


def test_the_standstill_is_found_where_it_is():
    """The first standstill that is long enough is found, and no more of it than is needed."""
    imu = moving([3.0, 4.0, 20.0, 5.0, 40.0])
    limits = AlignmentSettings()
    still = standstill.find_standstill(imu, limits)
    assert (still.start_ns, still.last - still.first) == (7_000_000_000, 1000)
    assert standstill.find_standstill(imu, AlignmentSettings(longest_s=8.0)).windows == 8
    assert standstill.find_standstill(imu, limits, longest=True).start_ns == 32_000_000_000
    with pytest.raises(ValueError, match='no stationary interval of 50 s in 72 s: the longest '
                                         'has 40 s'):
        standstill.find_standstill(imu, AlignmentSettings(shortest_s=50.0, longest_s=60.0))


def test_uniform_motion_is_no_standstill_where_the_reference_moves():
    """An IMU cannot tell rest from uniform motion; the speed of the reference can."""
    imu = moving([20.0])
    with pytest.raises(ValueError, match='in 20 quiet windows the reference moves faster'):
        standstill.find_standstill(imu, AlignmentSettings(), lambda t: np.full(len(t), 11.0))
    still = standstill.find_standstill(imu, AlignmentSettings(),
                                       lambda t: np.where(t < 5e9, 11.0, np.nan))
    assert still.start_ns == 5_000_000_000


def test_a_tilt_between_two_quiet_windows_ends_the_standstill():
    """If the IMU is tilted during a gap, the standstill ends: the means of both sides differ."""
    imu = moving([20.0])
    force = np.where((imu.t_ns >= 10_000_000_000)[:, None], [1.0, 0.0, 9.75], imu.f)
    still = standstill.find_standstill(replace(imu, f=force), AlignmentSettings())
    assert still.windows == 10


@settings(max_examples=100, deadline=None)
@given(force=UNIT, yaw=ANGLE)
def test_levelling_the_mounting_brings_the_force_up(force, yaw):
    """Levelling uses the shortest rotation, whose axis is level."""
    q = mounting.levelled_mounting(np.array(force), yaw)
    up = np.array(quaternion.rotate(q, tuple(force))) / np.linalg.norm(force)
    assert np.abs(up - [0.0, 0.0, 1.0]).max() < 1e-12
    shortest = quaternion.logarithm(mounting.levelled_mounting(np.array(force), 0.0))
    assert abs(shortest[2]) < 1e-9


def test_mounting_angles_are_those_of_urdf():
    """Mounting angles are rotations about fixed axes x, y, z, as SciPy's 'xyz' and URDF."""
    q = angles.from_rpy(0.3, -0.7, 2.0)
    assert np.abs(np.array(q) - Rotation.from_euler('xyz', [0.3, -0.7, 2.0]).as_quat()).max() \
        < 1e-15


def test_the_chain_of_transforms():
    """Transforms are chained up and down the tree; the message for a wrong name states which."""
    a, b, c = (tuple(q) for q in Rotation.random(3, random_state=1).as_quat())
    tree = {('base_link', 'mast'): a, ('mast', 'imu'): b, ('base_link', 'gnss'): c}
    assert mounting.chained_mounting({}, 'base_link', 'imu') is None
    expected = Rotation.from_quat(a) * Rotation.from_quat(b)
    found = Rotation.from_quat(mounting.chained_mounting(tree, 'base_link', 'imu'))
    assert (found.inv() * expected).magnitude() < 1e-14
    found = Rotation.from_quat(mounting.chained_mounting(tree, 'imu', 'gnss'))
    assert (found.inv() * expected.inv() * Rotation.from_quat(c)).magnitude() < 1e-14
    with pytest.raises(ValueError, match="no frame 'imu2'; the nearest is 'imu'"):
        mounting.chained_mounting(tree, 'base_link', 'imu2')
    with pytest.raises(ValueError, match="does not connect 'base_link' with 'far'"):
        mounting.chained_mounting({**tree, ('elsewhere', 'far'): a}, 'base_link', 'far')
