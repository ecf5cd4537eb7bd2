"""Errors of the rotors: each term alone causes the drift of its equation."""

from dataclasses import replace
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ins_sim.core.sensors.tuned_gyro.pair import GyroPair
from ins_sim.core.numerics.units import DEG_H, STANDARD_GRAVITY as G
from ins_sim.core.sensors.tuned_gyro.rotor import PRESETS
from ins_sim.core.sensors.tuned_gyro.state_space import state_space
from support.pairs import instrument

DTG = {'gyro.model': 'dtg', 'output': 'integrated', 'input': 'integrated'}
ERRORS, OUT = 'gyro.dtg.errors.', 'gyro.errors.'
TACTICAL = PRESETS['tactical']
A, B, OMEGA = TACTICAL.transverse_inertia, TACTICAL.input_inertia, TACTICAL.omega


def steady(values, w, force, steps=400):
    """Return rates and parity after settling at constant body rate and specific force."""
    one = instrument(values)
    one.settle(w)
    dt_ns = 10_000_000
    for k in range(steps):
        found = one.step((k + 1) * dt_ns, [w] * len(one.nodes), force)
    return np.array([*found[0], found[1]])


def combined(channels, arrangement='paper'):
    """Return rates and parity of four channels."""
    omega, parity = GyroPair(TACTICAL, 0.01, arrangement).combine(channels)
    return np.array([*omega, parity])


FORCE = (2.0, -3.0, 9.0)
RATE = (0.2, -0.1, 0.3)
# Specific force along (y, z, spin) of both cases: gyro 1 has body (x, y, z), gyro 2 (z, x, y).
ALONG = {0: (2.0, -3.0, 9.0), 1: (-3.0, 2.0, 9.0), 2: (9.0, 2.0, -3.0), 3: (2.0, 9.0, -3.0)}


@pytest.mark.parametrize('channel', range(4))
@pytest.mark.parametrize('key, unit, expected', [
    ('mass_unbalance_deg_h_g', DEG_H / G, lambda own, other, spin: own),
    ('quadrature_unbalance_deg_h_g', DEG_H / G, lambda own, other, spin: other),
    ('spin_axis_deg_h_g', DEG_H / G, lambda own, other, spin: spin),
    ('anisoelastic_deg_h_g2', DEG_H / G ** 2, lambda own, other, spin: spin * own)])
def test_drift_by_specific_force(key, unit, expected, channel):
    """Specific force on the same, other and spin axis drifts one channel as specified."""
    values = [0.0] * 4
    values[channel] = 2.0
    change = steady({ERRORS + key: values}, (0.0,) * 3, FORCE)
    channels = [0.0] * 4
    channels[channel] = 2.0 * unit * expected(*ALONG[channel])
    # The rotors settle to the new moment with the slowest root: exp(-4 s x 220/s).
    np.testing.assert_allclose(change, combined(channels), rtol=1e-9, atol=1e-18)


def test_null_offset_of_the_pick_off():
    """Pick-off offset: (k2 - j fe Omega) theta0/(j B Omega), -0.0406 deg/h for 10 urad."""
    change = steady({ERRORS + 'pickoff_offset_urad': [10.0, 0.0, 0.0, 0.0]}, (0.0,) * 3, FORCE)
    drift = -TACTICAL.rotating_damping_n_m_s * 1e-5 / B
    print(f'\n10 urad: {drift / DEG_H:.5f} deg/h by the equation, {2 * change[0] / DEG_H:.5f} '
          'read')
    assert round(drift / DEG_H, 4) == -0.0406
    np.testing.assert_allclose(change, combined([drift, 0.0, 0.0, 0.0]), rtol=1e-6, atol=1e-18)


def test_speed_off_the_nominal_one():
    """
    Off the nominal speed the scale is Omega/Omega_nom; a pick-off offset adds a drift.

    The drift comes from dk2 = -2 K_t dOmega/Omega.
    """
    e = 80e-6
    change = steady({ERRORS + 'speed_ppm': [80.0, 0.0]}, RATE, FORCE) - steady({}, RATE, FORCE)
    np.testing.assert_allclose(change, combined([e * RATE[0], e * RATE[1], 0.0, 0.0]), rtol=1e-6)
    offset = {ERRORS + 'pickoff_offset_urad': [10.0, 0.0, 0.0, 0.0]}
    detuned = steady({**offset, ERRORS + 'speed_ppm': [80.0, 0.0]}, (0.0,) * 3, FORCE)
    k2 = -2.0 * TACTICAL.stiffness(0.0) * e
    drift = complex(k2, -TACTICAL.rotating_damping_n_m_s * OMEGA) * 1e-5 / (1j * B * OMEGA)
    # Second-order terms in the speed error.
    np.testing.assert_allclose(detuned, combined([drift.real, drift.imag, 0.0, 0.0]), rtol=2e-4)


