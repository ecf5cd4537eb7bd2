"""Each sensor error alone has the effect of its equation; without errors the input is kept."""

from dataclasses import replace
import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest
from scipy.linalg import expm
from scipy.stats import chi2

from ins_sim.settings.instrument_errors import AccelerometerErrors, GyroErrors, Temperature
from ins_sim.settings.presets import preset_triads, PRESETS
from ins_sim.core.sensors.imu.triad_errors import (drawn_once, FLICKER_SIGMA, FLICKER_TIMES,
                                                   TriadErrors)
from ins_sim.core.sensors.imu.triad_model import temperature_off
from ins_sim.core.numerics.units import DEG, DEG_H, STANDARD_GRAVITY, UG
from ins_sim.core.sensors.imu.triad_model import FLICKER_FLOOR, noise_variance, triad_model
from ins_sim.report.allan import gauss_markov_variance

DT = 0.01
QUANTILE = 1e-6
U = (0.3, -1.7, 0.004)
F = (1.5, -2.5, 9.9)
ULP = 8.0 * np.finfo(float).eps
WARM = Temperature(reference_c=20.0, constant_c=25.0, ramp_c_h=36.0, amplitude_c=2.0,
                   period_s=400.0)


def three(value):
    """Return a value for all axes."""
    return (value,) * 3


FULL = GyroErrors(
    bias_deg_h=three(1.0), turn_on_bias_sigma_deg_h=three(1.0),
    gauss_markov_sigma_deg_h=three(0.1), angle_random_walk_deg_sqrt_h=three(0.01),
    rate_random_walk_deg_h_sqrt_h=three(0.1), bias_instability_deg_h=three(0.1),
    scale_factor_ppm=three(100.0), scale_factor_sigma_ppm=three(10.0),
    scale_asymmetry_ppm=three(10.0), cubic_ppm_s2_deg2=three(0.01),
    misalignment_mrad=(0.1, 0.2, 0.3), misalignment_sigma_mrad=three(0.1),
    non_orthogonality_mrad=three(0.1), g_sensitivity_deg_h_g=three(0.1),
    g2_sensitivity_deg_h_g2=three(0.1), bandwidth_hz=(20.0, 30.0, 40.0), bandwidth_order=2,
    saturation_deg_s=three(300.0), quantisation_arcsec=three(0.3),
    temperature_bias_deg_h_c=three(0.1), temperature_scale_ppm_c=three(1.0))


def errors_of(settings, seed=1, run=0, name='gyro', dt=DT, temperature=None):
    """Return the TriadErrors for these settings."""
    return TriadErrors(settings, seed, run, name, dt, temperature)


def gyro(**terms):
    """Return TriadErrors of a gyro with these terms on all axes."""
    return errors_of(GyroErrors(**{k: v if isinstance(v, (int, tuple)) else three(v)
                                   for k, v in terms.items()}))


def accelerometer(**terms):
    """Return TriadErrors of accelerometers with these terms on all axes."""
    return errors_of(AccelerometerErrors(**{k: three(v) for k, v in terms.items()}))


@pytest.mark.parametrize('cls', [GyroErrors, AccelerometerErrors])
@pytest.mark.parametrize('temperature', [None, WARM])
def test_no_errors_give_the_input_itself(cls, temperature):
    """Without errors a triad returns the input object itself, for samples and blocks."""
    errors = errors_of(cls(), temperature=temperature)
    value, block = (-0.0, math.pi, 1e-320), np.ones((5, 3))
    assert errors.step(0, value, F, 0.0) is value
    assert errors.advance(0, block, block, np.zeros(5)) is block


@pytest.mark.parametrize('errors, expected', [
    (gyro(bias_deg_h=7.0), lambda u, f: u + 7.0 * DEG_H),
    (accelerometer(bias_ug=-70.0), lambda u, f: u - 70.0 * UG),
    (gyro(scale_factor_ppm=300.0), lambda u, f: u * (1.0 + 300e-6)),
    (gyro(scale_asymmetry_ppm=40.0), lambda u, f: u + 40e-6 * abs(u)),
    (gyro(cubic_ppm_s2_deg2=2.0), lambda u, f: u * (1.0 + 2e-6 * math.degrees(u) ** 2)),
    (accelerometer(quadratic_ug_g2=100.0), lambda u, f: u + 100 * UG * (u / 9.80665) ** 2),
    (accelerometer(cubic_ug_g3=50.0), lambda u, f: u + 50.0 * UG * (u / 9.80665) ** 3),
    (gyro(g_sensitivity_deg_h_g=3.0), lambda u, f: u + 3.0 * DEG_H * f / STANDARD_GRAVITY),
    (gyro(g2_sensitivity_deg_h_g2=3.0),
     lambda u, f: u + 3.0 * DEG_H * (f / STANDARD_GRAVITY) ** 2),
    (gyro(saturation_deg_s=20.0), lambda u, f: max(-20.0 * DEG, min(20.0 * DEG, u)))])
