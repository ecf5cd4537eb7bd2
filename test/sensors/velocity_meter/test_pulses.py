"""Mode signal of the velocity meter: fields, correlation functions, published errors."""

import math

from support.meter_studies import body, errors, flight, meter_settings, PERFECT
import numpy as np
import pytest
from scipy.stats import chi2

from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.core.sensors.velocity_meter.reading import PAIRS
from ins_sim.core.sensors.velocity_meter.pulses import Correlator, Field
from ins_sim.core.sensors.velocity_meter.surrogate import velocity_sigmas

V = 250.0
# Lateral scale errors of the two normalisations, see docs/design/velocity_meter.md.
LATERAL_SCALE = {'cycle': 0.054, 'window': 0.015}
# Ratios of the sigmas of V_x and V_z to the formulas of the surrogate, by sideslip in deg, from
# 1000 windows of 100 cycles with five seeds (one standard deviation is 2 %). Source: the same
# page, "Surrogate".
OVER_SURROGATE = {0.0: (0.93, 1.12), 3.0: (0.97, 1.07), -6.0: (0.97, 1.19)}


def scatter(windows):
    """Return three relative standard deviations of a sigma estimated from this many windows."""
    return 3.0 / math.sqrt(2.0 * windows)


def show(name, found, valid, published=None):
    """Print bias and sigma of V_x, V_z and V_z by delays; return the sigmas."""
    sigma, bias = found.std(axis=0), found.mean(axis=0)
    core = np.subtract(*np.percentile(found, [75, 25], axis=0)) / 1.349
    print(f'{name}: {len(found)} valid, {100 * (1 - valid):.1f} % invalid; sigma V_x '
          f'{sigma[0]:.3f}, V_z {sigma[1]:.3f}, V_z by delays {sigma[2]:.3f}; of the core '
          f'{core[0]:.3f}, {core[1]:.3f}; bias {bias[0]:+.3f}, {bias[1]:+.3f} m/s'
          + (f'; published {published}' if published else ''))
    return sigma


@pytest.mark.parametrize('terms', [
    {}, {'signal.decay_time_s': 2e-4}, {'antennas.antenna_2': 'left'},
    {'beam.sigma_theta_z_rad': 0.15}, {'limits.speed_max_m_s': 1500.0, 'signal.prf_hz': 5e4,
                                       'signal.lags': 32}])
@pytest.mark.parametrize('speed, beta, alpha', [(250.0, 10.0, 8.0), (60.0, -25.0, 0.0)])
def test_the_field_has_the_correlations_it_is_made_for(terms, speed, beta, alpha):
    """The field has the designed correlations at every lag, and noise at lag 0 only."""
    s = meter_settings({'mode': 'signal', 'signal.detection': 'complex', **terms})
    field, correlator = Field(s), Correlator(s)
    v = speed * math.cos(math.radians(beta)), speed * math.sin(math.radians(beta))
    rng, cycles = np.random.default_rng(1), 500
    each = np.array([correlator.sums(field.signals(rng.standard_normal(field.width), *v, math.tan(
        math.radians(alpha)))).products for _ in range(cycles)])
    expected = field.correlations(s.signal.lags, *v, math.tan(math.radians(alpha)), 'complex')
    for pair, (i, j) in enumerate(PAIRS):
        expected[pair, 0] += 0.1 * (i == j)
    worst = 0.0
    for part, wanted in ((each.real, expected), (each.imag, 0.0 * expected)):
        z = (part.mean(axis=0) - wanted) / (part.std(axis=0, ddof=1) / math.sqrt(cycles) + 1e-12)
        worst = max(worst, np.abs(z).max())
    # With 640 normal numbers one in 1e6 tests exceeds 6.3.
    print(f'{speed:g} m/s, beta {beta:g} deg, {terms}: worst of {expected.size} lags {worst:.2f} '
          'sigma')
    assert worst < 6.3


def test_one_cycle(figures):
    """
    One cycle: sigma of V_x is about 45 m/s, as published; 15 % of the windows are invalid.

    Both come from false peaks. "About 45" is read as given to 5 m/s; the scatter of our sigma
    follows from the fourth moment, because false peaks make heavy tails. Known deviation from the
    published 8 %: false peaks below the least speed are also rejected, which gives 15 %, within
    three standard deviations of the number of invalid windows.
    """
    found, valid = errors(meter_settings(mode='signal', window__cycles=1), 3000)
    sigma = show('N = 1', found, valid, '~45, 8 % invalid')
    figures.record('velocity_meter.signal.1.sigma_x', sigma[0], 'm/s', 45.0, 'Ivanov 2015')
    figures.record('velocity_meter.signal.1.invalid', 100.0 * (1.0 - valid), '%', 8.0,
                   'Ivanov 2015')
    x = found[:, 0] - found[:, 0].mean()
    off = sigma[0] * math.sqrt((np.mean(x ** 4) / sigma[0] ** 4 - 1.0) / (4.0 * len(x)))
    assert sigma[0] == pytest.approx(45.0, abs=2.5 + 3.0 * off)
    assert 1.0 - valid == pytest.approx(0.15, abs=3.0 * math.sqrt(0.15 * 0.85 / 3000))


