"""Run k of an ensemble is the single run k, to the bit, for any distribution of the work."""

from dataclasses import replace

import numpy as np
import pytest

from ins_sim import parameter_files, resources
from ins_sim.core.ensemble import group, many_runs
from ins_sim.core.numerics import compilation
from ins_sim.core.simulation.inertial import ideal_blocks, simulate
from ins_sim.io.motion import read_motion
from support.studies import LATE_MOTION_2

NOISY = ('imu_tactical_fog',)
LAGGED = ('accelerometer.errors.bandwidth_hz:=[20.0, 0.0, 30.0]',
          'gyro.errors.quantisation_arcsec:=[0.1, 0.1, 0.0]')


def settings_of(*assignments, names=LATE_MOTION_2, seconds=12.0):
    """Return SimulationSettings of shipped files."""
    return parameter_files.read([resources.parameter_file(name) for name in names],
                                [f'duration_s:={seconds}', *assignments])


def drawn_initial(settings):
    """Return a function of the run number that returns other initial errors for each run."""
    def initial(run):
        a, b, c = np.random.default_rng(run).normal(size=(3, 3))
        return replace(settings.strapdown.initial, attitude_error_deg=tuple((0.1 * a).tolist()),
                       velocity_error_m_s=tuple(b.tolist()), position_error_m=tuple(c.tolist()))

    return initial


def single(settings, motion, run, initial=None):
    """Return the SimulationResult of a run."""
    if initial is not None:
        settings = replace(settings, strapdown=replace(settings.strapdown, initial=initial(run)))
    return simulate(settings.with_run(run), motion, twin=False)


def errors_of(result):
    """Return the errors of a SimulationResult, nine columns."""
    errors = result.errors
    return np.concatenate([errors.attitude, errors.velocity, errors.position], axis=1)


@pytest.mark.parametrize('names, assignments', [
    (LATE_MOTION_2, ('vertical.channel:=truth',)),
    ((*LATE_MOTION_2, *NOISY), ('vertical.channel:=free', 'initial.after_s:=1.003')),
    (('cruise', 'delays_2_1_3us', *NOISY),
     ('vertical.channel:=damped', 'input:=integrated', 'output:=integrated')),
    ((*LATE_MOTION_2, *NOISY), LAGGED)])
def test_a_lane_is_the_single_run(names, assignments):
    """
    A run computed beside others has the solution and errors of the single run.

    This holds for every vertical channel.
    """
    settings = settings_of(*assignments, names=names)
    motion, initial = read_motion(settings.motion_generator), drawn_initial(settings)
    found = many_runs.simulate_runs(settings, motion, range(5, 22), [2.0, 7.003, 12.0],
                                    initial=initial)
    assert found.diverged == () and found.statistics.count.tolist() == [17] * 3
    for k in (0, 7, 16):
        one = single(settings, motion, 5 + k, initial)
        states = one.states
        assert found.final[k, 0] == states.lat[-1] and found.final[k, 1] == states.lon[-1]
        assert found.final[k, 2] == states.height[-1]
        np.testing.assert_array_equal(found.final[k, 3:6], states.v_n[-1])
        np.testing.assert_array_equal(found.final[k, 6:], states.q_nb[-1])
        np.testing.assert_array_equal(found.final_errors[k], errors_of(one)[-1])


def same(a, b):
    """Assert that two EnsembleResults are the same to the bit."""
    np.testing.assert_array_equal(a.t_ns, b.t_ns)
    np.testing.assert_array_equal(a.final, b.final)
    np.testing.assert_array_equal(a.final_errors, b.final_errors)
    for one, other in zip(a.statistics.moments, b.statistics.moments):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(a.statistics.histogram, b.statistics.histogram)
    assert a.diverged == b.diverged


@pytest.mark.parametrize('count', [0, 1, 15, 16, 17, 1000])
def test_any_number_of_runs_and_of_threads(count):
    """One and two threads give the same bits; a run does not depend on the number of runs."""
    settings = settings_of('rate_hz:=20.0', names=(*LATE_MOTION_2, *NOISY), seconds=3.0)
    motion = read_motion(settings.motion_generator)
    one, two = (many_runs.simulate_runs(settings, motion, range(count), [1.0, 3.0],
                                        threads=threads) for threads in (1, 2))
    same(one, two)
    assert one.statistics.count.tolist() == [count] * 2 and len(one.final) == count
    if count:
        last = single(settings, motion, count - 1)
        np.testing.assert_array_equal(one.final_errors[-1], errors_of(last)[-1])


def test_plain_python_gives_the_same_bits():
    """Plain Python and compiled loops give the same bits."""
    settings = settings_of(names=(*LATE_MOTION_2, *NOISY), seconds=7.0)
    motion = read_motion(settings.motion_generator)
    usual = many_runs.simulate_runs(settings, motion, range(3), [7.0])
    with compilation.plain_only():
        same(many_runs.simulate_runs(settings, motion, range(3), [7.0]), usual)


def test_instants_and_their_statistics():
    """The statistics are those of the errors of the single runs at the requested instants."""
    settings = settings_of('initial.after_s:=0.5', names=(*LATE_MOTION_2, *NOISY), seconds=4.0)
    motion, runs = read_motion(settings.motion_generator), range(20)
    found = many_runs.simulate_runs(settings, motion, runs, [4.0, 0.1, 1.995, 1.995])
    flown = [single(settings, motion, run) for run in runs]
    stamps = flown[0].errors.t_ns
    assert found.t_ns.tolist() == [stamps[0], 2_000_000_000, 4_000_000_000]
    rows = np.searchsorted(stamps, found.t_ns)
    errors = np.stack([errors_of(one)[rows] for one in flown], axis=1)
    np.testing.assert_allclose(found.statistics.mean, errors.mean(axis=1), rtol=1e-12, atol=1e-18)
    for k in range(len(rows)):
        np.testing.assert_allclose(found.statistics.covariance[k], np.cov(errors[k].T),
                                   rtol=1e-9, atol=1e-18)


def test_cutting_and_a_lost_lane_change_no_other():
    """Blocks of any length give the same states, also beside a run that has diverged."""
    settings = settings_of('vertical.channel:=free', names=(*LATE_MOTION_2, *NOISY))
    motion = read_motion(settings.motion_generator)
    imu = next(ideal_blocks(settings, motion))
    truth, rng = motion.at(imu.t_ns), np.random.default_rng(4)
    last, none = np.array([len(imu) - 1]), np.array([], dtype=int)
    whole, parts = (group.Group(settings, range(11)) for _ in range(2))
    errors = whole.advance(imu, imu.t_ns, truth, last)
    assert np.isfinite(errors).all()
    ends = [0, *np.sort(rng.choice(np.arange(1, len(imu)), 5, replace=False)).tolist(), len(imu)]
    for number, (first, end) in enumerate(zip(ends, ends[1:])):
        part, at_end = slice(first, end), end == len(imu)
        cut = parts.advance(imu[part], imu.t_ns[part], truth[part],
                            last - first if at_end else none)
        if number == 2:
            parts._state[3, 4] = np.nan
    assert whole.diverged == () and parts.diverged == (4,)
    others = np.arange(11) != 4
    np.testing.assert_array_equal(cut[:, others], errors[:, others])
    assert np.isnan(cut[:, 4]).all() and np.isnan(parts.final(truth[-1:])[0][4]).all()
