"""The dynamically tuned gyro compared with its equations, an ODE solver and published values."""

from dataclasses import replace
import math

import numpy as np
import pytest

from ins_sim.core.sensors.tuned_gyro.rotor import loop_gains, PRESETS, TunedGyroParameters
from ins_sim.core.sensors.tuned_gyro.state_space import state_space
from ins_sim.core.sensors.tuned_gyro.report import tuned_gyro_report

SAPEGIN, DAMPED, TACTICAL = (
    PRESETS[k] for k in ('sapegin_2016', 'sapegin_2016_damped', 'tactical'))


def draws(count, seed=3):
    """Yield random open-loop instruments, stable and unstable ones."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        jer, jek = rng.uniform(1e-6, 1e-5), rng.uniform(1e-8, 1e-6)
        yield TunedGyroParameters(
            rng.uniform(1.0, 2.0) * jer, jer, rng.uniform(1.0, 2.0) * jek, jek,
            rng.uniform(50, 400), 10 ** rng.uniform(-8, -6), 10 ** rng.uniform(-7, -4),
            10 ** rng.uniform(-3, -1))


def real_form(p, w):
    """Return direct and cross response of the real open-loop equations with u'."""
    a, s = p.transverse_inertia, 1j * w
    b, h, c = p.input_inertia * p.omega, p.momentum, p.coupling
    own, other = a * s * s + p.damping * s + p.stiffness(), h * s + c
    theta = np.linalg.solve([[own, other], [-other, own]], [-a * s, b])
    return theta * (-c / b)


@pytest.mark.parametrize('w', [-3.0, 0.7, 60.0, 2500.0])
def test_transfer_function_is_that_of_the_real_equations(w):
    """The complex form with v = theta' + u equals the real equations to rounding."""
    for p in [SAPEGIN, DAMPED, *draws(20)]:
        direct, cross = state_space(p).axis_responses(w)
        expected = real_form(p, w)
        np.testing.assert_allclose([direct, cross], expected, rtol=1e-10,
                                   atol=1e-10 * abs(expected).max())


def test_response_and_roots_are_those_of_the_matrices():
    """
    Response and roots agree with LAPACK: (s - F)^-1 g and the eigenvalues of F.

    A double root agrees to half its digits.
    """
    omega = np.array([-3000.0, -1.0, 0.0, 0.3, 200.0, 2600.0])
    for p in [SAPEGIN, DAMPED, TACTICAL, replace(TACTICAL, damping_ratio=0.6), *draws(20)]:
        space = state_space(p)
        left = 1j * omega[:, None, None] * np.eye(len(space.g)) - space.f
        expected = np.linalg.solve(left, np.broadcast_to(space.g[:, None], (6, len(space.g), 1)))
        expected = (expected[..., 0] * space.c).sum(axis=-1) + space.d
        np.testing.assert_allclose(space.response(omega), expected, rtol=0,
                                   atol=1e-11 * abs(expected).max())
        for root in np.linalg.eigvals(space.f):
            bound = 1e-7 if p is TACTICAL else 1e-11
            assert min(abs(np.array(space.roots) - root)) < bound * abs(root)


def test_closed_loop_places_the_roots():
    """The characteristic polynomial is (A (s + Wn) - j H)(s^2 + 2 zeta w0 s + w0^2)."""
    p = replace(TACTICAL, damping_ratio=0.6, nutation_rad_s=150.0)
    w0, z = p.natural_rad_s, p.damping_ratio
    expected = [complex(-150.0, p.momentum / p.transverse_inertia)] + [
        complex(-z * w0, sign * w0 * math.sqrt(1.0 - z * z)) for sign in (-1, 1)]
    found = state_space(p).roots
    for root in expected:
        assert min(abs(np.array(found) - root)) < 1e-9 * abs(root)
    assert -loop_gains(p)[1].imag == pytest.approx(
        2 * z * w0 * p.momentum - p.rotating_damping_n_m_s * p.omega)
    assert p.coupling == pytest.approx(2 * z * w0 * p.momentum)


def test_margin_tells_stability():
    """A c^2 < H c f + k2 f^2 holds if and only if every root decays."""
    kinds = set()
    for p in draws(100):
        for speed in (p.speed_hz, 0.99 * p.speed_hz, 1.01 * p.speed_hz):
            found = tuned_gyro_report(p, speed)
            assert (found.margin > 0.0) == found.stable == (found.decay_1_s > 0.0)
            kinds.add(found.stable)
    assert kinds == {True, False}


