"""Errors of a triad: single steps, arrays, and plain or compiled loops have the same bits."""

import numpy as np
import pytest

from ins_sim.core.numerics import compilation
from ins_sim.core.sensors.imu import triad_errors
from ins_sim.core.sensors.imu.sampling import consecutive, Sampler
from ins_sim.core.sensors.imu.triad_errors import TriadErrors
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.settings.instrument_errors import GyroErrors, Sampling, Temperature

DT, N = 0.01, 900
WARM = Temperature(ramp_c_h=36.0, amplitude_c=2.0, period_s=40.0)
TERMS = {'geometry': {'misalignment_mrad': (0.1, 0.2, 0.3), 'non_orthogonality_mrad': (1.0,) * 3},
         'response': {'scale_factor_ppm': (100.0, 0.0, 30.0), 'scale_asymmetry_ppm': (9.0,) * 3,
                      'cubic_ppm_s2_deg2': (0.01,) * 3},
         'by force': {'g_sensitivity_deg_h_g': (0.1,) * 3, 'g2_sensitivity_deg_h_g2': (1.0,) * 3},
         'by temperature': {'temperature_bias_deg_h_c': (0.1,) * 3,
                            'temperature_scale_ppm_c': (1.0,) * 3},
         'noise': {'bias_deg_h': (1.0,) * 3, 'angle_random_walk_deg_sqrt_h': (0.01, 0.0, 0.1)},
         'saturation': {'saturation_deg_s': (10.0, 0.0, 40.0)},
         'lags': {'bandwidth_hz': (20.0, 0.0, 40.0)},
         'lags of second order': {'bandwidth_hz': (20.0, 30.0, 40.0), 'bandwidth_order': 2},
         'pulses': {'quantisation_arcsec': (0.3, 0.0, 20.0)}}


def triad(names):
    """Return the TriadErrors with the terms of these names."""
    return TriadErrors(GyroErrors(**{k: v for name in names for k, v in TERMS[name].items()}),
                       7, 0, 'gyro', DT, WARM)


@pytest.fixture(params=['arrays', 'loop', 'compiled'])
def tier(request, monkeypatch):
    """Read blocks with arrays, with the loop in plain Python, or with the compiled loop."""
    if request.param == 'loop':
        monkeypatch.setattr(triad_errors, 'run', lambda *inputs: compilation.run(*inputs[:4]))
    if request.param == 'compiled' and compilation.numba() is None:
        pytest.skip('Numba is not installed')
    monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', 0 if request.param == 'compiled' else 10**9)


@pytest.fixture
def inputs():
    """Return rates, forces and times of N samples; some rates saturate, and one is minus zero."""
    rng = np.random.default_rng(11)
    values, forces = 0.3 * rng.normal(size=(N, 3)), 10.0 * rng.normal(size=(N, 3))
    values[5] = -0.0
    return values, forces, DT * np.arange(N)


MIXTURES = [*([name] for name in TERMS), ['lags', 'pulses', 'saturation'],
            [name for name in TERMS if name != 'lags'],
            [name for name in TERMS if name not in ('lags', 'lags of second order', 'pulses')]]


@pytest.mark.parametrize('names', MIXTURES, ids=lambda names: '+'.join(names)[:40])
def test_blocks_give_the_bits_of_single_steps(names, inputs, tier):
    """Any cutting gives the bits of single steps, also after a missing sample (states reset)."""
    values, forces, t_s = inputs
    single, cut, rng = triad(names), triad(names), np.random.default_rng(5)
    index = [*range(100, 400), *range(401, 101 + N)]
    rows = zip(index, values.tolist(), forces.tolist(), t_s.tolist())
    expected = np.array([single.step(*row) for row in rows])
    start, got = 0, []
    while start < N:
        end = min(start + int(rng.choice([1, 3, 50, 300])), 300 if start < 300 else N)
        got.append(cut.advance(index[start], values[start:end], forces[start:end],
                               t_s[start:end]))
        start = end
    got = np.concatenate(got)
    assert np.array_equal(got, expected)
    assert np.array_equal(np.signbit(got), np.signbit(expected))
    assert cut.step(101 + N, *(tuple(v[0]) for v in inputs[:2]), 0.0) == single.step(
        101 + N, *(tuple(v[0]) for v in inputs[:2]), 0.0)


@pytest.mark.parametrize('sampling', [
    Sampling(latency_us=1500.0), Sampling(jitter_us=900.0), Sampling(drop_out_probability=0.1),
    Sampling(latency_us=-3.0, jitter_us=500.0, drop_out_probability=0.02)])
def test_samples_that_get_through_are_those_of_single_stamps(sampling):
    """Stamps and drop-outs of a block with gaps are those of single calls."""
    t_ns = 10_000_000 * np.delete(np.arange(20, 1500), [3, 4, 700])
    imu = ImuSamples(t_ns, np.random.default_rng(0).normal(size=(len(t_ns), 3)), np.ones((1, 3)))
    sampler = Sampler(sampling, 3, 0, 'sampling', 10_000_000)
    stamps = [sampler.stamp(t // 10_000_000, t) for t in t_ns.tolist()]
    imu = ImuSamples(t_ns, imu.omega, imu.omega * 2.0)
    taken = sampler.take(imu)
    kept = [k for k, stamp in enumerate(stamps) if stamp is not None]
    assert taken.t_ns.tolist() == [stamps[k] for k in kept]
    assert np.array_equal(taken.omega, imu.omega[kept]) and np.array_equal(taken.f, imu.f[kept])
    assert len(sampler.take(imu[:0])) == 0


def test_consecutive_numbers_are_found():
    """Runs of consecutive numbers are found as slices; a single number is a run too."""
    for index in ([], [5], [5, 6, 7], [5, 7, 8, 1, 3]):
        runs = consecutive(np.array(index, dtype=np.int64))
        assert [k for run in runs for k in index[run]] == index
        assert all(np.diff(index[run]).tolist() == [1] * (run.stop - run.start - 1)
                   for run in runs)
    assert len(consecutive(np.array([5, 7, 8, 1, 3]))) == 4
