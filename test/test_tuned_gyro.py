"""The dynamically tuned gyro against its equations, an ODE solver and reference figures."""

from dataclasses import replace
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ins_sim.core.sensors.tuned_gyro.rotor import (loop_gains, PRESETS, state_space,
                                                   TunedGyroParameters)
from ins_sim.core.sensors.tuned_gyro.report import tuned_gyro_report
from ins_sim.core.sensors.tuned_gyro.stepping import TunedGyro

PAPER, DAMPED, TACTICAL = (PRESETS[k] for k in ('paper', 'paper_damped', 'tactical'))
STABLE = {'paper_damped': DAMPED, 'tactical': TACTICAL,
          'tactical, zeta 0.7': replace(TACTICAL, damping_ratio=0.7)}


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
    """Return direct and cross response of the real open-loop equations with u' (section 1)."""
    a, s = p.transverse_inertia, 1j * w
    b, h, c = p.input_inertia * p.omega, p.momentum, p.coupling
    own, other = a * s * s + p.damping * s + p.stiffness(), h * s + c
    theta = np.linalg.solve([[own, other], [-other, own]], [-a * s, b])
    return theta * (-c / b)


@pytest.mark.parametrize('w', [-3.0, 0.7, 60.0, 2500.0])
def test_transfer_function_is_that_of_the_real_equations(w):
    """The complex form with v = theta' + u is the real one, to rounding."""
    for p in [PAPER, DAMPED, *draws(20)]:
        direct, cross = state_space(p).axis_responses(w)
        expected = real_form(p, w)
        np.testing.assert_allclose([direct, cross], expected, rtol=1e-10,
                                   atol=1e-10 * abs(expected).max())


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
    """A c^2 < H c f + k2 f^2 holds where every root decays, and nowhere else."""
    kinds = set()
    for p in draws(100):
        for speed in (p.speed_hz, 0.99 * p.speed_hz, 1.01 * p.speed_hz):
            found = tuned_gyro_report(p, speed)
            assert (found.margin > 0.0) == found.stable == (found.decay_1_s > 0.0)
            kinds.add(found.stable)
    assert kinds == {True, False}


def test_figures_of_paper():
    """Time constant, growth of the nutation and RK4 window of the reference, to its digits."""
    found = tuned_gyro_report(PAPER)
    print('\n' + '\n'.join(found.lines()))
    assert found.time_constant_s == pytest.approx(0.133652, abs=5e-7)
    assert found.roots[0].real == pytest.approx(7.45, abs=0.005) and not found.stable
    low, high = found.rk4_window_s
    assert (1e3 * low, 1e3 * high) == (pytest.approx(0.332, abs=5e-4),
                                       pytest.approx(1.099, abs=5e-4))
    damped = tuned_gyro_report(DAMPED)
    assert damped.stable and damped.rk4_window_s[0] == 0.0
    # physically stable above 129.5 Hz
    assert tuned_gyro_report(replace(DAMPED, speed_hz=129.6)).stable
    assert not tuned_gyro_report(replace(DAMPED, speed_hz=129.4)).stable


def test_figures_of_tactical():
    """-3 dB, peak and gain at 10 Hz of the reference, to its digits."""
    found = tuned_gyro_report(TACTICAL)
    gain = abs(state_space(TACTICAL).axis_responses(20 * math.pi)[0])
    print('\n' + '\n'.join([*found.lines(), f'|G(10 Hz)| = {gain:.6f}']))
    assert found.bandwidth_hz == pytest.approx(86.75, abs=0.005)
    assert found.peak == pytest.approx(1.1535, abs=5e-5)
    assert found.peak_hz == pytest.approx(24.7, abs=0.05)
    assert gain == pytest.approx(1.0644, abs=5e-5)
    assert found.stable and found.margin is None and found.time_constant_s is None


def test_the_printed_equation_diverges():
    """With one sign of the coupling in both rows it grows as exp(2575 t)."""
    p = PAPER
    a, f, h, c = p.transverse_inertia, p.damping, p.momentum, p.coupling
    grow = np.roots([a, f - h, -c]).real.max()
    print(f'\nthe printed equation grows with {grow:.0f} 1/s')
    assert grow == pytest.approx(2575, abs=1)


def solved(space, u, steps, dt):
    """Return mean readings (steps,) and states (steps + 1, n) by DOP853 at 1e-12."""
    n = len(space.g)

    def slope(t, z):
        return np.append(space.f @ z[:n] + space.g * u(t), space.c @ z[:n] + space.d * u(t))

    t = dt * np.arange(steps + 1)
    z = solve_ivp(slope, (0.0, t[-1]), np.zeros(n + 1, dtype=complex), method='DOP853',
                  t_eval=t, rtol=1e-12, atol=1e-14).y
    return np.diff(z[n]) / dt, z[:n].T


