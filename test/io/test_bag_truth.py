"""The truth in a bag is a motion that agrees with the run from which it was recorded."""

from dataclasses import replace
import math

import numpy as np
import pytest
from support.studies import FLIGHT, MOTION_2, run_offline, settings

from ins_sim.io import bag_truth, simulated
from ins_sim.io.motion import read_motion
from ins_sim.io.published import read_errors
from ins_sim.core.attitude import quaternion
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.recorded.spline import PAD_S, RecordedMotion
from ins_sim.core.simulation.inertial import imu_blocks, simulate
from ins_sim.messages import topics
from support.bags.truth_bags import record, recorded

SECOND = 1_000_000_000
STUDIES = {'motion 2': MOTION_2, 'cruise': {**FLIGHT, 'motion.kind': 'cruise'},
           'aggressive': {**FLIGHT, 'motion.kind': 'aggressive'}}


def bounds(steps, length_s):
    """
    Return bounds for the difference of two runs due to rounding: position, m, and drift, rad/s.

    The quaternions of a sample round by u = 2^-53 in each component, which rotates by 2 u; for
    both runs and the step this is less than 8 u in each sample, a random walk of W = 8 u sqrt(N).
    The slope of a signal within W is below 3 W / T, and a tilt of W moves the position by at most
    g W T^2 / 2. The latitude of either strapdown rounds by 2 u at every step: four standard
    deviations of that walk.
    """
    walk = 8.0 * 2.0 ** -53 * math.sqrt(steps)
    place = 4.0 * math.sqrt(2.0 * steps / 12.0) * 2.0 ** -53 * 6.4e6
    return 5.0 * walk * length_s ** 2 + place, 3.0 * walk / length_s


@pytest.mark.parametrize('name', STUDIES)
def test_the_run_on_the_bag_closes_to_the_original_run(name, tmp_path):
    """
    A run with delays has the same errors on the original motion and on its truth in a bag.

    The bag has 100 Hz. The attitude at a sample minus the delay tau errs by tau^2 h^2 / 24 of its
    fourth derivative, at most 2e-14 rad here: the rest is rounding (``bounds``).
    """
    values, length_s = STUDIES[name], 300.0
    original = settings(values, start_s=PAD_S, duration_s=length_s)
    run = run_offline(original, twin=False)
    bag = tmp_path / 'bag'
    simulated.write_bag(bag, settings(values, duration_s=length_s + 2.0 * PAD_S), run,
                        topics.TRUTH)
    again = recorded(bag, values, duration_s=length_s)
    errors = simulate(again, twin=False, motion=read_motion(again.motion_generator)).errors
    off = np.abs(errors.position - run.errors.position).max()
    drift = np.linalg.norm(errors.drift[-1] - run.errors.drift[-1])
    size = np.linalg.norm(run.errors.drift[-1])
    place, slope = bounds(100.0 * length_s, length_s)
    print(f'\n{name}, {length_s:g} s: position error {np.abs(run.errors.position).max():.4g} m, '
          f'off by {off:.2e} m (bound {place:.1e}); drift '
          f'{size:.4g} rad/s, off by {drift:.2e} (bound {slope:.1e}), relative '
          f'{drift / size:.1e}')
    assert off < place
    assert drift < slope


