"""The strapdown on samples of any rate: orders of truncation, gaps, faults of the record."""

from dataclasses import replace
import math

from hypothesis import given, settings, strategies as st
import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid, frames
from ins_sim.core.navigation import mechanization
from ins_sim.core.postprocessing.comparison import compare_with_reference, error_rows
from ins_sim.core.navigation.increments import uneven_increments
from ins_sim.core.navigation.recorded import RecordedNavigator
from ins_sim.core.navigation.vertical_channel import FREE
from ins_sim.core.motion.factory import make_motion
from ins_sim.settings.navigate import NAVIGATE, NavigateSettings
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.postprocessing.reference import Reference, SampledTrack
from ins_sim.settings.motion import MotionGeneratorSettings
from ins_sim.settings.catalogue import build
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim import parameter_files
from support.studies import run_offline
from support.readings.recorded_imu import end_errors, recorded, run, stamps

SETTINGS = parameter_files.read([], ['motion.kind:=sinusoids', 'source:=motion'])
MOTION = make_motion(SETTINGS.motion_generator.motion, SETTINGS.motion_generator.datum,
                     SETTINGS.motion_generator.earth)
AIR = {'initial.attitude': 'reference'}
SECOND = 1_000_000_000


def test_instant_samples_converge_with_the_square_of_the_step(capsys):
    """
    The trapezoidal rule is of second order: half the step gives a quarter of the error.

    The order is estimated from 50, 100, 200 and 400 Hz over 20 s of six sinusoids; it must be 2
    within 0.15, which allows for the fourth-order terms at the coarsest step.
    """
    position, turn = np.array([end_errors(run(*recorded(stamps(r))))
                               for r in (50.0, 100.0, 200.0, 400.0)]).T
    orders = np.log2(position[:-1] / position[1:]), np.log2(turn[:-1] / turn[1:])
    with capsys.disabled():
        print(f'\nposition error after 20 s at 50, 100, 200, 400 Hz: '
              f'{", ".join(f"{p:.3g}" for p in position)} m, orders '
              f'{", ".join(f"{o:.3f}" for o in orders[0])}; attitude orders '
              f'{", ".join(f"{o:.3f}" for o in orders[1])}')
    assert np.abs(np.array(orders) - 2.0).max() < 0.15


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10000), lost=st.floats(0.0, 0.3))
def test_jitter_and_drop_outs_cost_no_more_than_the_longest_steps(seed, lost):
    """
    Jittering stamps and lost samples cost at most as much as the longest steps.

    Each sample has its own true value. The error of the trapezoidal rule over steps dt_k is
    bounded by C sum(dt_k^3). C is taken from the uniform 100 Hz run, times ten, because signed
    errors cancel there and need not do so here.
    """
    t_ns = stamps(100.0)
    uniform, _ = end_errors(run(*recorded(t_ns)))
    rng = np.random.default_rng(seed)
    t_ns = t_ns + rng.integers(-4_000_000, 4_000_000, len(t_ns))
    t_ns = t_ns[np.append(rng.random(len(t_ns) - 1) > lost, True)]
    got, _ = end_errors(run(*recorded(t_ns), gap_factor=1000.0))
    cubes = (np.diff(t_ns) * 1e-9) ** 3
    assert got < 10.0 * uniform * cubes.sum() / (2000 * 0.01 ** 3)


def test_straight_lines_of_rate_and_force_are_stepped_alike_by_means_and_by_instants():
    """
    For w = a + b t, f = c + d t the increments from means equal those from instant values.

    This interval and the previous one are unequal, so that the scaling of the earlier mean is
    tested. Both are exact to third order in dt and differ by rounding.
    """
    a, b, c, d = np.random.default_rng(4).standard_normal((4, 3))
    before, now = 0.013, 0.007

    def mean(x, y, start, end):
        return tuple((x + y * (0.5 * (start + end))).tolist())

    means = uneven_increments('integrated', (mean(a, b, -before, 0.0), mean(c, d, -before, 0.0)),
                              (mean(a, b, 0.0, now), mean(c, d, 0.0, now)), now, before)
    ends = uneven_increments('instant', (tuple(a.tolist()), tuple(c.tolist())),
                             (mean(a, b, now, now), mean(c, d, now, now)), now, before)
    assert np.abs(np.array(means) - np.array(ends)).max() < 1e-16
    # The coning of the interval in closed form is b x a dt^3 / 12, with the sign of a x b.
    alpha = np.array(mean(a, b, 0.0, now)) * now
    assert np.abs(np.array(ends[0]) - alpha - np.cross(a, b) * now ** 3 / 12.0).max() < 1e-16


def test_the_loop_closes_on_the_simulated_imu(capsys):
    """
    The output of imu_sensor, in both modes, navigates back to the truth.

    Bound: the error of the offline strapdown on the same samples, times 1.01 for the different
    start.
    """
    shown = []
    for mode in ('rotation_vector', 'integrated'):
        chosen = parameter_files.read([], [
            'motion.kind:=sinusoids', 'source:=motion', 'duration_s:=60.0', f'output:={mode}',
            f'input:={mode}', 'vertical.channel:=free'])
        blocks = list(imu_blocks(chosen, MOTION))
        t_ns, omega, f = (np.concatenate([getattr(x, n) for x in blocks])
                          for n in ('t_ns', 'omega', 'f'))
        _, reference = recorded(t_ns)
        got = run(RecordedImu(t_ns, omega, f, np.full((len(t_ns), 4), np.nan)), reference,
                  input=mode)
        ours = got.comparisons[0].position.values
        theirs = run_offline(chosen, twin=False).errors.position
        shown.append(f'{mode} {np.abs(ours).max():.3g} m (simulate {np.abs(theirs).max():.3g})')
        assert np.abs(ours - theirs).max() < 0.01 * np.abs(theirs).max() + 1e-8
    with capsys.disabled():
        print('\nlargest position error in 60 s: ' + '; '.join(shown))


