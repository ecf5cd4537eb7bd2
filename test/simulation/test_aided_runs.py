"""Aided runs computed side by side equal single runs; their NEES is that of the filter."""

from ins_sim.core.aiding.consistency import BLOCKS, FilterNote, nees, TrueValues
from ins_sim.core.aiding.filters.eskf import ErrorStateFilter
from ins_sim.core.ensemble.aided_runs import simulate_aided_runs
from ins_sim.core.ensemble.consistency import (ChiSquareSums, FixSums, merged_fixes, merged_sums,
                                               sums_of)
from ins_sim.core.sensors.imu.with_errors import STILL, with_errors
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.io.motion import read_motion
from ins_sim.studies.aided_ensembles import result_of, why_not
import numpy as np
import pytest
from scipy.stats import chi2
from support.aided import runs as aided_runs

SECOND = 10 ** 9
WANTED_NS = np.arange(0, 21, 5) * SECOND
FLIGHT = ('duration_s:=20.0', *aided_runs.FLIGHT[1:])


def flights(*assignments, runs=(0, 3), wanted_ns=WANTED_NS):
    """Return the settings and the AidedFlights for runs of a short flight."""
    settings = aided_runs.settings(*assignments, flight=FLIGHT)
    motion = read_motion(settings.simulation.motion_generator)
    return settings, simulate_aided_runs(settings, motion, runs, wanted_ns)


@pytest.mark.parametrize('assignments', [
    (), ('sampling.drop_out_probability:=0.002',), ('strapdown:output_every:=300',),
    ('imu_sensor:source:=stream', 'gyro.delay_us.x:=-5000.0'),
    ('strapdown:initial.after_s:=11.0', 'aided_navigator:initial.after_s:=7.0'),
    ('window.latency_ms:=300.0', 'gnss.latency_ms:=150.0'),
    ('rate_hz:=50.0', 'velocity_meter:attack_angle:=none')], ids=[
        'plain', 'losses', 'seldom', 'stream', 'late', 'latency', 'slow'])
def test_a_run_is_the_single_run_to_the_bit(assignments):
    """Solution, sigmas and innovations equal those of simulate --aided with run=k, to the bit."""
    settings, found = flights(*assignments)
    for flight in found:
        _, _, single = aided_runs.flown(settings.with_run(flight.run))
        result = flight.result
        rows = np.searchsorted(single.errors.t_ns, result.errors.t_ns)
        for name, values in result.errors.arrays().items():
            np.testing.assert_array_equal(values, getattr(single.errors, name)[rows], name)
        for name, values in result.states.arrays().items():
            np.testing.assert_array_equal(values, getattr(single.states, name)[rows], name)
        assert result.judged == single.judged and result.faults == single.faults
    assert not np.array_equal(found[0].result.errors.position, found[1].result.errors.position)


def test_the_instants_are_those_wanted():
    """Each instant is the first sample at or after the requested one, unless it is lost."""
    wanted_ns = np.array([0, 3, 13, 15]) * SECOND + 1_000_000
    wanted_ns[0] = 0
    settings, found = flights(wanted_ns=wanted_ns)
    assert found[0].result.errors.t_ns.tolist() == [0, *(wanted_ns[1:] + 9_000_000).tolist()]
    assert found[0].numbers.tolist() == [0, 1, 2, 3]
    result = result_of(settings, range(2), wanted_ns, found)
    assert result.errors.statistics.count.tolist() == [2] * 4
    np.testing.assert_array_equal(result.errors.final_errors[1, 6:9],
                                  found[1].result.errors.position[-1])


def test_nees_is_that_of_the_covariance():
    """NEES of every block agrees with NumPy; held and exactly given states do not count."""
    settings, (flight, _) = flights()
    squares, freedoms = flight.nees()
    # East and north of position and velocity, attitude, two biases of three, and the mounting.
    assert freedoms[1:].tolist() == [[2, 2, 3, 14]] * 4 and np.isnan(squares[0]).all()
    note = flight.result.notes[-1]
    rows = [k for k, name in enumerate(note.states) if name not in note.given]
    names = [note.states[k] for k in rows]
    assert names == [*(f'{a}_{b}' for a in ('position', 'velocity') for b in 'en'),
                     *(f'attitude_{b}' for b in 'enu'),
                     *(f'{a}_bias_{b}' for a in ('accelerometer', 'gyro') for b in 'xyz'),
                     'mounting']
    errors, true = flight.result.errors, flight._normaliser.true_values(20 * SECOND)
    gyro, accelerometer = note.biases
    error = np.concatenate([
        errors.position[-1, :2], errors.velocity[-1, :2], errors.attitude[-1],
        np.subtract(accelerometer, true.accelerometer), np.subtract(gyro, true.gyro),
        [note.estimates[0] - np.radians(20.0 / 60.0)]])
    p = note.covariance[np.ix_(rows, rows)]
    scale = np.sqrt(np.diag(p))
    whole = np.linalg.solve(p / np.outer(scale, scale), error / scale) @ (error / scale)
    assert squares[-1, 3] == pytest.approx(whole, rel=1e-6)
    place = error[:2] @ np.linalg.solve(p[:2, :2], error[:2])
    assert squares[-1, 0] == pytest.approx(place, rel=1e-9)