@pytest.mark.parametrize('rate_hz', (10.0, 20.0))
def test_between_the_samples_the_attitude_errs_by_the_fourth_order(rate_hz, tmp_path):
    """
    Between samples the attitude errs by h^4 / 384 of the fourth derivative (cubic Hermite).

    On the aggressive flight the components of the rotation vector are those of the angles, 25, 6
    and 5 deg at 1/7, 1/5 and 1/6 Hz, and of the turns of the path; twice their sum covers the
    products of the angles. The rotation spline through attitudes alone has the same order, and end
    effects.
    """
    values = {'motion.kind': 'aggressive'}
    motion = record(tmp_path / 'bag', values, 60.0, rate_hz)
    chosen = recorded(tmp_path / 'bag', values).motion_generator
    poses = bag_truth.read_poses(tmp_path / 'bag', 'auto', chosen.datum)
    bare = RecordedMotion(replace(poses, omega_nb_b=None), chosen.motion.recording, chosen.earth)
    t_ns = np.arange(0, 54 * SECOND, SECOND // 73)
    wanted, found, splined = motion.at(t_ns + 3 * SECOND), read_motion(chosen).at(t_ns), \
        bare.at(t_ns)
    angle, spline = (2.0 * np.linalg.norm(quaternion.multiply(
        quaternion.conjugate(x.q_nb.T), wanted.q_nb.T)[:3], axis=0).max()
        for x in (found, splined))
    fourth = sum(math.radians(a) * (2.0 * math.pi * f) ** 4
                 for a, f in ((25.0, 1 / 7), (6.0, 1 / 5), (5.0, 1 / 6)))
    bound = 2.0 * fourth / rate_hz ** 4 / 384.0
    print(f'\n{rate_hz:g} Hz: {angle:.2e} rad with the rates, {spline:.2e} without (bound '
          f'{bound:.1e})')
    assert angle < bound


def test_what_was_recorded_comes_out_at_its_stamps(tmp_path):
    """At the samples values agree to the rounding of degrees, quaternions, and sums: 1e-16."""
    values = STUDIES['aggressive']
    motion = record(tmp_path / 'bag', values, 60.0)
    again = read_motion(recorded(tmp_path / 'bag', values).motion_generator)
    t_ns = np.arange(-300, 5401) * (SECOND // 100)
    x, y = again.at(t_ns), motion.at(t_ns + 3 * SECOND)
    assert again.end_s == pytest.approx(54.0) and again.warnings == []
    assert np.abs(x.lat - y.lat).max() < 3e-16 and np.abs(x.lon - y.lon).max() < 3e-16
    assert np.abs(x.q_nb - y.q_nb).max() < 1e-15
    assert np.abs(x.omega_ib_b - y.omega_ib_b)[300:-300].max() < 1e-9


@pytest.mark.parametrize('output', ('rotation_vector', 'integrated'))
def test_a_paced_imu_senses_the_bag(output, tmp_path):
    """With source motion the node reads the bag with the bits of the offline run."""
    values = {**STUDIES['aggressive'], 'output': output, 'input': output}
    record(tmp_path / 'bag', values, 16.0)
    chosen = recorded(tmp_path / 'bag', values, duration_s=5.0)
    motion = read_motion(chosen.imu_sensor)
    imu, frame = make_imu(chosen.imu_sensor, motion), MapFrame(chosen.imu_sensor.datum, True)
    truth = motion.at(np.arange(501) * (SECOND // 100))
    readings = [r for sample in zip(truth.t_ns.tolist(), frame.attitude(truth).tolist(),
                                    truth.omega_ib_b.tolist(), truth.f_ib_b.tolist())
                for r in imu.push(*sample)]
    offline = next(iter(imu_blocks(chosen, motion)))
    assert len(readings) == len(offline) == 501
    assert np.array_equal([r[1] for r in readings], offline.omega)
    assert np.array_equal([r[2] for r in readings], offline.f)


def test_odometry_alone_needs_the_datum(tmp_path):
    """An Odometry topic given by name, as of another simulator, gives the motion to 1e-9 m."""
    values = STUDIES['aggressive']
    motion = record(tmp_path / 'bag', values, 30.0, only=(topics.TRUTH_ODOMETRY,),
                    prefix='/robot/ground_')
    chosen = recorded(tmp_path / 'bag', values, **{
        'motion.recording.topic': 'robot/ground_truth/odometry'})
    t_ns = np.arange(0, 24 * SECOND, SECOND // 7)
    x, y = read_motion(chosen.motion_generator).at(t_ns), motion.at(t_ns + 3 * SECOND)
    # 1e-9 m relative to 6.4e6 m.
    assert np.abs(x.lat - y.lat).max() < 1e-15 and np.abs(x.height - y.height).max() < 1e-8
    assert np.abs(x.q_nb - y.q_nb).max() < 1e-10


def test_a_namespace_and_a_file_of_a_bag(tmp_path):
    """The only topic that ends in truth/odometry is used; if there are two, one must be given."""
    record(tmp_path / 'bag', MOTION_2, 10.0, prefix='/left/')
    chosen = recorded(tmp_path / 'bag' / 'bag_0.mcap', MOTION_2)
    assert read_motion(chosen.motion_generator).end_s == pytest.approx(4.0)


@pytest.mark.live
def test_nodes_play_and_sense_the_bag(ros_domain, tmp_path):
    """
    Live, the generator plays the bag and the IMU with source motion evaluates it, in lock-step.

    The bound is that of the offline comparison.
    """
    pytest.importorskip('rclpy')
    from ins_sim.settings.node import Pacing
    from ins_sim.ros.session import Session
    values = {**STUDIES['aggressive'], 'duration_s': 20.0, 'time.epoch_s': 100}
    record(tmp_path / 'truth', values, 26.0)
    chosen = recorded(tmp_path / 'truth', values)
    offline = simulate(chosen, twin=False, motion=read_motion(chosen.motion_generator)).errors
    pacing = Pacing(real_time_factor=0.0, lock_step=True, required=('strapdown', 'recorder'))
    chosen = replace(chosen, motion_generator=replace(chosen.motion_generator, pacing=pacing))
    told_s = []
    with Session(chosen, tmp_path, tmp_path / 'bag', 'truth_bag') as session:
        session.run(told_s.append)
    # Motion time of the run, whatever the epoch of the stamps.
    assert told_s == sorted(told_s) and 0.0 < told_s[-1] <= values['duration_s']
    live = read_errors(tmp_path / 'bag', 'truth_bag')
    off = np.abs(live.position - offline.position).max()
    print(f'\nlive against offline, 20 s: {off:.2e} m of {np.abs(offline.position).max():.3g} m')
    assert np.array_equal(live.t_ns, offline.t_ns + 100 * SECOND)
    assert off < bounds(2000, 20.0)[0]
