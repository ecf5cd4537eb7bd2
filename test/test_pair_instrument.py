"""The pair of tuned gyros with its errors: each term alone gives what its equation says."""

from dataclasses import replace
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.stats import chi2
from studies import settings, streamed

from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.sensors.tuned_gyro.pair import CHANNELS, COVARIANCE_FACTORS, GyroPair
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.sensors.imu.with_errors import reported_variances
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.sensors.tuned_gyro.instrument import make_pair, PairInstrument, parameters
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.core.simulation.inertial import sense
from ins_sim.core.numerics.units import DEG_H, STANDARD_GRAVITY as G
from ins_sim.core.sensors.tuned_gyro.rotor import PRESETS, state_space

DTG = {'gyro.model': 'dtg', 'output': 'integrated', 'input': 'integrated'}
ERRORS, OUT = 'gyro.dtg.errors.', 'gyro.errors.'
TACTICAL = PRESETS['tactical']
A, B, OMEGA = TACTICAL.transverse_inertia, TACTICAL.input_inertia, TACTICAL.omega
QUANTILE = 1e-6


def instrument(values=(), **more):
    """Return the PairInstrument of settings at 100 Hz."""
    return PairInstrument(settings({**DTG, **dict(values)}, **more).imu_sensor)


def steady(values, w, force, steps=400):
    """Return rates and parity after settling at a constant body rate and specific force."""
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
# a, along (y, z, spin) of the two cases: gyro 1 has body (x, y, z), gyro 2 body (z, x, y)
ALONG = {0: (2.0, -3.0, 9.0), 1: (-3.0, 2.0, 9.0), 2: (9.0, 2.0, -3.0), 3: (2.0, 9.0, -3.0)}


@pytest.mark.parametrize('channel', range(4))
@pytest.mark.parametrize('key, unit, expected', [
    ('mass_unbalance_deg_h_g', DEG_H / G, lambda own, other, spin: own),
    ('quadrature_unbalance_deg_h_g', DEG_H / G, lambda own, other, spin: other),
    ('spin_axis_deg_h_g', DEG_H / G, lambda own, other, spin: spin),
    ('anisoelastic_deg_h_g2', DEG_H / G ** 2, lambda own, other, spin: spin * own)])
def test_drift_by_specific_force(key, unit, expected, channel):
    """Same axis, other axis, spin axis, product of spin and same axis; one channel alone."""
    values = [0.0] * 4
    values[channel] = 2.0
    change = steady({ERRORS + key: values}, (0.0,) * 3, FORCE)
    channels = [0.0] * 4
    channels[channel] = 2.0 * unit * expected(*ALONG[channel])
    # the rotors settle to the new moment with the slowest root, exp(-4 s x 220/s)
    np.testing.assert_allclose(change, combined(channels), rtol=1e-9, atol=1e-18)


def test_null_offset_of_the_pick_off():
    """(k2 - j fe Omega) theta0/(j B Omega): -0.0406 deg/h on the same axis for 10 urad."""
    change = steady({ERRORS + 'pickoff_offset_urad': [10.0, 0.0, 0.0, 0.0]}, (0.0,) * 3, FORCE)
    drift = -TACTICAL.rotating_damping_n_m_s * 1e-5 / B
    print(f'\n10 urad: {drift / DEG_H:.5f} deg/h by the equation, {2 * change[0] / DEG_H:.5f} '
          'read')
    assert round(drift / DEG_H, 4) == -0.0406
    np.testing.assert_allclose(change, combined([drift, 0.0, 0.0, 0.0]), rtol=1e-6, atol=1e-18)


def test_speed_off_the_nominal_one():
    """Scale Omega/Omega_nom; with an offset of the pick-off dk2 = -2 K_t dOmega/Omega besides."""
    e = 80e-6
    change = steady({ERRORS + 'speed_ppm': [80.0, 0.0]}, RATE, FORCE) - steady({}, RATE, FORCE)
    np.testing.assert_allclose(change, combined([e * RATE[0], e * RATE[1], 0.0, 0.0]), rtol=1e-6)
    offset = {ERRORS + 'pickoff_offset_urad': [10.0, 0.0, 0.0, 0.0]}
    detuned = steady({**offset, ERRORS + 'speed_ppm': [80.0, 0.0]}, (0.0,) * 3, FORCE)
    k2 = -2.0 * TACTICAL.stiffness(0.0) * e
    drift = complex(k2, -TACTICAL.rotating_damping_n_m_s * OMEGA) * 1e-5 / (1j * B * OMEGA)
    # second order in the speed error
    np.testing.assert_allclose(detuned, combined([drift.real, drift.imag, 0.0, 0.0]), rtol=2e-4)