def test_figures_of_paper():
    """Time constant, growth of the nutation and RK4 window of sapegin_2016 are as specified."""
    found = tuned_gyro_report(SAPEGIN)
    print('\n' + '\n'.join(found.lines()))
    assert found.time_constant_s == pytest.approx(0.133652, abs=5e-7)
    assert found.roots[0].real == pytest.approx(7.45, abs=0.005) and not found.stable
    low, high = found.rk4_window_s
    assert (1e3 * low, 1e3 * high) == (pytest.approx(0.332, abs=5e-4),
                                       pytest.approx(1.099, abs=5e-4))
    damped = tuned_gyro_report(DAMPED)
    assert damped.stable and damped.rk4_window_s[0] == 0.0
    # Physically stable above 129.5 Hz.
    assert tuned_gyro_report(replace(DAMPED, speed_hz=129.6)).stable
    assert not tuned_gyro_report(replace(DAMPED, speed_hz=129.4)).stable


def test_figures_of_tactical():
    """Bandwidth, peak and gain at 10 Hz of the tactical gyro are as specified."""
    found = tuned_gyro_report(TACTICAL)
    gain = abs(state_space(TACTICAL).axis_responses(20 * math.pi)[0])
    print('\n' + '\n'.join([*found.lines(), f'|G(10 Hz)| = {gain:.6f}']))
    assert found.bandwidth_hz == pytest.approx(86.75, abs=0.005)
    assert found.peak == pytest.approx(1.1535, abs=5e-5)
    assert found.peak_hz == pytest.approx(24.7, abs=0.05)
    assert gain == pytest.approx(1.0644, abs=5e-5)
    assert found.stable and found.margin is None and found.time_constant_s is None


def test_the_printed_equation_diverges():
    """The equation as printed, with one sign of both couplings, diverges as exp(2575 t)."""
    p = SAPEGIN
    a, f, h, c = p.transverse_inertia, p.damping, p.momentum, p.coupling
    grow = np.roots([a, f - h, -c]).real.max()
    print(f'\nthe printed equation grows with {grow:.0f} 1/s')
    assert grow == pytest.approx(2575, abs=1)


def test_residual_stiffness_of_another_speed():
    """Hinges tuned at the nominal speed have k2 = -2 K_t dOmega / Omega at another speed."""
    hinges = (1e-7 - 0.5 * 1.5e-7) * SAPEGIN.omega ** 2
    assert SAPEGIN.stiffness() == 0.0
    assert SAPEGIN.stiffness(230.0 * (1 + 1e-6)) == pytest.approx(-2e-6 * hinges, rel=1e-5)
    given = replace(SAPEGIN, hinge_stiffness_n_m_rad=hinges)
    assert given.stiffness(231.0) == pytest.approx(SAPEGIN.stiffness(231.0), rel=1e-9)


BAD = {
    'rotor_axial_kg_m2 is 6e-06; expected at most twice': {'rotor_axial_kg_m2': 6e-6},
    'ring_axial_kg_m2 is 3e-07; expected at most twice': {'ring_axial_kg_m2': 3e-7},
    'rotor_equatorial_kg_m2 is -1e-06; expected a number above 0':
        {'rotor_equatorial_kg_m2': -1e-6},
    'ring_equatorial_kg_m2 is -1; expected a number not below 0': {'ring_equatorial_kg_m2': -1.0},
    'speed_hz is 0; expected a number above 0': {'speed_hz': 0.0},
    'case_damping_n_m_s is nan; expected a finite number': {'case_damping_n_m_s': math.nan},
    "loop is 'ajar'; expected open or closed": {'loop': 'ajar'},
    'which tunes the rotor at 318.3.* expected within 1% of speed_hz, 230':
        {'hinge_stiffness_n_m_rad': 0.1},
    'cross_feedback_n_m_rad is 0.055 with loop closed': {'loop': 'closed'},
    'are 0 with loop open': {'cross_feedback_n_m_rad': 0.0, 'rotating_damping_n_m_s': 0.0},
    'damping_ratio is 0; expected a number above 0':
        {'loop': 'closed', 'cross_feedback_n_m_rad': 0.0, 'damping_ratio': 0.0},
}


@pytest.mark.parametrize('sentence', BAD)
def test_parameters_that_no_instrument_has(sentence):
    """Impossible parameters raise an error that names key, value and expectation."""
    with pytest.raises(ValueError, match=sentence) as caught:
        replace(SAPEGIN, **BAD[sentence])
    assert '\n' not in str(caught.value)
