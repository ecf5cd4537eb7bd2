"""Fits and equations of the velocity meter on correlation functions without noise."""

import math

from hypothesis import given, strategies as st
from support.meter_studies import meter_settings
import numpy as np
import pytest

from ins_sim.core.timeseries.fixes import VALID
from ins_sim.core.sensors.velocity_meter.reading import (auto_peak, cross_peak, delay_velocity,
                                                         log_quadratic, read_correlations,
                                                         slowness)
from ins_sim.core.sensors.velocity_meter.antennas import antenna_geometry
from ins_sim.core.sensors.velocity_meter.pulses import Field

V = 250.0


def noise_free(speed, beta, alpha=0.0, taken=None, **terms):
    """Return the Reading of expected functions; taken: the assumed alpha, by default the true."""
    s = meter_settings(mode='signal', **terms)
    field = Field(s)
    functions = field.correlations(s.signal.lags, speed * math.cos(beta), speed * math.sin(beta),
                                   math.tan(alpha), s.signal.detection)
    return read_correlations(functions, field.lag_s, antenna_geometry(s.antennas),
                             math.tan(alpha if taken is None else taken))


def test_the_published_noise_free_check():
    """The published noise-free example is reproduced to its last printed digit."""
    one = noise_free(V, math.radians(3.0))
    tau = [1e6 * t for t in one.tau]
    print(f'V = 250 m/s, beta = +3 deg: tau12 {tau[0]:.4f}, tau23 {tau[1]:.4f} us, V_x '
          f'{one.v_x:.5f}, V_z {one.v_z:+.5f}, by delays {one.v_z_delays:+.5f} m/s')
    assert one.status == VALID
    assert tau == pytest.approx([391.0781, 407.8256], abs=5e-5)
    assert (one.v_x, one.v_z) == pytest.approx((249.65738, 13.08399), abs=5e-6)
    assert one.v_z_delays == pytest.approx(13.08399, abs=5e-6)


@pytest.mark.parametrize('side', ['right', 'left'])
@pytest.mark.parametrize('offsets', ['physical', 'effective'])
@pytest.mark.parametrize('detection', ['power', 'complex'])
@pytest.mark.parametrize('beta', [-5.0, -0.5, 0.0, 5.0])
def test_signs_and_factors(side, offsets, detection, beta):
    """Signs and factors hold for both sides, kinds of offset, detections and slip directions."""
    beta = math.radians(beta)
    x0, y0 = (0.2, 0.08) if offsets == 'physical' else (0.1, 0.04)
    one = noise_free(V, beta, signal__detection=detection, antennas__x0_m=x0, antennas__y0_m=y0,
                     antennas__antenna_2=side, antennas__offsets=offsets)
    assert one.status == VALID
    # Rounding of logarithms in a fit over a few lags.
    wanted = V * math.cos(beta), V * math.sin(beta), V * math.sin(beta)
    assert (one.v_x, one.v_z, one.v_z_delays) == pytest.approx(wanted, abs=1e-9 * V)
    # Antenna 2 is on the right: on a track to the right it passes sooner after antenna 1.
    assert np.sign(round(1e12 * (one.tau[0] - one.tau[1]))) == \
        -np.sign(beta) * (1 if side == 'right' else -1)


@pytest.mark.parametrize('alpha', [-8.0, 3.0, 10.0])
def test_angle_of_attack(alpha):
    """With the true angle of attack, equation (3) gives V cos(beta) and the body components."""
    alpha, beta = math.radians(alpha), math.radians(4.0)
    one = noise_free(V, beta, alpha)
    a, b = slowness(one.tau, antenna_geometry(meter_settings().antennas), math.tan(alpha))
    trace, _ = delay_velocity(a, b, antenna_geometry(meter_settings().antennas))
    print(f'alpha = {math.degrees(alpha):.0f} deg: (3) {trace:.6f}, V cos(beta) '
          f'{V * math.cos(beta):.6f}, V_x1 {one.v_x:.6f}, V_z1 {one.v_z:.6f} m/s')
    assert trace == pytest.approx(V * math.cos(beta), rel=1e-9)
    assert one.v_x == pytest.approx(V * math.cos(beta) * math.cos(alpha), rel=1e-9)
    assert one.v_z == pytest.approx(V * math.sin(beta), rel=1e-9)


@pytest.mark.parametrize('alpha, taken', [(5.0, 0.0), (5.0, 4.0), (0.0, 5.0)])
def test_a_wrong_angle_of_attack_scales_both_components(alpha, taken):
    """A wrong angle of attack scales both components by (cos assumed / cos true)^2."""
    alpha, taken, beta = map(math.radians, (alpha, taken, 0.5))
    one = noise_free(V, beta, alpha, taken)
    factor = (math.cos(taken) / math.cos(alpha)) ** 2
    bound = 4.0 * beta ** 2 * abs(factor - 1.0) + 1e-9
    assert one.v_x / (V * math.cos(beta) * math.cos(alpha)) == pytest.approx(factor, abs=bound)
    assert one.v_z / (V * math.sin(beta)) == pytest.approx(factor, abs=bound)