def triples(u, steps, dt):
    """Return the rates (steps, 3) at start, middle and end of each step."""
    t = dt * (np.arange(steps)[:, None] + np.array((0.0, 0.5, 1.0)))
    return np.vectorize(u, otypes=[complex])(t)


@pytest.mark.parametrize('name', STABLE)
def test_exact_steps_against_an_ode_solver(name):
    """
    20 Hz, 1 ms: 1e-6 of the reading's amplitude (quadratic hold), (w h)^2 / 12 (linear).

    The start from zero with a jump of the rate is in it; later the error is a third of that.  The
    reading of an instant, which no sample gives, is held to twice as much.
    """
    p, dt, steps, w = STABLE[name], 1e-3, 200, 40 * math.pi

    def u(t):
        return math.sin(w * t) + 0.3j * math.cos(w * t + 0.3)

    mean, states = solved(state_space(p), u, steps, dt)
    inputs, size = triples(u, steps, dt), abs(mean).max()
    for hold, bound in (('quadratic', 1e-6), ('linear', 1.5 * (w * dt) ** 2 / 12.0)):
        gyro = TunedGyro(p, dt, hold=hold)
        errors = abs(gyro.advance(inputs) - mean) / size
        error, later = errors.max(), errors[50:].max()
        last = gyro.reading(u(steps * dt))
        at_end = abs(last - state_space(p).c @ states[-1] - state_space(p).d * u(steps * dt))
        print(f'\n{name}, {hold}: mean reading off by {error:.2e}, after 50 ms by {later:.2e}, '
              f'reading of the last instant by {at_end / size:.2e} (bound {bound:.1e})')
        assert error <= bound and at_end / size <= 2.0 * bound


@pytest.mark.parametrize('hz', [1, 5, 10, 20, 50, 100])
def test_frequency_response_by_simulation(hz):
    """`tactical` within 1e-4 of the transfer function; the step is 0.5 ms, see below at 1 ms."""
    w = 2 * math.pi * hz
    expected = state_space(TACTICAL).axis_responses(w)
    for dt, bound in ((0.5e-3, 1e-4), (1e-3, 2e-4)):
        settle, count = round(0.2 / dt), round(1.0 / dt)
        gyro = TunedGyro(TACTICAL, dt)
        found = gyro.advance(triples(lambda t: math.cos(w * t), settle + count, dt))[settle:]
        t = dt * (settle + np.arange(count))
        mean_input = (np.sin(w * (t + dt)) - np.sin(w * t)) / (w * dt)
        carrier = np.exp(-1j * w * t)
        direct, cross = ((found.real @ carrier, found.imag @ carrier)
                         / (mean_input @ carrier))
        error = max(abs(direct - expected[0]), abs(cross - expected[1]))
        print(f'\n{hz} Hz, {1e3 * dt} ms: {abs(direct):.6f}, off by {error:.2e}')
        assert error <= bound


