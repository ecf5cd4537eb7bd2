"""The aiding scheme of Ivanov (2015), as printed and corrected: error in turns, and stability."""

import math

from support.aided.flights import circle, perfect_fixes, samples_of, straight
from ins_sim.core.aiding.navigator import AidedNavigator, METER
from ins_sim.settings.aided_navigator import AidedNavigatorSettings
from ins_sim.settings.catalogue import build
import numpy as np
import pytest

CYCLES = 1000
EXACT = {'initial.velocity_sigma_m_s': 0.0, 'initial.tilt_sigma_mrad': 0.0,
         'initial.azimuth_sigma_mrad': 0.0, 'meter_model.bias_x_m_s': 0.0}


def fly(motion, filter_name, windows, gain=0.4, bias=(0.0, 0.0), offset=(0.0, 0.0)):
    """
    Return the results of perfect fixes, and the acceleration errors that remain after each.

    bias: added to perfect readings, forward and left, m/s^2; offset: added to the fixes, m/s.
    """
    navigator = AidedNavigator(build(AidedNavigatorSettings, {
        **EXACT, 'filter': filter_name, 'gain': gain, 'window.cycles': CYCLES}))
    innovations, left = [], []
    samples = samples_of(motion, windows * CYCLES + 1, (*bias, 0.0))
    for fix in perfect_fixes(motion, windows, CYCLES, offset):
        navigator.take(METER, fix)
    for sample in samples:
        for taken in navigator.step(*sample):
            innovations.append(taken.outcome)
            left.append(np.subtract(bias, navigator.ins.accelerometer_bias[:2]))
    return innovations, np.array(left)


def test_the_printed_innovation_takes_a_turn_for_an_error_of_8_4_m_s2(figures):
    """
    In a flat turn with perfect data the printed scheme sees an error of 8.378 m/s^2, ours zero.

    At 1.2 deg/s and 200 m/s, 2 w V = 8.378 m/s^2. Bounds: in 40 s the meridians converge by 1e-5
    of the turn, and its radii change by as much, so that the printed innovation is 2 w V within
    1e-4. The corrected scheme is exact in a turn; rounding of the attitude tilts gravity by at
    most 2^-52 in each of 4000 steps.
    """
    printed, _ = fly(circle(), 'paper', 4)
    corrected, _ = fly(circle(), 'paper_corrected', 4)
    false = [math.hypot(*r.innovation) for r in printed[1:]]
    true = [math.hypot(*r.innovation) for r in corrected[1:]]
    expected = 2.0 * math.radians(1.2) * 200.0
    print(f'printed {false[-1]:.4f} m/s^2 (8.378), corrected {max(true):.2e} m/s^2')
    figures.record('paper_scheme.false_innovation', false[-1], 'm/s^2', expected, '2 w V')
    figures.record('paper_scheme.corrected_innovation', max(true), 'm/s^2', 0.0)
    assert expected == pytest.approx(8.378, abs=5e-4)
    assert false == pytest.approx([expected] * 3, rel=1e-4)
    rounding = 4 * CYCLES * 2.0 ** -52 * 9.8
    assert max(true) < 4 * rounding


def test_the_printed_scheme_refuses_a_turn_and_says_so():
    """In a turn the printed scheme corrects nothing, and the reason names filters for turns."""
    results, left = fly(circle(), 'paper', 3)
    assert not any(r.taken for r in results)
    assert results[-1].reason.startswith('filter paper refuses a window in which the body turns')
    assert 'straight leg' in results[-1].reason
    np.testing.assert_array_equal(left, 0.0)


def roots(gain):
    """Return the moduli of the roots of z^2 - (1 - K) z + K, the error of the printed scheme."""
    return np.abs(np.roots([1.0, -(1.0 - gain), gain]))


@pytest.mark.parametrize('gain', [0.1, 0.172, 0.5, 0.9, 1.0])
def test_the_printed_scheme_converges_as_its_polynomial_says(gain):
    """
    On a straight leg the printed scheme obeys the recursion e_{k+1} = e_k - K (e_k + e_{k-1}).

    Bound: 1 % of the first error, for the Schuler oscillation over two minutes and for gravity.
    """
    bias = (0.02, -0.03)
    results, left = fly(straight(), 'paper', 13, gain, bias)
    assert all(r.taken for r in results[1:])
    # The last window before each correction contains the remaining bias.
    for k in range(2, len(left)):
        predicted = left[k - 1] - gain * (left[k - 1] + left[k - 2])
        np.testing.assert_allclose(left[k], predicted, atol=4e-4)
    ratio = np.linalg.norm(left[-1]) / np.linalg.norm(left[0])
    print(f'gain {gain}: largest root {roots(gain).max():.3f}, error left {ratio:.2e}')
    if gain < 1.0:
        assert ratio < 3.0 * len(left) * roots(gain).max() ** (len(left) - 1) + 0.02
    else:
        # The roots are +-i: after three periods of four windows the error has its first value
        # again, to within 1 % per window.
        assert roots(gain).max() == pytest.approx(1.0)
        assert ratio == pytest.approx(1.0, abs=0.01 * len(left))


def test_the_fastest_gain_of_the_printed_scheme_is_0_172(figures):
    """
    The greatest root of the printed scheme is smallest at K = 3 - 2 sqrt 2; at K = 1 it is 1.

    At the smallest value, K = 0.172, both roots have equal moduli.
    """
    gains = np.linspace(0.001, 1.2, 100000)
    # The larger root of the quadratic, for all gains.
    a, b = 1.0 - gains, np.emath.sqrt((1.0 - gains) ** 2 - 4.0 * gains)
    largest = np.maximum(np.abs(a + b), np.abs(a - b)) / 2.0
    best = gains[largest.argmin()]
    print(f'fastest gain {best:.4f}')
    figures.record('paper_scheme.fastest_gain', best, '', 3.0 - 2.0 * math.sqrt(2.0))
    assert best == pytest.approx(3.0 - 2.0 * math.sqrt(2.0), abs=1e-4)
    np.testing.assert_array_equal(largest < 1.0, gains < 1.0)


@pytest.mark.parametrize('gain', [0.3, 0.5, 1.0, 1.9])
def test_the_corrected_scheme_is_stable_up_to_a_gain_of_2(gain):
    """
    On a straight leg the corrected scheme obeys e_{k+1} = (1 - K) e_k, to 1 % of the first error.

    In a turn a remaining velocity error rotates in b and would appear as an acceleration.
    """
    _, left = fly(straight(), 'paper_corrected', 9, gain, (0.02, -0.03))
    for k in range(2, len(left)):
        np.testing.assert_allclose(left[k], (1.0 - gain) * left[k - 1], atol=4e-4)
    print(f'gain {gain}: {np.linalg.norm(left[-1]) / np.linalg.norm(left[0]):.2e} is left')


def test_a_constant_offset_of_the_instrument_is_never_seen():
    """A constant velocity offset of the meter has no effect: only differences are used."""
    for name in ('paper', 'paper_corrected'):
        exact, _ = fly(straight(), name, 4)
        off, _ = fly(straight(), name, 4, offset=(3.0, -2.0))
        # Sums over a window of 200 m/s are rounded to 1e-11 m/s^2.
        np.testing.assert_allclose([r.innovation for r in off[1:]],
                                   [r.innovation for r in exact[1:]], atol=1e-9)