@pytest.mark.parametrize('ratio', [0.9, 1.05, 1.1])
def test_an_elliptical_beam_scales_the_lateral_velocity(ratio):
    """
    An elliptical beam scales V_z by 1 + k_z = (sigma_theta_z/sigma_theta_x)^2, up to beta^2.

    This holds by amplitudes and by delays.
    """
    beta = math.radians(1.0)
    one = noise_free(V, beta, beam__sigma_theta_z_rad=0.1 * ratio)
    truth = V * math.sin(beta)
    print(f'sigma_theta_z/sigma_theta_x = {ratio:g}: V_z x {one.v_z / truth:.6f}, square '
          f'{ratio ** 2:.6f}')
    bound = 4.0 * ratio ** 4 * beta ** 2
    assert one.v_z / truth == pytest.approx(ratio ** 2, abs=bound)
    assert one.v_z_delays / truth == pytest.approx(ratio ** 2, abs=bound)
    assert one.v_x == pytest.approx(V, rel=bound)


def test_a_field_that_decays_reads_fast():
    """A decaying field shortens the delays: V_x reads large by 1 + L^2/(V T_d)^2."""
    length, decay = 0.07 / (0.4 * math.pi), 2e-3
    one = noise_free(V, 0.0, signal__decay_time_s=decay)
    factor = 1.0 + (length / (V * decay)) ** 2
    print(f'T_d = 2 ms: V_x x {one.v_x / V:.6f}, 1 + L^2/(V T_d)^2 = {factor:.6f}')
    assert one.v_x / V == pytest.approx(factor, rel=1e-9)


@given(g=st.floats(-2.0, -0.01), peak=st.floats(2.0, 9.0), c=st.floats(-3.0, 3.0),
       first=st.integers(0, 5), even=st.booleans())
def test_the_fit_is_exact_on_gaussians(g, peak, c, first, even):
    """The fit is exact for Gaussian functions of any width, position and height."""
    peak = 0.0 if even else peak
    values = [math.exp(g * (k - peak) ** 2 + c) for k in range(first, first + 6)]
    found_g, d, found_c = log_quadratic(values, first, even)
    # Three lags determine the parabola: rounding divided by the weight of the third.
    tolerance = 1e-12 / (sorted(values)[-3] / max(values)) ** 2
    if tolerance < 1e-4:
        assert found_g == pytest.approx(g, rel=tolerance / -g)
        assert d == pytest.approx(-2.0 * g * peak, abs=20.0 * tolerance)
        assert found_c == pytest.approx(g * peak ** 2 + c, abs=100.0 * tolerance)


@pytest.mark.parametrize('even', [True, False])
def test_weights_that_vanish(even):
    """Weights that vanish at all but one lag give NaN, not an exception."""
    assert math.isnan(log_quadratic([1.0, 1e-9, 1e-20, 1e-300], 1, even)[0])
    assert auto_peak([9.0, 1.0, 1e-9, 1e-20, 1e-300]).status == 'has no maximum in the fit'


def test_correlated_noise_counts_by_its_weight():
    """The weights are C^2: the derivative of the fit to a lag is that of a weighted polynomial."""
    values = [0.5, 0.8, 1.0, 0.7, 0.45]
    g, d, c = log_quadratic(values, 3)
    expected = np.polyfit(np.arange(3, 8), np.log(values), 2, w=values)
    assert (g, d, c) == pytest.approx(tuple(expected), rel=1e-9)
    even = log_quadratic(values[2:], 1, even=True)
    matrix = np.array([[1.0, 1.0], [4.0, 1.0], [9.0, 1.0]]) * np.array(values[2:])[:, None]
    expected = np.linalg.lstsq(matrix, np.log(values[2:]) * values[2:], rcond=None)[0]
    assert (even[0], even[2]) == pytest.approx(tuple(expected), rel=1e-9)


@pytest.mark.parametrize('values, says', [
    ([3.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0], 'peaks at the first lag'),
    ([1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 2.0], 'peaks at the last lag'),
    ([-3.0, -2.0, -1.0, -1.5, -2.0, -3.0, -3.0, -3.0], 'has no positive value'),
    ([0.0, 0.1, 0.3, 1.0, 0.3, -0.1, 0.0, 0.0], 'has a value that is not positive in the fit'),
    ([0.0, 0.9, 0.6, 0.51, 0.9, 1.0, 0.99, 0.0], 'has no maximum in the fit')])
def test_peaks_that_are_none(values, says):
    """Cross-correlations without a usable peak make the fix invalid, with a reason."""
    assert cross_peak(values).status == says


def test_autocorrelations_that_have_no_peak():
    """Autocorrelations without a usable peak give their reason; lag 0 is ignored."""
    assert auto_peak([9.0, 1.0, 0.4, -0.1, 0.0]).status == \
        'has a value that is not positive in the fit'
    assert auto_peak([9.0, 1.0, 1.1, 1.2, 0.3]).status == 'has no maximum in the fit'
    found = auto_peak([9.0] + [2.0 * math.exp(-0.3 * k * k) for k in range(1, 9)])
    assert found.status == VALID and (found.g, found.ln_max) == pytest.approx((-0.3, math.log(2)))
    narrow = auto_peak([9.0] + [math.exp(-2.0 * k * k) for k in range(1, 9)])
    assert narrow.g == pytest.approx(-2.0)


def test_amplitudes_beyond_45_deg():
    """Amplitudes with |sin(2 beta)| > 1 give no sideslip."""
    s = meter_settings(mode='signal')
    field = Field(s)
    functions = field.correlations(64, V, 0.0, 0.0, 'power')
    functions[0] *= 0.05
    assert read_correlations(functions, field.lag_s, antenna_geometry(s.antennas), 0.0).status == \
        'amplitudes of R12 and R23 give no sideslip'
    functions[1, 63] = 2.0
    assert read_correlations(functions, field.lag_s, antenna_geometry(s.antennas), 0.0).status == \
        'R23 peaks at the last lag'