def test_terms_without_memory(errors, expected):
    """Each term without memory changes the input by its equation, within 8 ulp."""
    for index, sign in ((0, 1.0), (1, -1.0)):
        got = errors.step(index, tuple(sign * u for u in U), F, 0.0)
        for value, u, f in zip(got, U, F):
            want = expected(sign * u, f)
            assert abs(value - want) <= ULP * max(abs(want), abs(u))


def test_temperature():
    """The bias and scale factor follow a constant, ramp and sinusoid of the temperature."""
    cls = GyroErrors(temperature_bias_deg_h_c=three(0.5), temperature_scale_ppm_c=three(4.0))
    errors = errors_of(cls, temperature=WARM)
    for t in (0.0, 100.0, 5000.0):
        warm = 5.0 + 0.01 * t + 2.0 * math.sin(2.0 * math.pi * t / 400.0)
        assert temperature_off(WARM, t) == pytest.approx(warm, rel=ULP)
        for value, u in zip(errors.step(0, U, F, t), U):
            assert value == pytest.approx(u + warm * (0.5 * DEG_H + 4e-6 * u), rel=2 * ULP)
    assert errors_of(cls, temperature=Temperature()).perfect


def test_misalignment_and_non_orthogonality():
    """Misalignment is a rotation, to first order a cross product; skewed axes have unit length."""
    a = np.array([2e-3, -1e-3, 0.5e-3])
    turned = np.array(gyro(misalignment_mrad=tuple(1e3 * a)).step(0, U, F, 0.0))
    assert np.linalg.norm(turned) == pytest.approx(np.linalg.norm(U), rel=ULP)
    assert np.abs(turned - (np.array(U) - np.cross(a, U))).max() < a @ a * np.linalg.norm(U)
    skewed = gyro(non_orthogonality_mrad=(3.0, 4.0, 5.0))
    rows = np.array([skewed.step(k, tuple(e), F, 0.0) for k, e in enumerate(np.eye(3))]).T
    assert np.linalg.norm(rows, axis=1) == pytest.approx(np.ones(3), rel=ULP)
    want = [0.0, 0.0, 0.0, math.sin(3e-3), math.sin(4e-3), math.sin(5e-3)]
    assert [rows[0, 1], rows[0, 2], rows[1, 2], rows[1, 0], rows[2, 0], rows[2, 1]] == \
        pytest.approx(want, abs=ULP)


@pytest.mark.parametrize('order', [1, 2])
def test_bandwidth_is_exact_for_a_held_input(order):
    """The lag agrees with the matrix exponential of lag and integral; at f the power is halved."""
    f, dt = 12.0, DT
    w = 2.0 * math.pi * f
    errors = gyro(bandwidth_hz=f, bandwidth_order=order)
    # State: x, x', integral of x, u.
    row = [0.0, 0.0, 0.0, 0.0]
    a = (np.array([[-w, 0, 0, w], row, [1, 0, 0, 0], row]) if order == 1 else
         np.array([[0, 1, 0, 0], [-w * w, -math.sqrt(2.0) * w, 0, w * w], [1, 0, 0, 0], row]))
    step, inputs = expm(a * dt), np.random.default_rng(1).normal(size=200)
    state, worst = np.array([inputs[0], 0.0, 0.0, 0.0]), 0.0
    for k, u in enumerate(inputs.tolist()):
        state[2:] = 0.0, u
        state = step @ state
        got = errors.step(k, three(u), F, 0.0)[1]
        worst = max(worst, abs(got - state[2] / dt))
    print(f'order {order}: largest difference from expm {worst:.1e}')
    assert worst < 1e-13
    fine = errors_of(GyroErrors(bandwidth_hz=three(5.0), bandwidth_order=order), dt=1e-4)
    t = 1e-4 * np.arange(20000)
    wave = np.sin(2.0 * math.pi * 5.0 * t)
    out = fine.advance(0, np.stack([wave] * 3, -1), np.zeros((20000, 3)), t)[10000:, 0]
    # Holding the input reduces the amplitude by (w dt)^2/24.
    assert abs(np.sqrt(2.0 * np.mean(out ** 2)) - math.sqrt(0.5)) < 1e-6