def test_hunting():
    """Hunting modulates scale and detuning by a sinusoid, averaged over each interval."""
    values = {ERRORS + 'hunting_ppm': [50.0, 0.0], ERRORS + 'hunting_hz': 2.0,
              ERRORS + 'pickoff_offset_urad': [0.0, 100.0, 0.0, 0.0]}
    one = instrument(values)
    one.settle(RATE)
    reference = instrument({ERRORS + 'pickoff_offset_urad': [0.0, 100.0, 0.0, 0.0]})
    reference.settle(RATE)
    found, expected, dt = [], [], 0.01
    kappa = 2j * TACTICAL.stiffness(0.0) / (B * OMEGA) * 100e-6j
    for k in range(400):
        t, rates = round((k + 1) * dt * 1e9), [RATE] * 3
        found.append(one.pair.channels(*rates, _begun(one, t)))
        expected.append(reference.pair.channels(*rates, _begun(reference, t)))
    added = np.array(found) - np.array(expected)
    ends = 2.0 * math.pi * 2.0 * dt * np.arange(401)
    wave = 50e-6 * -np.diff(np.cos(ends)) / (ends[1] - ends[0])
    drift = wave * (complex(RATE[0], RATE[1]) + kappa)
    # The rotor and its loop shift the phase at 2 Hz; compare amplitudes with the response there.
    gain = state_space(TACTICAL)
    through = gain.c @ np.linalg.solve(2j * math.pi * 2.0 * np.eye(3) - gain.f, gain.moment)
    fit = np.exp(1j * 2.0 * math.pi * 2.0 * dt * (np.arange(400) + 0.5))
    got = np.mean((added[100:, 0] + 1j * added[100:, 1]) * fit.conj()[100:])
    want = np.mean(drift[100:] * fit.conj()[100:]) * through
    # The sinusoid is held over each interval.
    assert abs(got - want) <= 2e-3 * abs(want)
    assert not added[:, 2:].any()


def _begun(one, t_ns):
    one._disturbances.begin(t_ns, FORCE)
    return one._disturbances.step(RATE, RATE, RATE)


def test_spin_rate_product():
    """The spin rate product causes a drift of ((B - A)/(B Omega)) u_s u, with 3.007e-4 s."""
    product = (B - A) / (B * OMEGA)
    print(f'\n(B - A)/(B Omega) = {product:.4e} s, A/(B Omega) = {A / (B * OMEGA):.4e} s')
    assert f'{product:.3e}' == '3.007e-04'
    change = steady({ERRORS + 'spin_rate_product': 0.5}, RATE, FORCE) - steady({}, RATE, FORCE)
    x, y, z = RATE
    expected = combined([0.5 * product * v for v in (z * x, z * y, y * z, y * x)])
    np.testing.assert_allclose(change, expected, rtol=1e-9)


def test_cross_coupling_of_angular_acceleration():
    """The rotor equation contains the cross-coupling (A/(B Omega)) u', 3.913e-4 s."""
    assert f'{A / (B * OMEGA):.3e}' == '3.913e-04'
    omega = 1e-2
    _, cross = state_space(TACTICAL).axis_responses(np.array([omega]))
    # As omega approaches 0 the rotor is held and only the moment A u' remains.
    assert abs(cross[0] - 1j * omega * A / (B * OMEGA)) <= 1e-4 * abs(cross[0])