@pytest.mark.parametrize('p', [PAPER, TACTICAL], ids=['paper', 'tactical'])
def test_rk4_matrices_are_the_program_of_the_paper(p):
    """The linear map of a step equals the four stages written out, to rounding."""
    dt, space, gyro = 0.75e-3, state_space(p), TunedGyro(p, 0.75e-3, method='rk4')
    x = np.zeros(len(space.g), dtype=complex)
    for k in range(40):
        u0, um, u1 = (complex(math.sin(30 * t), math.cos(50 * t))
                      for t in (k * dt, (k + 0.5) * dt, (k + 1) * dt))
        k1 = space.f @ x + space.g * u0
        k2 = space.f @ (x + dt / 2 * k1) + space.g * um
        k3 = space.f @ (x + dt / 2 * k2) + space.g * um
        k4 = space.f @ (x + dt * k3) + space.g * u1
        at = (x, x + dt / 2 * k1, x + dt / 2 * k2, x + dt * k3)
        expected = [space.c @ s + space.d * u for s, u in zip(at, (u0, um, um, u1))]
        np.testing.assert_allclose(gyro.step_stages(u0, um, u1), expected, rtol=0, atol=1e-11)
        x = x + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    np.testing.assert_allclose(gyro.physical_state, x, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize('name', STABLE)
def test_any_cutting_gives_the_same_bits(name):
    """Blocks, single steps and a restored state agree bit for bit."""
    rng = np.random.default_rng(1)
    u = rng.normal(size=(100, 3)) + 1j * rng.normal(size=(100, 3))
    whole = TunedGyro(STABLE[name], 1e-3).advance(u)
    gyro = TunedGyro(STABLE[name], 1e-3)
    cuts = [0, *sorted(rng.integers(1, 100, 6)), 100]
    parts = [gyro.advance(u[a:b]) for a, b in zip(cuts, cuts[1:]) if b > a]
    assert np.array_equal(np.concatenate(parts), whole)
    gyro = TunedGyro(STABLE[name], 1e-3)
    first, kept = gyro.advance(u[:50]), gyro.state
    gyro.advance(u[10:20])
    gyro.state = kept
    assert np.array_equal(np.concatenate([first, gyro.advance(u[50:])]), whole)


def test_modes_are_used_where_they_are_apart(monkeypatch):
    """A double root has none; elsewhere modal and full steps agree."""
    assert not TunedGyro(TACTICAL, 1e-3).modal
    u = np.exp(1j * np.arange(600).reshape(200, 3))
    for p in (DAMPED, STABLE['tactical, zeta 0.7']):
        modal = TunedGyro(p, 1e-3)
        found = modal.advance(u)
        with monkeypatch.context() as patch:
            patch.setattr('ins_sim.core.sensors.tuned_gyro.stepping.modes', lambda space: None)
            full = TunedGyro(p, 1e-3)
        assert modal.modal and not full.modal
        np.testing.assert_allclose(found, full.advance(u), rtol=0, atol=1e-12)


def test_change_of_speed():
    """The reading scales as Omega / Omega_nom (closed loop), the tilt is kept."""
    gyro = TunedGyro(TACTICAL, 1e-3)
    for _ in range(300):
        steady = gyro.step(1.0, 1.0, 1.0)
    before = gyro.physical_state
    assert steady == pytest.approx(1.0, abs=1e-12)
    gyro.set_speed(230.0 * 1.001)
    np.testing.assert_allclose(gyro.physical_state, before, rtol=0, atol=1e-14)
    for _ in range(300):
        steady = gyro.step(1.0, 1.0, 1.0)
    assert steady == pytest.approx(1.001, abs=1e-12)
    # open loop: the read-out is the nominal one, k2 turns the reading into the other axis
    c = PAPER.rotating_damping_n_m_s * 2 * math.pi * 231.0 + PAPER.cross_feedback_n_m_rad
    expected = 231.0 / 230.0 * PAPER.coupling / complex(c, PAPER.stiffness(231.0))
    assert state_space(PAPER, 231.0).response(0.0) == pytest.approx(expected, rel=1e-12)


def test_residual_stiffness_of_another_speed():
    """Hinges fixed at the nominal speed leave k2 = -2 K_t dOmega / Omega (section 6)."""
    hinges = (1e-7 - 0.5 * 1.5e-7) * PAPER.omega ** 2
    assert PAPER.stiffness() == 0.0
    assert PAPER.stiffness(230.0 * (1 + 1e-6)) == pytest.approx(-2e-6 * hinges, rel=1e-5)
    given = replace(PAPER, hinge_stiffness_n_m_rad=hinges)
    assert given.stiffness(231.0) == pytest.approx(PAPER.stiffness(231.0), rel=1e-9)


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
    """One sentence that names key, value and expectation."""
    with pytest.raises(ValueError, match=sentence) as caught:
        replace(PAPER, **BAD[sentence])
    assert '\n' not in str(caught.value)


UNSTABLE = {
    'the gyro is unstable: a root grows with 7.447 1/s at 408.7 Hz': (PAPER, 1e-3, {}),
    'the RK4 step is 0.3 ms, .* expected between 0.3322 and 1.099 ms':
        (PAPER, 0.3e-3, {'method': 'rk4'}),
    'the RK4 step is 1.1 ms, .* expected between': (PAPER, 1.1e-3, {'method': 'rk4'}),
    'unstable and no RK4 step damps it':
        (replace(PAPER, cross_feedback_n_m_rad=20.0), 1e-3, {'method': 'rk4'}),
    'method is .euler.; expected exact or rk4': (DAMPED, 1e-3, {'method': 'euler'}),
    'hold is .cubic.; expected quadratic or linear': (DAMPED, 1e-3, {'hold': 'cubic'}),
    'dt_s is 0.0; expected a finite number above 0': (DAMPED, 0.0, {}),
}


@pytest.mark.parametrize('sentence', UNSTABLE)
def test_instruments_that_would_grow_are_refused(sentence):
    """Unless a warning is asked for."""
    parameters, dt, options = UNSTABLE[sentence]
    with pytest.raises(ValueError, match=sentence):
        TunedGyro(parameters, dt, **options)
    if 'unstable' in sentence or 'RK4' in sentence:
        with pytest.warns(UserWarning, match=sentence):
            TunedGyro(parameters, dt, on_unstable='warn', **options)


@pytest.mark.parametrize('dt', [0.34e-3, 0.75e-3, 1.09e-3])
def test_rk4_inside_its_window_takes_the_paper_preset(dt):
    """No warning, no refusal; the state stays bounded."""
    gyro = TunedGyro(PAPER, dt, method='rk4')
    last = [gyro.step(1.0, 1.0, 1.0) for _ in range(20000)][-1]
    assert abs(last - 1.0) < 0.2