def test_a_hundred_cycles(figures):
    """
    A hundred cycles: sigmas 0.79 and 0.87 m/s, as published; by delays sigma is six times larger.

    Each sigma scatters by three standard deviations of an estimate from 120 windows, their ratio
    by the root of two times that.
    """
    found, valid = errors(meter_settings(mode='signal', window__cycles=100), 120)
    sigma = show('N = 100', found, valid, '0.79 / 0.87, by delays 6 times worse')
    assert valid == 1.0
    figures.record('velocity_meter.signal.100.sigma', sigma[:2], 'm/s', (0.79, 0.87),
                   'Ivanov 2015')
    figures.record('velocity_meter.signal.100.delays_over_amplitudes', sigma[2] / sigma[1], '',
                   6.0, 'Ivanov 2015')
    assert sigma[:2] == pytest.approx((0.79, 0.87), rel=scatter(120))
    assert sigma[2] / sigma[1] == pytest.approx(6.0, rel=math.sqrt(2.0) * scatter(120))


@pytest.mark.slow
def test_a_thousand_cycles(figures):
    """A thousand cycles: sigmas 0.25 and 0.27 m/s as published."""
    found, valid = errors(meter_settings(mode='signal', window__cycles=1000), 100)
    sigma = show('N = 1000', found, valid, '0.25 / 0.27')
    figures.record('velocity_meter.signal.1000.sigma', sigma[:2], 'm/s', (0.25, 0.27),
                   'Ivanov 2015')
    assert valid == 1.0 and sigma[:2] == pytest.approx((0.25, 0.27), rel=scatter(100))


@pytest.mark.slow
@pytest.mark.parametrize('cycles, windows, beta', [(100, 200, 0.0), (100, 200, 3.0),
                                                   (100, 200, -6.0), (1000, 60, 3.0)])
def test_the_surrogate_agrees(cycles, windows, beta, figures):
    """
    Sigmas and biases in mode signal agree with the surrogate within the scatter of the windows.

    Known deviation: compared with the published figures used in the formulas, the signal is up to
    7 % quieter forward and 7 to 19 % noisier sideways.
    """
    over = OVER_SURROGATE[beta]
    s, beta = meter_settings(mode='signal', window__cycles=cycles), math.radians(beta)
    found, valid = errors(s, windows, beta)
    formula = velocity_sigmas(s.surrogate, cycles, beta)
    sigma = show(f'N = {cycles}, beta = {math.degrees(beta):g} deg', found, valid)
    bias = s.surrogate.bias_x_m_s / cycles
    print(f'  surrogate: sigma {formula[0]:.3f}, {formula[1]:.3f}, bias {bias:+.3f} m/s')
    figures.record(f'velocity_meter.surrogate.{cycles}.{math.degrees(beta):g}.sigma', sigma[:2],
                   'm/s', formula, 'surrogate')
    figures.record(f'velocity_meter.surrogate.{cycles}.{math.degrees(beta):g}.bias_x',
                   found[:, 0].mean(), 'm/s', bias, 'surrogate')
    assert sigma[:2] == pytest.approx(np.multiply(over, formula), rel=scatter(windows))
    # Five standard deviations of a mean; of the lateral scale error of 5.4 % 1.5 % remains.
    mean = found.mean(axis=0)
    assert abs(mean[0] - bias) < 5.0 * sigma[0] / math.sqrt(windows)
    assert abs(mean[1]) < 5.0 * sigma[1] / math.sqrt(windows) + (
        LATERAL_SCALE['window'] * V * abs(math.sin(beta)))


@pytest.mark.slow
def test_normalisation_by_each_cycle_shrinks_the_lateral_velocity(figures):
    """
    Normalisation by cycle reduces the lateral velocity by 5.4 %, as published.

    The mean of a cycle is correlated with the signal from which it is computed.
    """
    beta, scale = math.radians(6.0), {}
    for normalisation in ('cycle', 'window'):
        s = meter_settings(mode='signal', window__cycles=250,
                           signal__normalisation=normalisation)
        found, valid = errors(s, 80, beta)
        show(f'normalisation {normalisation}, N = 250, beta = 6 deg', found, valid)
        scale[normalisation] = found[:, 1].mean() / (V * math.sin(beta))
    print(f'lateral scale error: cycle {scale["cycle"]:+.4f}, window {scale["window"]:+.4f}')
    for name, value in scale.items():
        figures.record(f'velocity_meter.lateral_scale.{name}', 100.0 * value, '%')
    # Four standard deviations of the mean: 1.2/sqrt(80) m/s of 26 m/s.
    assert abs(scale['cycle'] + LATERAL_SCALE['cycle']) < 0.02 and abs(scale['window']) < 0.02