def test_hunting():
    """A sinusoid of the scale, the mean of each interval, and of the detuning."""
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
    # through the rotor and its loop: the phase at 2 Hz; compare amplitude by the response there
    gain = state_space(TACTICAL)
    through = gain.c @ np.linalg.solve(2j * math.pi * 2.0 * np.eye(3) - gain.f, gain.moment)
    fit = np.exp(1j * 2.0 * math.pi * 2.0 * dt * (np.arange(400) + 0.5))
    got = np.mean((added[100:, 0] + 1j * added[100:, 1]) * fit.conj()[100:])
    want = np.mean(drift[100:] * fit.conj()[100:]) * through
    # the wave is held over each interval
    assert abs(got - want) <= 2e-3 * abs(want)
    assert not added[:, 2:].any()


def _begun(one, t_ns):
    one._disturbances.begin(t_ns, FORCE)
    return one._disturbances.step(RATE, RATE, RATE)


def test_spin_rate_product():
    """((B - A)/(B Omega)) u_s u with 3.007e-4 s."""
    product = (B - A) / (B * OMEGA)
    print(f'\n(B - A)/(B Omega) = {product:.4e} s, A/(B Omega) = {A / (B * OMEGA):.4e} s')
    assert f'{product:.3e}' == '3.007e-04'
    change = steady({ERRORS + 'spin_rate_product': 0.5}, RATE, FORCE) - steady({}, RATE, FORCE)
    x, y, z = RATE
    expected = combined([0.5 * product * v for v in (z * x, z * y, y * z, y * x)])
    np.testing.assert_allclose(change, expected, rtol=1e-9)


def test_cross_coupling_of_angular_acceleration():
    """(A/(B Omega)) u' on the other axis, 3.913e-4 s, is in the rotor's own equation."""
    assert f'{A / (B * OMEGA):.3e}' == '3.913e-04'
    omega = 1e-2
    _, cross = state_space(TACTICAL).axis_responses(np.array([omega]))
    # as omega goes to 0 the rotor is held still, and only the moment A u' is left
    assert abs(cross[0] - 1j * omega * A / (B * OMEGA)) <= 1e-4 * abs(cross[0])


def precession(ring, u_0, phase):
    """
    Return the drift of a free rotor under U cos(2 Omega t + phase) about the axis y of the case.

    Hinge 1 turns ring and rotor about x, hinge 2 the rotor about y: Euler's equations of both in
    the axes of the shaft, tuned, without damping.  ring: factor of its inertias.  The precession
    of the free rotor is -(B/J) of the drift.
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
    # at the start: to second order the ring detunes the rotor, which turns the precession later
    return -(jr + jq) / (jr + 0.5 * jk) * np.polyfit(t, tilt, 4)[-2]


@pytest.mark.parametrize('ring', [1.0, 0.3])
def test_vibration_at_twice_the_speed(ring):
    """
    The factor 1.18e-3 against rotor and ring integrated in the axes of the shaft.

    It is of first order in the ring; the second is of the size of 2 dJ/g, 8 % for a whole ring.
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
    """As a constant drift at the phase of the vibration to the hinges; 1.2e-3 of the amplitude."""
    assert f'{TACTICAL.vibration_2n_factor:.1e}' == '1.2e-03'
    change = steady({ERRORS + 'vibration_2n_deg_s': [2.0, 0.0],
                     ERRORS + 'vibration_2n_phase_deg': [30.0, 0.0]}, (0.0,) * 3, FORCE)
    size = math.radians(2.0) * TACTICAL.vibration_2n_factor
    drift = size * np.exp(-1j * math.radians(30.0))
    np.testing.assert_allclose(change, combined([drift.real, drift.imag, 0.0, 0.0]), rtol=1e-9)


def test_a_flat_rotor_has_no_such_vibration():
    """Jr = 2 Jer: refused in one sentence."""
    flat = {'gyro.dtg.preset': 'custom', 'gyro.dtg.custom.rotor_axial_kg_m2': 5.64e-6,
            ERRORS + 'vibration_2n_deg_s': [1.0, 0.0]}
    with pytest.raises(ValueError, match='twice rotor_equatorial_kg_m2 with a vibration'):
        instrument(flat)


