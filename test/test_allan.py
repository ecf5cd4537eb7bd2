"""The Allan deviation of simulated records gives back the coefficients of the settings."""

import builtins
import math

import numpy as np
import pytest

from ins_sim.core.noise import BLOCK
from ins_sim.core.presets import PRESETS, triads
from ins_sim.core.triad_errors import make_noise, TriadErrors
from ins_sim.core.triad_model import triad_model
from ins_sim.report import allan

RATE = 10.0
SAMPLES = 108000
RUNS = 4
# Earth rate, rad/s, and gravity, m/s^2, on a table at rest.
AT_REST = {'gyro': (4.4e-5, 2.2e-5, 5.4e-5), 'accelerometer': (0.1, -0.2, 9.8)}
TOLERANCES = np.array([0.05, 0.2, 0.3])


def ratios(model, record):
    """Return fitted over simulated N, B, K of a record of three axes."""
    c = allan.fit(allan.estimate(record, RATE), (model.in_run_sigma[0], model.in_run_time[0]))
    return (c.random_walk / model.white[0], c.instability / model.flicker[0],
            c.rate_random_walk / model.walk[0])


@pytest.mark.parametrize('name', PRESETS)
@pytest.mark.parametrize('triad', ['gyro', 'accelerometer'])
def test_round_trip(name, triad):
    """
    One three-hour record with everything on: N within 5 %, B within 20 %, K within 30 %.

    A record of three axes holds so few long intervals that K scatters by 12 to 17 % from record
    to record (B by 5 to 10 %): the root mean square of more runs is held to the same bounds.
    """
    pytest.importorskip('allantools')
    settings = triads(name)[triad == 'accelerometer']
    model = triad_model(settings, 1.0 / RATE)
    rest = np.tile(AT_REST[triad], (SAMPLES, 1))
    errors = TriadErrors(settings, 1, 0, f'{name}.{triad}', 1.0 / RATE)
    whole = errors.advance(0, rest, rest, rest[:, 0])
    found = [ratios(model, whole)]
    for run in range(1, RUNS):
        noise = make_noise(model, 1, run, f'{name}.{triad}', 1.0 / RATE)
        blocks = [noise(b) for b in range(SAMPLES // BLOCK + 1)]
        found.append(ratios(model, np.concatenate(blocks)[:SAMPLES]))
    found = np.array(found)
    mean = np.sqrt(np.mean(found ** 2, axis=0))
    print(f'{name} {triad}: N, B, K over simulated, one record '
          f'{found[0].round(3)}, {RUNS} records {mean.round(3)}')
    assert (np.abs(found[0] - 1.0) < TOLERANCES).all()
    assert (np.abs(mean - 1.0) < TOLERANCES).all()


def test_coefficients_of_a_curve():
    """The fit of the exact curve gives its coefficients back; absent ones vanish."""
    for squares in ((1e-3, 0.1, 0.5, 0.01), (0.0, 0.1, 0.0, 0.0), (0.0, 0.0, 0.3, 0.002)):
        want = allan.Coefficients(*squares)
        tau = np.geomspace(0.1, 3000.0, 40)
        curve = allan.Allan(tau, want.deviation(tau)[:, None], 12000.0)
        got = allan.fit(curve)
        for a, b in zip((got.quantisation, got.random_walk, got.instability,
                         got.rate_random_walk), squares):
            assert abs(a - b) <= 1e-3 * b + 1e-3 * max(squares) * (b == 0.0)


def test_gauss_markov_variance_joins_its_limits():
    """2 sigma^2 T/tau for long tau, 2 sigma^2 tau/(3 T) for short; no step at the switch."""
    assert allan.gauss_markov_variance(1e7, 2.0, 10.0) == pytest.approx(8e-6, rel=1e-5)
    assert allan.gauss_markov_variance(1e-6, 2.0, 10.0) == pytest.approx(8e-7 / 3.0, rel=1e-5)
    low, high = allan.gauss_markov_variance(np.array([0.9999e-2, 1.0001e-2]), 1.0, 10.0)
    assert high / low == pytest.approx(1.0002, rel=1e-5)
    assert not allan.gauss_markov_variance(1.0, 2.0, math.inf)


def test_figure(tmp_path):
    """It is drawn, with and without a fit."""
    pytest.importorskip('allantools')
    found = allan.estimate(np.random.default_rng(1).normal(size=(2000, 3)), 100.0)
    assert found.deviation[0] == pytest.approx(np.ones(3), rel=0.1)
    allan.save_figure(tmp_path / 'a.png', 'white noise', found, 'rad/s', 'xyz', allan.fit(found))
    allan.save_figure(tmp_path / 'b.png', 'white noise', found, 'rad/s')
    assert (tmp_path / 'a.png').stat().st_size > 10000 < (tmp_path / 'b.png').stat().st_size


def test_bad_records_are_refused(monkeypatch):
    """One sentence each, and one that names the missing package."""
    pytest.importorskip('allantools')
    with pytest.raises(ValueError, match='has 5 samples; expected at least 40'):
        allan.estimate(np.zeros(5), 10.0)
    with pytest.raises(ValueError, match='NaN or infinity'):
        allan.estimate(np.full(100, np.nan), 10.0)
    with pytest.raises(ValueError, match='constant over an interval'):
        allan.fit(allan.estimate(np.ones(100), 10.0))
    real = builtins.__import__

    def without(name, *args, **kwargs):
        if name == 'allantools':
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, '__import__', without)
    with pytest.raises(ImportError, match='pip install allantools'):
        allan.estimate(np.zeros(100), 10.0)
