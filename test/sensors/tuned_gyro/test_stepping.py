"""Steps of a tuned gyro: against an ODE solver, in any cutting, and inside the RK4 window."""

from dataclasses import replace
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from ins_sim.core.sensors.tuned_gyro.report import tuned_gyro_report
from ins_sim.core.sensors.tuned_gyro.rotor import PRESETS
from ins_sim.core.sensors.tuned_gyro.stability import rk4_amplification
from ins_sim.core.sensors.tuned_gyro.state_space import state_space
from ins_sim.core.sensors.tuned_gyro.step_matrices import exact_matrices, HOLDS
from ins_sim.core.sensors.tuned_gyro.stepping import TunedGyro

SAPEGIN, DAMPED, TACTICAL = (
    PRESETS[k] for k in ('sapegin_2016', 'sapegin_2016_damped', 'tactical'))
STABLE = {'sapegin_2016_damped': DAMPED, 'tactical': TACTICAL,
          'tactical, zeta 0.7': replace(TACTICAL, damping_ratio=0.7)}


def solved(space, u, steps, dt):
    """Return mean readings (steps,) and states (steps + 1, n) from DOP853 at 1e-12."""
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
    Exact steps agree with an ODE solver at 20 Hz and 1 ms.

    Tolerance: 1e-6 of the amplitude of the reading for quadratic hold, (w h)^2 / 12 for linear
    hold, including the start from zero with a jump of the rate (later errors are a third of that).
    The instantaneous reading, which is not part of a sample, has twice the tolerance.
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


@pytest.mark.parametrize('name', STABLE)
@pytest.mark.parametrize('dt', [0.75e-3, 0.01])
def test_exact_matrices_are_those_of_scipy(name, dt):
    """The matrices for a constant rate equal SciPy's exponential to 1e-13 of each row."""
    space = state_space(STABLE[name])
    n = len(space.g)
    big = np.zeros((n + 2, n + 2), dtype=complex)
    big[:n, :n], big[:n, n] = dt * space.f, dt * space.g
    big[n + 1, :n], big[n + 1, n] = space.c, space.d
    expected = expm(big)[[*range(n), n + 1], :n + 1]
    for hold in HOLDS:
        table = exact_matrices(space, dt, hold)
        found = np.column_stack((table[:, :n], table[:, n:].sum(axis=1)))
        off = np.abs(found - expected).max(axis=1) / np.abs(expected).max(axis=1)
        assert (off <= 1e-13).all()


@pytest.mark.parametrize('hz', [1, 5, 10, 20, 50, 100])
def test_frequency_response_by_simulation(hz):
    """The simulated tactical gyro matches its transfer function within 1e-4 (0.5 ms steps)."""
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


@pytest.mark.parametrize('p', [SAPEGIN, TACTICAL], ids=['sapegin_2016', 'tactical'])
def test_rk4_matrices_are_the_program_of_the_paper(p):
    """The RK4 matrices equal the four stages of Sapegin et al. written out, to rounding."""
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


def test_steps_are_those_of_the_modes():
    """With separate roots the state moves mode by mode along the eigenvectors."""
    u = np.exp(1j * np.arange(600).reshape(200, 3))
    for p in (DAMPED, STABLE['tactical, zeta 0.7']):
        gyro = TunedGyro(p, 1e-3)
        roots, vectors = np.linalg.eig(gyro.space.f)
        n, (table, _) = len(roots), gyro.matrices
        gains, out = np.linalg.solve(vectors, table[:n, n:]), table[n, :n] @ vectors
        x, expected = np.zeros(n, dtype=complex), []
        for rates in u:
            expected.append(out @ x + table[n, n:] @ rates)
            x = np.exp(1e-3 * roots) * x + gains @ rates
        np.testing.assert_allclose(gyro.advance(u), expected, rtol=0, atol=1e-12)


def test_change_of_speed():
    """After a change of speed the closed-loop reading scales as Omega / Omega_nom."""
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
    # Open loop: the output scaling stays nominal, and k2 rotates the reading into the other axis.
    c = SAPEGIN.rotating_damping_n_m_s * 2 * math.pi * 231.0 + SAPEGIN.cross_feedback_n_m_rad
    expected = 231.0 / 230.0 * SAPEGIN.coupling / complex(c, SAPEGIN.stiffness(231.0))
    assert state_space(SAPEGIN, 231.0).response(0.0) == pytest.approx(expected, rel=1e-12)


UNSTABLE = {
    'the gyro is unstable: a root grows with 7.447 1/s at 408.7 Hz': (SAPEGIN, 1e-3, {}),
    'the RK4 step is 0.3 ms, .* expected between 0.3322 and 1.099 ms':
        (SAPEGIN, 0.3e-3, {'method': 'rk4'}),
    'the RK4 step is 1.1 ms, .* expected between': (SAPEGIN, 1.1e-3, {'method': 'rk4'}),
    'unstable and no RK4 step damps it':
        (replace(SAPEGIN, cross_feedback_n_m_rad=20.0), 1e-3, {'method': 'rk4'}),
    'method is .euler.; expected exact or rk4': (DAMPED, 1e-3, {'method': 'euler'}),
    'hold is .cubic.; expected quadratic or linear': (DAMPED, 1e-3, {'hold': 'cubic'}),
    'dt_s is 0.0; expected a finite number above 0': (DAMPED, 0.0, {}),
}


@pytest.mark.parametrize('sentence', UNSTABLE)
def test_instruments_that_would_grow_are_refused(sentence):
    """Gyros whose steps would diverge are refused unless only a warning is requested."""
    parameters, dt, options = UNSTABLE[sentence]
    with pytest.raises(ValueError, match=sentence):
        TunedGyro(parameters, dt, **options)
    if 'unstable' in sentence or 'RK4' in sentence:
        with pytest.warns(UserWarning, match=sentence):
            TunedGyro(parameters, dt, on_unstable='warn', **options)


@pytest.mark.parametrize('dt', [0.34e-3, 0.75e-3, 1.09e-3])
def test_rk4_inside_its_window_takes_the_paper_preset(dt):
    """Inside its RK4 window sapegin_2016 is accepted and settles to a constant rate."""
    gyro = TunedGyro(SAPEGIN, dt, method='rk4')
    last = [gyro.step(1.0, 1.0, 1.0) for _ in range(20000)][-1]
    roots = np.array(tuned_gyro_report(SAPEGIN).roots)
    left = np.abs(rk4_amplification(dt * roots)).max() ** 20000
    print(f'{dt} s: off by {abs(last - 1.0):.1e}, transient {left:.1e}')
    assert abs(last - 1.0) < left + 1e-12