def test_errors_of_the_read_out_are_by_channel():
    """A bias of x is on both channels of x, its turn-on bias is not the same on both."""
    change = steady({OUT + 'bias_deg_h': [3.0, 0.0, 0.0]}, RATE, FORCE) - steady({}, RATE, FORCE)
    np.testing.assert_allclose(change, combined([3.0 * DEG_H, 0.0, 0.0, 3.0 * DEG_H]), atol=1e-17)
    drawn = steady({OUT + 'turn_on_bias_sigma_deg_h': [3.0, 0.0, 0.0], 'seed': 4}, RATE, FORCE)
    drawn = drawn - steady({}, RATE, FORCE)
    assert abs(drawn[3]) > 0.01 * DEG_H and not drawn[1:3].any()
    turned = steady({OUT + 'misalignment_mrad': [0.0, 1.0, 0.0]}, RATE, FORCE)
    turned = turned - steady({}, RATE, FORCE)
    # w x m to first order, the same on both gyros: the second order of 1 mrad
    np.testing.assert_allclose(turned[:3], np.cross(RATE, (0.0, 1e-3, 0.0)), atol=4e-7)
    assert abs(turned[3]) <= 1e-15


@pytest.mark.parametrize('arrangement', ['paper', 'turned'])
def test_reported_covariance_is_that_of_the_readings(arrangement):
    """Variances of the combined axes and of the parity, chi-square, all sources of noise on."""
    values = {**DTG, 'motion.kind': 'static', 'earth.rotation': False, 'source': 'motion',
              'gyro.dtg.arrangement': arrangement, 'seed': 3,
              OUT + 'angle_random_walk_deg_sqrt_h': [0.02] * 3,
              ERRORS + 'pickoff_noise_urad_sqrt_s': [0.05] * 4}
    s = settings(values, duration_s=200.0)
    motion = make_motion(s.motion_generator.motion, s.motion_generator.datum,
                         s.motion_generator.earth)
    imu = ImuSamples.concatenate(sense(s, motion))[100:]
    one = PairInstrument(s.imu_sensor)
    want = np.array([*one.variances, one.parity_variance()])
    got = np.var(np.column_stack((imu.omega, imu.parity)), axis=0)
    print(f'\n{arrangement}: variances measured over reported {(got / want).round(4)}; a pick-off '
          f'adds {one.channel_variances()[0] / (0.02 * math.radians(1) / 60) ** 2 * 0.01:.3f}')
    # noise of the pick-off is correlated from sample to sample: half as many as there are
    n = len(imu) // 2
    assert (got / want > chi2.ppf(QUANTILE, n) / n).all()
    assert (got / want < chi2.isf(QUANTILE, n) / n).all()
    assert np.allclose(one.variances, np.multiply(COVARIANCE_FACTORS, one.parity_variance()))
    assert reported_variances(s.imu_sensor)[0] == one.variances
    mean = imu.parity[:len(imu) // 100 * 100].reshape(-1, 100).mean(axis=1)
    ratio = mean.var() / one.parity_variance(100)
    assert chi2.ppf(QUANTILE, len(mean) // 2) < ratio * (len(mean) // 2) < chi2.isf(
        QUANTILE, len(mean) // 2)


def test_zero_errors_are_the_bare_pair_bit_for_bit():
    """Whatever the defaults say, nothing is added to the rotors."""
    one, bare = instrument(), make_pair(settings(DTG).imu_sensor.gyro, 0.01)
    generator = np.random.default_rng(1)
    for k in range(50):
        rates = [tuple(row) for row in generator.normal(size=(3, 3)).tolist()]
        assert one.step((k + 1) * 10_000_000, rates, FORCE) == bare.step(*rates)


EVERYTHING = {
    **DTG, 'seed': 11, 'gyro.delay_us.x': 30.0,
    ERRORS + 'mass_unbalance_deg_h_g': [0.5] * 4, ERRORS + 'pickoff_noise_urad_sqrt_s': [0.05] * 4,
    ERRORS + 'speed_ppm': [5.0, -5.0], ERRORS + 'hunting_ppm': [20.0, 10.0],
    ERRORS + 'spin_rate_product': 1.0, OUT + 'angle_random_walk_deg_sqrt_h': [0.01] * 3,
    OUT + 'quantisation_arcsec': [0.3] * 3, OUT + 'bandwidth_hz': [80.0] * 3,
    OUT + 'in_run_bias_sigma_deg_h': [0.1] * 3, OUT + 'misalignment_sigma_mrad': [0.2] * 3}


@pytest.mark.parametrize('more', [{}, {'gyro.dtg.steps_per_sample': 3, 'gyro.dtg.fault.channel':
                                       'gyro_1_y', 'gyro.dtg.fault.bias_deg_h': 100.0,
                                       'gyro.dtg.fault.start_s': 1.0}])
def test_everything_on_live_is_offline_and_reset_forgets(more):
    """The same bits sample by sample, and again after a reset."""
    s = settings({**EVERYTHING, **more}, source='stream', duration_s=3.0)
    expected, samples = streamed(s)
    imu = make_imu(s.imu_sensor)
    for _ in range(2):
        got = [r for sample in samples for r in imu.push(*sample)]
        assert np.array_equal([r[1] for r in got], expected.omega)
        assert np.array_equal([r[3] for r in got], expected.parity)
        imu.reset()


def test_steps_per_sample_bring_rk4_to_a_slow_imu():
    """The paper's rotor at 100 Hz: 13 steps of 0.77 ms are inside its window, one of 10 is not."""
    rotor = {'gyro.dtg.preset': 'paper', 'gyro.dtg.method': 'rk4'}
    with pytest.raises(ValueError, match='RK4 step is 10 ms, at which this gyro grows; expected '
                       'between 0.332'):
        instrument(rotor)
    one = instrument({**rotor, 'gyro.dtg.steps_per_sample': 13})
    assert len(one.nodes) == 27
    one.settle(RATE)
    for k in range(1000):
        omega, _ = one.step((k + 1) * 10_000_000, [RATE] * 27, FORCE)
    # open loop: the gain at rest is -j c/(k2 - j c) = 1
    np.testing.assert_allclose(omega, RATE, rtol=1e-9)
    with pytest.raises(ValueError, match='unstable: a root grows with 7.447'):
        instrument({'gyro.dtg.preset': 'paper'})
    with pytest.warns(UserWarning, match='unstable: a root grows'):
        instrument({'gyro.dtg.preset': 'paper', 'gyro.dtg.on_unstable': 'warn'})


def test_rotors_that_run_away_are_a_fault():
    """Not an infinite reading: one sentence, and a restart settles them anew."""
    values = {**DTG, 'gyro.dtg.preset': 'paper', 'gyro.dtg.on_unstable': 'warn',
              OUT + 'quantisation_arcsec': [0.3] * 3}
    with pytest.warns(UserWarning, match='unstable'):
        s = settings(values, duration_s=200.0, source='motion')
        motion = make_motion(s.motion_generator.motion, s.motion_generator.datum,
                             s.motion_generator.earth)
        with pytest.raises(StreamFault, match='the rotors of the gyros have run away at') as fault:
            list(sense(s, motion))
    assert fault.value.restart


def test_a_custom_gyro():
    """By default the tactical one; what no instrument can be is refused with the key's name."""
    custom = {'gyro.dtg.preset': 'custom'}
    assert parameters(settings({**DTG, **custom}).imu_sensor.gyro.dtg) == TACTICAL
    slow = {**custom, 'gyro.dtg.custom.speed_hz': 200.0}
    assert parameters(settings({**DTG, **slow}).imu_sensor.gyro.dtg) == replace(TACTICAL,
                                                                                speed_hz=200.0)


@pytest.mark.parametrize('key, value, says', [
    ('rotor_axial_kg_m2', 6e-6, 'gyro.dtg.custom.rotor_axial_kg_m2 is 6e-06; expected at most '
     'twice rotor_equatorial_kg_m2, 5.64e-06: no rigid body has more'),
    ('ring_axial_kg_m2', 3e-7, 'gyro.dtg.custom.ring_axial_kg_m2 is 3e-07; expected at most'),
    ('rotor_equatorial_kg_m2', -1e-6, 'gyro.dtg.custom.rotor_equatorial_kg_m2 is -1e-06 kg m^2; '
     'expected 0 to 1'),
    ('hinge_stiffness_n_m_rad', 0.5, 'which tunes the rotor at'),
    ('cross_feedback_n_m_rad', 0.05, 'with loop closed; expected 0'),
    ('speed_hz', 0.0, 'gyro.dtg.custom.speed_hz is 0; expected a number above 0')])
def test_bad_gyros_are_refused(key, value, says):
    """One sentence each."""
    with pytest.raises(ValueError) as raised:
        instrument({'gyro.dtg.preset': 'custom', 'gyro.dtg.custom.' + key: value})
    assert says in str(raised.value) and '\n' not in str(raised.value)


def test_channels_have_the_names_of_the_settings():
    """The choices of the fault are the channels."""
    from dataclasses import fields
    from ins_sim.settings.tuned_gyro import DtgFault
    choices = {f.name: f.metadata['choices'] for f in fields(DtgFault)}['channel']
    assert choices == ('none', *CHANNELS)