def test_the_bias_of_the_truth_is_what_the_readings_show():
    """The true bias equals the mean error of the readings of a level instrument at rest."""
    settings = aided_runs.settings(flight=FLIGHT).simulation.imu_sensor
    errors, count = with_errors(settings), 20000
    level = np.tile((0.0, 0.0, 9.80665), (count, 1))
    imu = ImuSamples(np.arange(count) * 10_000_000, np.tile(STILL, (count, 1)), level)
    readings = errors.advance(imu)
    gyro, accelerometer = errors.biases(0)
    # Five sigma of the mean of the white noise.
    for found, bias, density in ((readings.omega, gyro, np.radians(0.01) / 60.0),
                                 (readings.f - level, accelerometer, 0.0177 / 60.0)):
        assert np.abs(found.mean(axis=0) - bias).max() < 5.0 * density / np.sqrt(count * 0.01)


def test_without_a_covariance_there_is_no_nees():
    """A filter with fixed gains has no degree of freedom, hence no NEES and no note."""
    note = FilterNote((), (), None, ((0.0,) * 3,) * 2, (0.0,) * 3)
    squares, freedoms = nees(note, ((1.0,) * 3,) * 3, TrueValues(None, None, (0.0,) * 3))
    assert np.isnan(squares).all() and freedoms == [0] * len(BLOCKS)
    settings, found = flights('filter:=conventional', 'gnss_model.use:=false')
    result = result_of(settings, range(2), WANTED_NS, found)
    assert not result.consistency.nees.count.any()


def test_a_run_that_is_refused_does_not_count():
    """A refused run is named with its reason; the other runs do not change."""
    settings, found = flights(runs=(0, 1, 2))
    whole = result_of(settings, range(3), WANTED_NS, found)
    found[1].refused = 'why'
    less = result_of(settings, range(3), WANTED_NS, found)
    assert less.refused == ((1, 'why'),) and less.errors.diverged == (1,)
    assert whole.errors.statistics.count.tolist() == [3] * 5
    assert less.errors.statistics.count.tolist() == [2] * 5
    assert less.consistency.nees.count[1:].tolist() == [[2] * 4] * 4
    assert np.isnan(less.errors.final_errors[1]).all()
    assert np.isfinite(less.errors.final_errors[[0, 2]]).all()


def test_a_solution_that_diverges_is_said(monkeypatch):
    """An invalid covariance restarts the navigator, and the run is excluded."""
    settings, (flight,) = flights(runs=(0,))
    assert why_not(flight) == ''
    monkeypatch.setattr(ErrorStateFilter, 'healthy', False)
    _, (flight,) = flights(runs=(0,))
    assert 'the covariance of filter eskf' in why_not(flight)
    _, (flight,) = flights('aided_navigator:on_fault:=stop', runs=(0,))
    assert flight.result is None and 'is not positive definite' in why_not(flight)


def test_sums_are_chi_square():
    """A sum over runs has the sum of their degrees of freedom; groups merge to the same sum."""
    rng = np.random.default_rng(5)
    freedoms = np.tile(np.array([2, 3, 0]), (4, 50, 1))
    squares = rng.chisquare(np.maximum(freedoms, 1))
    squares[2, 7, 0] = np.nan
    whole = sums_of(squares, freedoms)
    assert whole.count[:, 0].tolist() == [50, 50, 49, 50] and not whole.count[:, 2].any()
    assert whole.freedom[:, 1].tolist() == [150] * 4
    both = merged_sums(*(sums_of(squares[:, part], freedoms[:, part])
                         for part in (slice(0, 20), slice(20, 50))))
    np.testing.assert_array_equal(both.count, whole.count)
    np.testing.assert_allclose(both.total, whole.total, rtol=1e-14)
    # 1e-6 of all such sums lie outside.
    low, high = chi2.ppf([5e-7, 1.0 - 5e-7], 150)
    assert (low < whole.total[:, 1]).all() and (whole.total[:, 1] < high).all()
    assert np.isnan(whole.mean[:, 2]).all()


def test_fixes_of_other_instants_merge():
    """Fixes are merged by their stamps, even if only some runs have them."""
    def fixes(*stamps):
        ones = np.ones(len(stamps), dtype=np.int64)
        return FixSums(np.array(stamps), ChiSquareSums(ones, 1.0 * ones, 2 * ones), ones, 0 * ones)

    both = merged_fixes(fixes(1, 3), fixes(3, 4))
    assert both.t_ns.tolist() == [1, 3, 4] and both.taken.tolist() == [1, 2, 1]
    assert both.sums.total.tolist() == [1.0, 2.0, 1.0]
