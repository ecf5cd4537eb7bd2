"""Runs that cannot be computed side by side are simulated one by one, with equal statistics."""

from ins_sim import parameter_files, resources
from ins_sim.core.ensemble.many_runs import in_lanes, simulate_runs
from ins_sim.core.ensemble.one_by_one import simulate_each
from ins_sim.core.ensemble.result import joined, of_arrays
from ins_sim.core.simulation.guided_flight import fly
from ins_sim.core.simulation.inertial import simulate
from ins_sim.io.motion import read_motion
import numpy as np
import pytest


def settings_of(*names_and_assignments):
    """Return SimulationSettings of 4 s from shipped files and assignments."""
    names = [word for word in names_and_assignments if ':=' not in word]
    return parameter_files.read([resources.parameter_file(name) for name in names],
                                ['duration_s:=4.0', *(word for word in names_and_assignments
                                                      if ':=' in word)])


def same(a, b):
    """Assert that two EnsembleResults have the same bits."""
    one, other = a.arrays(), b.arrays()
    assert one.keys() == other.keys()
    for name in one:
        np.testing.assert_array_equal(one[name], other[name], err_msg=name)


def test_both_ways_give_the_same_bits():
    """Settings that allow both give the same bits side by side and one by one."""
    settings = settings_of('racetrack', 'imu_tactical_fog', 'initial.after_s:=0.5')
    motion, instants = read_motion(settings.motion_generator), np.array([0.1, 1.0, 2.5, 4.0])
    assert in_lanes(settings)
    one = simulate_runs(settings, motion, range(3, 21), instants)
    other = simulate_each(settings, motion, range(3, 21), (1e9 * instants).astype(int))
    assert one.t_ns.tolist() == [500_000_000, 1_000_000_000, 2_500_000_000, 4_000_000_000]
    same(one, other)


@pytest.mark.parametrize('words', [
    ('racetrack', 'imu_tactical_dtg'),
    ('racetrack', 'imu_tactical_fog', 'orientation:=poisson'),
    ('racetrack', 'imu_tactical_fog', 'sampling.drop_out_probability:=0.01'),
    ('guided_flight', 'imu_tactical_mems', 'guidance.topic:=ins/odometry')],
    ids=['tuned gyros', 'poisson', 'drop-outs', 'guided'])
def test_each_run_is_the_single_run(words):
    """Each run of an ensemble has the bits of the single run, and runs differ."""
    settings = settings_of(*words)
    motion, runs = read_motion(settings.motion_generator), range(2, 5)
    assert not in_lanes(settings)
    found = simulate_runs(settings, motion, runs, [2.0, 4.0])
    assert found.statistics.count.tolist() == [3, 3] and found.diverged == ()
    middle = []
    for k, run in enumerate(runs):
        chosen, own = settings.with_run(run), read_motion(settings.motion_generator)
        fly(chosen, own)
        alone = simulate(chosen, own, twin=False)
        np.testing.assert_array_equal(found.final_errors[k, 6:], alone.errors.position[-1])
        np.testing.assert_array_equal(found.final_errors[k, 0:3], alone.errors.attitude[-1])
        np.testing.assert_array_equal(found.final[k, 6:], alone.states.q_nb[-1])
        row = np.searchsorted(alone.errors.t_ns, 2_000_000_000)
        middle.append(alone.errors.position[row])
        assert dict(found.restarted).get(run, 0) == len(alone.faults)
    np.testing.assert_allclose(found.statistics.mean[0, 6:], np.mean(middle, axis=0), rtol=1e-12,
                               atol=1e-15)
    assert len({row.tobytes() for row in found.final_errors}) == 3
    assert bool(found.restarted) == ('sampling.drop_out_probability:=0.01' in words)


def test_statistics_that_have_travelled_are_the_same():
    """Blocks that are joined in order have the statistics and ends of the whole ensemble."""
    settings = settings_of('racetrack', 'imu_tactical_fog')
    motion, instants = read_motion(settings.motion_generator), [0.0, 2.0, 4.0]
    whole = simulate_runs(settings, motion, range(40), instants)
    parts = [of_arrays(simulate_runs(settings, motion, runs, instants).arrays())
             for runs in (range(32), range(32, 40))]
    both = joined(parts)
    same(of_arrays(whole.arrays()), whole)
    for name in ('final', 'final_errors', 't_ns'):
        np.testing.assert_array_equal(getattr(both, name), getattr(whole, name))
    np.testing.assert_array_equal(both.statistics.histogram, whole.statistics.histogram)
    np.testing.assert_array_equal(both.horizontal.histogram, whole.horizontal.histogram)
    np.testing.assert_allclose(both.statistics.mean, whole.statistics.mean, rtol=1e-9, atol=1e-15)
    with pytest.raises(ValueError, match='cannot be joined'):
        joined(parts[::-1])


def test_horizontal_sizes_are_counted():
    """Horizontal errors have the rms of both axes, and percentiles within one bin of the runs'."""
    settings = settings_of('racetrack', 'imu_tactical_mems')
    found = simulate_runs(settings, read_motion(settings.motion_generator), range(200), [4.0])
    sizes = np.hypot(found.final_errors[:, 6], found.final_errors[:, 7])
    assert found.horizontal.rms[0, 2] == pytest.approx(np.sqrt(np.mean(sizes ** 2)), rel=1e-12)
    both = found.statistics.rms[0, 6:8]
    assert found.horizontal.rms[0, 2] == pytest.approx(np.hypot(*both), rel=1e-12)
    for percent in (5, 50, 95):
        ranked = np.sort(sizes)
        k = round(2.0 * percent)
        low, high = ranked[k - 2], ranked[min(k + 1, 199)]
        assert low / 1.032 <= found.horizontal.percentile(percent)[0, 2] <= high * 1.032
    # The vertical channel follows the truth.
    assert found.statistics.percentile(50)[0, 8] == 0.0


def test_runs_without_output_are_refused():
    """Runs without output are refused with one message, also one by one."""
    settings = settings_of('racetrack', 'orientation:=poisson', 'initial.after_s:=5.0')
    with pytest.raises(ValueError, match='no navigation output'):
        simulate_runs(settings, read_motion(settings.motion_generator), range(2), [1.0])