def test_pulses_carry_their_remainder():
    """Readings are whole pulses, and their sum stays within half a pulse of the increments."""
    quantum = 0.7 * DEG / 3600.0
    errors = gyro(quantisation_arcsec=0.7)
    u = 1e-4 * np.random.default_rng(2).normal(size=(5000, 3)) + 1e-5
    got = errors.advance(0, u, np.zeros((5000, 3)), np.zeros(5000))
    pulses = got * DT / quantum
    assert np.abs(pulses - np.round(pulses)).max() < 1e-9
    behind = np.abs(np.cumsum(got - u, axis=0)).max() * DT / quantum
    print(f'largest remainder {behind:.4f} pulses')
    assert 0.49 < behind < 0.5 + 1e-9


def test_turn_on_terms_are_drawn_once_a_run():
    """Turn-on terms are constant in a run; mean and variance over 3000 runs are as set."""
    runs = np.array([drawn_once(4, run, 'gyro.turn_on_bias', (2.0, 3.0, 4.0))
                     for run in range(3000)])
    z = runs / (2.0, 3.0, 4.0)
    low, high = chi2.ppf([QUANTILE, 1.0 - QUANTILE], z.size)
    print(f'chi-square {np.sum(z * z):.0f} of {z.size} ({low:.0f} to {high:.0f})')
    assert low < np.sum(z * z) < high
    assert len(z) * np.sum(z.mean(axis=0) ** 2) < chi2.isf(QUANTILE, 3)
    assert np.abs(np.corrcoef(z.T)[np.triu_indices(3, 1)]).max() < 4.0 / math.sqrt(len(z))
    errors = gyro(turn_on_bias_sigma_deg_h=2.0)
    got = {errors.step(k, (0.0, 0.0, 0.0), F, 0.0) for k in (0, 1, 500, 10 ** 6)}
    assert got == {drawn_once(1, 0, 'gyro.turn_on_bias', three(2.0 * DEG_H))}
    scaled = gyro(scale_factor_sigma_ppm=50.0).step(0, three(1.0), F, 0.0)
    assert scaled == tuple(1.0 + s for s in drawn_once(1, 0, 'gyro.scale_factor', three(50e-6)))


@pytest.mark.parametrize('name', PRESETS)
def test_variance_is_that_of_noise_and_pulses(name):
    """
    The reported variance is that of white noise (chi-square), and within 3 % with pulses.

    With pulses it is N^2/dt + (q/dt)^2/6.
    """
    n, kinds = 30000, (GyroErrors, AccelerometerErrors)
    for settings_of, cls in zip(preset_triads(name), kinds):
        model = triad_model(settings_of, DT)
        keys = [k for k in cls.__dataclass_fields__ if 'walk' in k and k.endswith('_sqrt_h')
                and ('angle' in k or 'velocity' in k)]
        only = cls(**{k: getattr(settings_of, k) for k in keys})
        zero = np.zeros((n, 3))
        white = errors_of(only).advance(0, zero, zero, zero[:, 0]) / np.sqrt(
            noise_variance(triad_model(only, DT), DT))
        low, high = chi2.ppf([QUANTILE, 1.0 - QUANTILE], white.size)
        assert low < np.sum(white ** 2) < high
        assert np.abs(np.mean(white[1:] * white[:-1])) < 4.0 / math.sqrt(n)
        quantum = [k for k in cls.__dataclass_fields__ if k.startswith('quantisation')][0]
        both = replace(only, **{quantum: getattr(settings_of, quantum)})
        # An input that moves over many pulses makes the remainders uniform.
        u = np.outer(np.sin(np.arange(n) * 0.1), np.array([1.0, 0.7, 0.9]))
        rest = errors_of(both).advance(0, u, zero, zero[:, 0]) - u
        ratio = rest.var(axis=0) / noise_variance(model, DT)
        print(f'{name} {cls.__name__}: variance / reported {ratio.round(4)}')
        assert np.abs(ratio - 1.0).max() < 0.03