def precession(ring, u_0, phase):
    """
    Return the drift of a free rotor under U cos(2 Omega t + phase) about the axis y of the case.

    Hinge 1 turns ring and rotor about x, hinge 2 the rotor about y: Euler's equations of both in
    the axes of the shaft, tuned, without damping. ring: factor of the ring's inertias. The
    precession of the free rotor is -(B/J) times the drift.
    """
    omega = OMEGA
    jr, je = TACTICAL.rotor_axial_kg_m2, TACTICAL.rotor_equatorial_kg_m2
    jk, jq = ring * TACTICAL.ring_axial_kg_m2, ring * TACTICAL.ring_equatorial_kg_m2
    hinge = (jq - 0.5 * jk) * omega * omega

    def rate(t, x):
        tx, ty, vx, vy = x
        u = u_0 * math.cos(2.0 * omega * t + phase)
        du = -2.0 * omega * u_0 * math.sin(2.0 * omega * t + phase)
        turn = complex(math.cos(omega * t), -math.sin(omega * t))
        r, dr = u * turn, (du - 1j * omega * u) * turn
        ax = (je * omega * vy - (jr - je) * omega * (r.imag + omega * tx + vy) - je * dr.real
              - jq * dr.real - (jk - jq) * omega * (r.imag + omega * tx) - hinge * tx) / (je + jq)
        ay = (-je * dr.imag - je * omega * vx + (jr - je) * omega * (r.real - omega * ty + vx)
              - hinge * ty) / je
        return vx, vy, ax, ay

    length = 400.0 * 2.0 * math.pi / omega
    t = np.linspace(0.0, length, 40001)
    found = solve_ivp(rate, (0.0, length), (0.0,) * 4, 'DOP853', t, rtol=1e-11, atol=1e-16)
    tilt = (found.y[0] + 1j * found.y[1]) * np.exp(1j * omega * t)
    # Use the slope at the start: to second order the ring detunes the rotor, which later rotates
    # the precession.
    return -(jr + jq) / (jr + 0.5 * jk) * np.polyfit(t, tilt, 4)[-2]


@pytest.mark.parametrize('ring', [1.0, 0.3])
def test_vibration_at_twice_the_speed(ring):
    """
    The vibration factor 1.18e-3 agrees with rotor and ring integrated in the shaft's axes.

    It is of first order in the ring. The second order is about 2 dJ/g, 8 % for a whole ring.
    """
    p = replace(TACTICAL, ring_axial_kg_m2=ring * TACTICAL.ring_axial_kg_m2,
                ring_equatorial_kg_m2=ring * TACTICAL.ring_equatorial_kg_m2)
    u_0, phase = 1e-3, 0.6
    drift, factor = precession(ring, u_0, phase), p.vibration_2n_factor
    expected = u_0 * factor * np.exp(-1j * phase)
    print(f'\nring x {ring}: factor {factor:.4e}; integrated over equation {drift / expected:.4f}')
    second = 2.0 * ring * 2.5e-8 / 6.4e-7
    assert abs(drift - expected) <= second * abs(expected)


def test_vibration_reaches_the_reading():
    """Vibration at twice the rotor speed reads as a constant drift of 1.2e-3 of its amplitude."""
    assert f'{TACTICAL.vibration_2n_factor:.1e}' == '1.2e-03'
    change = steady({ERRORS + 'vibration_2n_deg_s': [2.0, 0.0],
                     ERRORS + 'vibration_2n_phase_deg': [30.0, 0.0]}, (0.0,) * 3, FORCE)
    size = math.radians(2.0) * TACTICAL.vibration_2n_factor
    drift = size * np.exp(-1j * math.radians(30.0))
    np.testing.assert_allclose(change, combined([drift.real, drift.imag, 0.0, 0.0]), rtol=1e-9)


def test_a_flat_rotor_has_no_such_vibration():
    """A flat rotor (Jr = 2 Jer) with vibration at twice the speed is refused."""
    flat = {'gyro.dtg.preset': 'custom', 'gyro.dtg.custom.rotor_axial_kg_m2': 5.64e-6,
            ERRORS + 'vibration_2n_deg_s': [1.0, 0.0]}
    with pytest.raises(ValueError, match='twice rotor_equatorial_kg_m2 with a vibration'):
        instrument(flat)


def test_errors_of_the_read_out_are_by_channel():
    """A bias of body x acts on both channels of x; their turn-on biases are independent."""
    change = steady({OUT + 'bias_deg_h': [3.0, 0.0, 0.0]}, RATE, FORCE) - steady({}, RATE, FORCE)
    np.testing.assert_allclose(change, combined([3.0 * DEG_H, 0.0, 0.0, 3.0 * DEG_H]), atol=1e-17)
    drawn = steady({OUT + 'turn_on_bias_sigma_deg_h': [3.0, 0.0, 0.0], 'seed': 4}, RATE, FORCE)
    drawn = drawn - steady({}, RATE, FORCE)
    assert abs(drawn[3]) > 0.01 * DEG_H and not drawn[1:3].any()
    turned = steady({OUT + 'misalignment_mrad': [0.0, 1.0, 0.0]}, RATE, FORCE)
    turned = turned - steady({}, RATE, FORCE)
    # w x m to first order, the same on both gyros; the tolerance is the second order of 1 mrad.
    np.testing.assert_allclose(turned[:3], np.cross(RATE, (0.0, 1e-3, 0.0)), atol=4e-7)
    assert abs(turned[3]) <= 1e-15
