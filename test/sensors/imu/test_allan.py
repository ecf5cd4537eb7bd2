"""The Allan deviation of simulated records reproduces the coefficients of the settings."""

import math

import numpy as np
import pytest

from ins_sim.core.numerics.allan_deviation import overlapping_deviation
from ins_sim.core.numerics.noise import BLOCK
from ins_sim.settings.presets import preset_triads, PRESETS
from ins_sim.core.sensors.imu.triad_errors import make_noise, TriadErrors
from ins_sim.core.sensors.imu.triad_model import triad_model
from ins_sim.report import allan

RATE = 10.0
SAMPLES = 108000
RUNS = 9
# Earth rate, rad/s, and gravity, m/s^2, on a table at rest.
AT_REST = {'gyro': (4.4e-5, 2.2e-5, 5.4e-5), 'accelerometer': (0.1, -0.2, 9.8)}
TOLERANCES = np.array([0.05, 0.2, 0.3])
# Coefficients that three hours show; for navigation_rlg white noise hides all but N.
SHOWN = {('navigation_rlg', 'gyro'): slice(1)}


def ratios(model, record, rate_hz=RATE):
    """Return the ratios of fitted to simulated N, B, K for a record of three axes."""
    found = allan.estimate_deviation(record, rate_hz)
    known = allan.gauss_markov_variance(found.tau_s, model.gauss_markov_sigma[0],
                                        model.gauss_markov_time[0])
    c = allan.fit_coefficients(found, known)
    return (c.random_walk / model.white[0], c.instability / model.flicker[0],
            c.rate_random_walk / model.walk[0])