def test_complex_detection_is_quieter():
    """Complex detection has about half the published sigmas, which are for power detection."""
    found, valid = errors(meter_settings(mode='signal', window__cycles=100,
                                         signal__detection='complex'), 60)
    sigma = show('N = 100, complex', found, valid)
    assert valid == 1.0
    assert sigma[:2] == pytest.approx((0.5 * 0.79, 0.5 * 0.87), rel=scatter(60))


@pytest.mark.parametrize('detection', ['power', 'complex'])
@pytest.mark.parametrize('normalisation', ['window', 'cycle'])
def test_every_way_of_correlating_measures(detection, normalisation):
    """
    Each detection and normalisation errs by less than five surrogate sigmas.

    The flight has angle of attack and sideslip.
    """
    v = body(V, math.radians(4.0), math.radians(5.0))
    s = meter_settings({'mode': 'signal', 'window.cycles': 400, 'attack_angle': 'ins',
                        'signal.detection': detection, 'signal.normalisation': normalisation,
                        'antennas.antenna_2': 'left'})
    fix, = VelocityMeter(s).advance(*flight(400, v), flight(400, v)[1])
    print(f'{detection}, {normalisation}: V {fix.velocity[0]:.3f}, {fix.velocity[1]:.3f} for '
          f'{v[0]:.3f}, {v[1]:.3f}, V_y1 {fix.up:.3f} for {v[2]:.3f} m/s')
    assert fix.valid and fix.tan_alpha == pytest.approx(math.tan(math.radians(5.0)))
    assert abs(fix.velocity[0] - v[0]) < 5.0 * fix.sigma[0]
    assert abs(fix.velocity[1] - v[1]) < 5.0 * fix.sigma[1] + (
        LATERAL_SCALE[normalisation] * abs(v[1]))
    assert min(fix.tau) > 0.0 and max(fix.g) < 0.0
    # Sigma uses the sideslip of the INS, which is independent of the error of the fix.
    assert fix.sigma == pytest.approx(velocity_sigmas(s.surrogate, 400, math.atan2(-v[1], v[0])))


def test_the_mounting_error_appears_as_a_lateral_velocity():
    """Antennas rotated to the left by mu read V_z1 = mu V_x1, as the surrogate does."""
    found = {}
    for mode, terms in (('signal', {}), ('surrogate', PERFECT)):
        s = meter_settings({'mode': mode, 'antennas.mounting_yaw_arcmin': 60.0,
                            'window.cycles': 400, **terms})
        found[mode], = VelocityMeter(s).advance(*flight(400))
    mu = math.radians(1.0)
    assert found['surrogate'].velocity == pytest.approx((V * math.cos(mu), -V * math.sin(mu)))
    for a, b, sigma in zip(found['signal'].velocity, found['surrogate'].velocity, (0.4, 0.45)):
        assert abs(a - b) < 5.0 * sigma


def test_delays_beyond_the_lags():
    """A correlator with too few lags cannot measure slow flight; fixes have this reason."""
    s = meter_settings(mode='signal', window__cycles=200, signal__lags=16, signal__snr_db=30.0,
                       limits__speed_min_m_s=100.0)
    slow, fast = (VelocityMeter(s).advance(*flight(200, (v, 0.0, 0.0)))[0] for v in (106.0, V))
    assert slow.status == 'R12 peaks at the last lag' and math.isnan(slow.velocity[0])
    assert fast.valid


def test_a_false_peak_is_refused_by_its_speed():
    """A false peak below the least speed of the instrument makes the fix invalid."""
    fixes = VelocityMeter(meter_settings(mode='signal', window__cycles=1)).advance(*flight(400))
    reasons = {fix.status for fix in fixes if not fix.valid}
    assert 'measured speed outside the limits' in reasons and len(fixes) == 400
    assert all(fix.velocity[0] >= 30.0 for fix in fixes if fix.valid)


def test_neighbouring_cycles_are_independent():
    """Errors of neighbouring cycles are independent: their products have zero mean."""
    s = meter_settings(mode='signal', window__cycles=20)
    found, _ = errors(s, 300)
    x = found[:, :2] - np.median(found[:, :2], axis=0)
    r = (x[1:] * x[:-1]).mean(axis=0) / (x * x).mean(axis=0)
    print(f'correlation of neighbours {r[0]:+.3f}, {r[1]:+.3f}; sigma {1 / math.sqrt(300):.3f}')
    assert (r ** 2 * 299 < chi2.isf(1e-6, 1)).all()