def test_flicker_is_flat_at_its_floor():
    """The Allan deviation of flicker noise is 0.664 B within 2.5 % from 1 s to 30000 s."""
    tau = np.geomspace(1.0, 3e4, 200)
    floor = np.sqrt(sum(gauss_markov_variance(tau, FLICKER_SIGMA, t) for t in FLICKER_TIMES))
    off = np.abs(floor / FLICKER_FLOOR - 1.0).max()
    print(f'flicker floor off by at most {off:.4f}')
    assert off < 0.025


def test_in_run_terms_have_their_units():
    """Gauss-Markov process and random walks have the set variance after 1 h, in 200 runs."""
    end = 3600.0
    for terms, sigma in (({'gauss_markov_sigma_deg_h': 0.3}, 0.3),
                         ({'gauss_markov_sigma_deg_h': 0.3, 'gauss_markov_time_s': math.inf}, 0.3),
                         ({'rate_random_walk_deg_h_sqrt_h': 0.2}, 0.2)):
        errors = GyroErrors(**{k: three(v) for k, v in terms.items()})
        z = np.array([errors_of(errors, run=run, dt=0.1).step(36000, (0.0,) * 3, F, end)
                      for run in range(100)]) / (sigma * DEG_H)
        low, high = chi2.ppf([QUANTILE, 1.0 - QUANTILE], z.size)
        assert low < np.sum(z * z) < high, terms


def inputs(n):
    """Return values, forces and times of n samples."""
    rng = np.random.default_rng(5)
    return rng.normal(size=(n, 3)), rng.normal(size=(n, 3)), DT * np.arange(n)


@settings(max_examples=15, deadline=None)
@given(cuts=st.lists(st.integers(1, 699), max_size=6, unique=True), first=st.integers(0, 10 ** 8))
def test_any_cutting_gives_the_same_bits(cuts, first):
    """With all errors on, one block, cut blocks and single steps agree bit for bit."""
    values, forces, t = inputs(700)
    whole = errors_of(FULL, temperature=WARM).advance(first, values, forces, t)
    one, other = errors_of(FULL, temperature=WARM), errors_of(FULL, name='other')
    parts = []
    for start, end in zip([0, *sorted(cuts)], [*sorted(cuts), 700]):
        parts.append(one.advance(first + start, values[start:end], forces[start:end],
                                 t[start:end]))
        other.step(start, U, F, 0.0)
    assert np.array_equal(np.concatenate(parts), whole)
    state = None
    single = errors_of(FULL, temperature=WARM)
    for k, (u, f, now) in enumerate(zip(values.tolist(), forces.tolist(), t.tolist())):
        if k == 300:
            state = single.state
        assert single.step(first + k, tuple(u), tuple(f), now) == tuple(whole[k])
    again = errors_of(FULL, temperature=WARM)
    again.state = state
    assert np.array_equal(again.advance(first + 300, values[300:], forces[300:], t[300:]),
                          whole[300:])


def test_noise_does_not_depend_on_loss_or_start():
    """The noise of a sample depends on its index only, whichever samples came before."""
    noise = replace(FULL, bandwidth_hz=three(0.0), quantisation_arcsec=three(0.0))
    values, forces, t = inputs(1000)
    whole = errors_of(noise).advance(0, values, forces, t)
    lossy = errors_of(noise)
    for k in (999, 3, 4, 700, 256, 255):
        assert lossy.step(k, tuple(values[k]), tuple(forces[k]), t[k]) == tuple(whole[k])


def test_sensors_axes_runs_and_seeds_are_independent():
    """Sensors, axes, runs and seeds are independent: correlations below 4/sqrt(n)."""
    n = 10000
    white = GyroErrors(angle_random_walk_deg_sqrt_h=three(1.0))
    zero = np.zeros((n, 3))
    rows = np.concatenate([errors_of(white, seed, run, name).advance(0, zero, zero, zero[:, 0])
                           for seed, run, name in ((1, 0, 'gyro'), (1, 1, 'gyro'),
                                                   (2, 0, 'gyro'), (1, 0, 'other'))], axis=1)
    worst = np.abs(np.corrcoef(rows.T)[np.triu_indices(12, 1)]).max()
    print(f'largest correlation {worst:.4f}; bound {4 / math.sqrt(n):.4f}')
    assert worst < 4.0 / math.sqrt(n)