def noise_record(model, run, name, rate_hz, samples):
    """Return a record (samples, 3) of noise only."""
    noise = make_noise(model, 1, run, name, 1.0 / rate_hz)
    return noise(0, samples // BLOCK + 1)[:samples]


@pytest.mark.parametrize('name', PRESETS)
@pytest.mark.parametrize('triad', ['gyro', 'accelerometer'])
def test_round_trip(name, triad):
    """
    Three-hour records of each preset give N within 5 %, B within 20 %, K within 30 %.

    Coefficients that three hours do not show are left out (SHOWN). The first of nine records has
    all errors on. A record of three axes has so few long intervals that B scatters by up to 12 %
    and K by up to 20 % from record to record (printed). The root mean square over the nine records
    is therefore compared with the bounds, which are at least four of its standard deviations.
    """
    settings = preset_triads(name)[triad == 'accelerometer']
    model = triad_model(settings, 1.0 / RATE)
    rest = np.tile(AT_REST[triad], (SAMPLES, 1))
    errors = TriadErrors(settings, 1, 0, f'{name}.{triad}', 1.0 / RATE)
    whole = errors.advance(0, rest, rest, rest[:, 0])
    found = np.array([ratios(model, whole), *(
        ratios(model, noise_record(model, run, f'{name}.{triad}', RATE, SAMPLES))
        for run in range(1, RUNS))])
    mean, scatter = np.sqrt(np.mean(found ** 2, axis=0)), found.std(axis=0, ddof=1)
    print(f'{name} {triad}: N, B, K over simulated, one record {found[0].round(3)}, {RUNS} '
          f'records {mean.round(3)}, scatter of one {scatter.round(3)}')
    shown = SHOWN.get((name, triad), slice(None))
    assert (np.abs(found[0] - 1.0) < TOLERANCES)[shown].all()
    assert (np.abs(mean - 1.0) < TOLERANCES)[shown].all()
    assert (4.0 * scatter / math.sqrt(RUNS) < TOLERANCES)[shown].all()


def test_ring_laser_shows_floor_and_walk_in_weeks():
    """
    Sixty days of navigation_rlg, one reading per minute, give N, B and K within these bounds.

    The bounds are 5 % for N, 20 % for B, 30 % for K. In three hours the deviation of the gyro only
    falls to 0.0023 deg/h at the longest tau, because of white noise. The floor of 0.001 deg/h and
    the random walk appear from four hours on.
    """
    model = triad_model(preset_triads('navigation_rlg')[0], 60.0)
    found = np.array([ratios(model, noise_record(model, run, 'weeks', 1.0 / 60.0, 86400),
                             1.0 / 60.0) for run in range(4)])
    scatter = found.std(axis=0, ddof=1)
    print(f'navigation_rlg gyro, 60 days: N, B, K over simulated {found.round(3).tolist()}, '
          f'scatter {scatter.round(3)}')
    assert (np.abs(found - 1.0) < TOLERANCES).all()


def test_coefficients_of_a_curve():
    """The fit of an exact Allan curve returns its coefficients; absent ones are zero."""
    for squares in ((1e-3, 0.1, 0.5, 0.01), (0.0, 0.1, 0.0, 0.0), (0.0, 0.0, 0.3, 0.002)):
        want = allan.Coefficients(*squares)
        tau = np.geomspace(0.1, 3000.0, 40)
        curve = allan.Allan(tau, want.deviation(tau)[:, None], 12000.0)
        got = allan.fit_coefficients(curve)
        for a, b in zip((got.quantisation, got.random_walk, got.instability,
                         got.rate_random_walk), squares):
            assert abs(a - b) <= 1e-3 * b + 1e-3 * max(squares) * (b == 0.0)


def test_gauss_markov_variance_joins_its_limits():
    """Gauss-Markov variance: 2 sigma^2 T/tau for long, 2 sigma^2 tau/(3 T) for short tau."""
    assert allan.gauss_markov_variance(1e7, 2.0, 10.0) == pytest.approx(8e-6, rel=1e-5)
    assert allan.gauss_markov_variance(1e-6, 2.0, 10.0) == pytest.approx(8e-7 / 3.0, rel=1e-5)
    low, high = allan.gauss_markov_variance(np.array([0.9999e-2, 1.0001e-2]), 1.0, 10.0)
    assert high / low == pytest.approx(1.0002, rel=1e-5)
    assert not allan.gauss_markov_variance(1.0, 2.0, math.inf)


def test_white_noise_of_one_rad_s():
    """The deviation at one interval equals that of 2000 white samples within 4 sigma."""
    found = allan.estimate_deviation(np.random.default_rng(1).normal(size=(2000, 3)), 100.0)
    assert found.deviation[0] == pytest.approx(np.ones(3), abs=4 / math.sqrt(2000))
    assert allan.fit_coefficients(found).seen(found).tolist() == [False, True, False, False]


def test_coefficients_are_seen_where_they_matter():
    """A coefficient is reported only if enough intervals of the record show it."""
    tau = np.geomspace(0.1, 1000.0, 30)
    for values, length_s, seen in (
            ((0.0, 1.0, 1e-4, 0.01), 1e4, [False, True, False, True]),
            ((0.0, 1.0, 0.1, 1e-4), 1e4, [False, True, True, False]),
            ((0.0, 1.0, 0.03, 1e-4), 4e3, [False, True, False, False]),
            ((0.0, 1.0, 0.03, 1e-4), 4e5, [False, True, True, False])):
        c = allan.Coefficients(*values)
        curve = allan.Allan(tau, c.deviation(tau)[:, None], length_s)
        assert c.seen(curve).tolist() == seen, values


@pytest.mark.parametrize('record', ['white', 'walk', 'offset'])
@pytest.mark.parametrize('samples', [40, 1001, 100_000])
def test_estimate_is_that_of_allantools(record, samples):
    """
    The overlapping Allan deviation agrees with that of allantools.

    Both sum the same numbers, but the order of the sums may depend on the version of NumPy: ten
    roundings are allowed (none was found).
    """
    allantools = pytest.importorskip('allantools')
    white = np.random.default_rng(3).normal(size=samples)
    values = {'white': white, 'walk': np.cumsum(white), 'offset': 9.8 + 1e-3 * white}[record]
    factors = np.unique(np.geomspace(1, samples // 4, 30).astype(int))
    tau, deviation, _, _ = allantools.oadev(values, data_type='freq', taus=1.0 * factors)
    ours = overlapping_deviation(values, factors)
    apart = np.abs(ours / deviation - 1.0).max()
    print(f'{record}, {samples} samples: {apart:.1e} from allantools')
    assert (tau == factors).all()
    assert apart <= 10 * np.finfo(float).eps


def test_averaging_times_are_whole_intervals():
    """Each tau is a whole number of sampling intervals, from one to a quarter of the record."""
    found = allan.estimate_deviation(np.random.default_rng(4).normal(size=(4000, 2)), 100.0)
    assert found.deviation.shape == (len(found.tau_s), 2)
    assert found.tau_s[0] == 0.01 and found.tau_s[-1] == 10.0
    assert np.abs(found.tau_s * 100.0 - np.round(found.tau_s * 100.0)).max() < 1e-9


def test_bad_records_are_refused():
    """Records that are too short or invalid are refused with one message."""
    with pytest.raises(ValueError, match='has 5 samples; expected at least 40'):
        allan.estimate_deviation(np.zeros(5), 10.0)
    with pytest.raises(ValueError, match='NaN or infinity'):
        allan.estimate_deviation(np.full(100, np.nan), 10.0)
    with pytest.raises(ValueError, match='constant over an interval'):
        allan.fit_coefficients(allan.estimate_deviation(np.ones(100), 10.0))