def test_the_damped_channel_follows_the_height_of_the_reference():
    """
    With an upward accelerometer bias at rest the free channel falls, the damped one does not.

    The third-order loop has no final offset, because its integrator compensates the bias. Free: b
    t^2 / 2 within the effect of the gravity gradient, 1 + (2 g / R) t^2 / 12.
    """
    lat, b = 0.7, 0.01
    g = ellipsoid.gravity(math.sin(lat), 0.0)
    t_ns = stamps(20.0, 300.0, 0.0)
    n = len(t_ns)
    rate = (0.0, ellipsoid.ROTATION_RATE * math.cos(lat), ellipsoid.ROTATION_RATE * math.sin(lat))
    # A compass heading of 90 deg is the identity quaternion in ENU.
    imu = RecordedImu(t_ns, np.tile(rate, (n, 1)), np.tile([0.0, 0.0, g + b], (n, 1)),
                      np.full((n, 4), np.nan))
    reference = Reference('truth', SampledTrack(t_ns, np.tile([lat, 0.0, 0.0], (n, 1))),
                          SampledTrack(t_ns, np.zeros((n, 3))),
                          SampledTrack(t_ns, np.tile([0.0, 0.0, 0.0, 1.0], (n, 1))))
    free = run(imu, reference).comparisons[0].position.values[-1, 2]
    damped = run(imu, reference, vertical__channel='damped').comparisons[0].position.values[:, 2]
    growth = 1.0 + 2.0 * g / ellipsoid.SEMI_MAJOR * 300.0 ** 2 / 12.0
    assert abs(free / (0.5 * b * 300.0 ** 2) - growth) < 1e-3
    # Triple pole at -1/20 s: after 300 s = 15 time constants, e^-15 (15^2 / 2) b 20^2.
    assert abs(damped[-1]) < 4.0 * math.exp(-15.0) * 112.5 * b * 400.0
    assert np.abs(damped).max() < b * 400.0


def test_the_rows_are_the_errors_at_their_instants():
    """A run of 20 s has error rows at 10 s and at its end, and none beyond."""
    imu, reference = recorded(stamps(100.0))
    got = run(imu, reference)
    table = error_rows(got.comparisons[0], int(imu.t_ns[0]), int(imu.t_ns[-1]))
    assert [r.after_s for r in table] == [10.0, 20.0]
    p = got.comparisons[0].position.values[1000]
    assert table[0].horizontal_m == math.hypot(p[0], p[1]) and table[0].vertical_m == p[2]
    empty = Reference('empty', SampledTrack(np.array([5, 6]), np.zeros((2, 3))))
    assert compare_with_reference(got.states, empty) is None


def test_heading_error_is_clockwise():
    """A solution that is rotated right by 1 deg has a heading error of +1 deg."""
    imu, reference = recorded(stamps(100.0, 1.0))
    turned = quaternion.multiply(quaternion.exponential((0.0, 0.0, math.radians(-1.0))),
                                 reference.attitude.values.T)
    wrong = replace(reference, attitude=SampledTrack(imu.t_ns, np.stack(turned, axis=-1)))
    got = run(imu, wrong)
    shown = compare_with_reference(got.states, reference)
    assert abs(error_rows(shown, int(imu.t_ns[0]), int(imu.t_ns[-1]))[-1].heading_deg - 1.0) < 1e-3


def test_the_sections_name_the_settings():
    """NavigateSettings are one section, and their defaults are valid."""
    assert build(NAVIGATE['navigate'], {}) == NavigateSettings()
    assert MotionGeneratorSettings().earth == NavigateSettings().earth


def test_free_navigation_is_the_kernel_of_the_strapdown():
    """One step equals mechanization.advance on the increments, to the bit."""
    imu, _ = recorded(stamps(100.0, 0.01))
    truth = MOTION.at(imu.t_ns)
    state = (float(truth.lat[0]), float(truth.lon[0]), float(truth.height[0]),
             tuple(truth.v_n[0].tolist()), tuple(truth.q_nb[0].tolist()))
    samples = [(tuple(w), tuple(f)) for w, f in zip(imu.omega.tolist(), imu.f.tolist())]
    spin = ellipsoid.ROTATION_RATE
    nav = RecordedNavigator('instant', spin, state)
    nav.step(int(imu.t_ns[0]), *samples[0])
    solution = nav.step(int(imu.t_ns[1]), *samples[1])
    _, u = uneven_increments('instant', *samples, 0.01, 0.01)
    q_ib = frames.inertial_attitude(state[0], state[1], state[4])
    place = mechanization.advance(mechanization.begin(*state[:4], 0.0), q_ib, u, 0.01, spin, 0.0,
                                  FREE, (0.0, 0.0, 0.0, 0.0, 0.0))
    assert solution[:4] == (*place[:3], place[3:6])
