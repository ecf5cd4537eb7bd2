"""Attitudes of the bench motions: floats, arrays, series and compiled loops give the same bits."""

import ins_sim
from ins_sim.core.motion import bench_attitudes
from ins_sim.core.motion.bench import BenchMotion
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.numerics import compilation, taylor
from ins_sim.settings.motion import Harmonics, MotionSettings, Rocking
from ins_sim.settings.place import Datum, Earth
import numpy as np
import pytest

TIMES = np.concatenate([[0.0, -0.003], np.random.default_rng(1).uniform(-5.0, 4000.0, 300)])
ANGLES = {'psi_deg': 40.0, 'theta_deg': 5.0, 'gamma_deg': -3.0}
MOTIONS = {'static': {}, 'rocking': {}, 'rocking of the body': {
    'kind': 'rocking', 'rocking': Rocking(axis='y', frequency_hz=0.7)}, 'two_axis': {},
    'coning': {}, 'sculling': {}, 'sinusoids': {}, 'harmonics': {}, 'harmonics of one angle': {
        'kind': 'harmonics', 'harmonics': Harmonics(psi_deg=(), psi_phase_deg=())}}


def bench(name):
    """Return the BenchMotion of that name."""
    return make_motion(MotionSettings(**{'kind': name, **ANGLES, **MOTIONS[name]}), Datum(),
                       Earth())


@pytest.mark.parametrize('name', MOTIONS)
def test_floats_arrays_series_and_loops_give_equal_bits(name):
    """The attitude as floats, arrays, series, and plain or compiled loops has the same bits."""
    motion = bench(name)
    attitude, constants = motion._attitude, motion._constants
    expected = np.array([attitude(constants, t) for t in TIMES.tolist()])
    assert np.array_equal(np.array(attitude(constants, TIMES)).T, expected)
    series = attitude(constants, taylor.Series.time(TIMES, 2))
    assert np.array_equal(np.array([x.value for x in series]).T, expected)
    loop, rows = bench_attitudes.ROWS[attitude], [0.0] * 4 * len(TIMES)
    loop(constants, TIMES.tolist(), rows)
    assert np.array_equal(np.reshape(rows, (-1, 4)), expected)
    if compilation.numba() is None:
        pytest.skip('Numba is not installed')
    out = np.empty(4 * len(TIMES))
    compilation.compiled(loop)(constants, TIMES, out)
    assert np.array_equal(out.reshape(-1, 4), expected)


@pytest.mark.parametrize('name', MOTIONS)
def test_the_rate_is_that_of_the_attitude(name):
    """Quaternions have norm 1, and their derivatives by series agree with differences."""
    motion = bench(name)
    attitude, constants, h = motion._attitude, motion._constants, 1e-3
    t = np.linspace(0.1, 9.0, 40)
    q, rate, _, third, _, fifth = np.array(
        [x.c for x in attitude(constants, taylor.Series.time(t, 5))]).swapaxes(0, 1)
    np.testing.assert_allclose((q * q).sum(axis=0), 1.0, rtol=2e-15)
    before, after = (np.array(attitude(constants, t + s)) for s in (-h, h))
    # Remainder of the series, and rounding divided by the step h.
    bound = 1.1 * h ** 4 * np.abs(fifth).max() + 1e-15 / h
    np.testing.assert_allclose((after - before) / (2.0 * h), rate + h * h * third, rtol=0,
                               atol=bound)


@pytest.mark.parametrize('name', MOTIONS)
def test_the_truth_where_nothing_moves_is_that_of_any_motion(name):
    """If nothing moves the truth is computed once; it equals the truth of each instant."""
    motion, t_ns = bench(name), np.round(TIMES * 1e9).astype(np.int64)
    for field, values in ins_sim.Motion.at(motion, t_ns).arrays().items():
        assert np.array_equal(getattr(motion.at(t_ns), field), values), field


def test_all_motions_at_a_bench_are_here():
    """Every bench motion in the table of motions is tested in this file."""
    kinds = [kind for kind in ins_sim.settings.motion.MOTIONS if kind not in (
        'recording', 'route', 'guided', 'cruise', 'racetrack', 'aggressive')]
    assert all(isinstance(bench(kind), BenchMotion) for kind in kinds)
    assert {bench(name)._attitude for name in MOTIONS} == set(bench_attitudes.ROWS)
