"""The pair of tuned gyros with errors: each term alone has the effect of its equation."""

from dataclasses import replace
import math

import numpy as np
import pytest
from scipy.stats import chi2
from support.studies import settings, streamed

from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.sensors.tuned_gyro.pair import CHANNELS, COVARIANCE_FACTORS
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.sensors.imu.with_errors import reported_variances
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.sensors.tuned_gyro.instrument import make_pair, PairInstrument, rotor_parameters
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.core.sensors.tuned_gyro.rotor import PRESETS
from support.pairs import instrument

DTG = {'gyro.model': 'dtg', 'output': 'integrated', 'input': 'integrated'}
ERRORS, OUT = 'gyro.dtg.errors.', 'gyro.errors.'
TACTICAL = PRESETS['tactical']
QUANTILE = 1e-6
FORCE = (2.0, -3.0, 9.0)
RATE = (0.2, -0.1, 0.3)


@pytest.mark.parametrize('arrangement', ['paper', 'turned'])
def test_reported_covariance_is_that_of_the_readings(arrangement):
    """Reported variances of axes and parity match the readings (chi-square) with all noise on."""
    values = {**DTG, 'motion.kind': 'static', 'earth.rotation': False, 'source': 'motion',
              'gyro.dtg.arrangement': arrangement, 'seed': 3,
              OUT + 'angle_random_walk_deg_sqrt_h': [0.02] * 3,
              ERRORS + 'pickoff_noise_urad_sqrt_s': [0.05] * 4}
    s = settings(values, duration_s=200.0)
    motion = make_motion(s.motion_generator.motion, s.motion_generator.datum,
                         s.motion_generator.earth)
    imu = ImuSamples.concatenate(imu_blocks(s, motion))[100:]
    one = PairInstrument(s.imu_sensor)
    want = np.array([*one.variances, one.parity_variance()])
    got = np.var(np.column_stack((imu.omega, imu.parity)), axis=0)
    print(f'\n{arrangement}: variances measured over reported {(got / want).round(4)}; a pick-off '
          f'adds {one.channel_variances()[0] / (0.02 * math.radians(1) / 60) ** 2 * 0.01:.3f}')
    # Pick-off noise is correlated between samples, so the effective number is half the count.
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
    """With all errors zero the instrument gives the bits of a pair without errors."""
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
    OUT + 'gauss_markov_sigma_deg_h': [0.1] * 3, OUT + 'misalignment_sigma_mrad': [0.2] * 3}


@pytest.mark.parametrize('more', [{}, {'gyro.dtg.steps_per_sample': 3, 'gyro.dtg.fault.channel':
                                       'gyro_1_y', 'gyro.dtg.fault.bias_deg_h': 100.0,
                                       'gyro.dtg.fault.start_s': 1.0}])
def test_everything_on_live_is_offline_and_reset_forgets(more):
    """With all errors on, samples and blocks agree to the bit, and again after a reset."""
    s = settings({**EVERYTHING, **more}, source='stream', duration_s=3.0)
    expected, samples = streamed(s)
    imu = make_imu(s.imu_sensor)
    for _ in range(2):
        got = [r for sample in samples for r in imu.push(*sample)]
        assert np.array_equal([r[1] for r in got], expected.omega)
        assert np.array_equal([r[3] for r in got], expected.parity)
        imu.reset()


def test_steps_per_sample_bring_rk4_to_a_slow_imu():
    """RK4 is stable for sapegin_2016 at 100 Hz with 13 steps (0.77 ms) a sample, not with 10."""
    rotor = {'gyro.dtg.preset': 'sapegin_2016', 'gyro.dtg.method': 'rk4'}
    with pytest.raises(ValueError, match='RK4 step is 10 ms, at which the gyro is unstable; '
                       'expected between 0.332'):
        instrument(rotor)
    one = instrument({**rotor, 'gyro.dtg.steps_per_sample': 13})
    assert len(one.nodes) == 27
    one.settle(RATE)
    for k in range(1000):
        omega, _ = one.step((k + 1) * 10_000_000, [RATE] * 27, FORCE)
    # Open loop: the gain at rest is -j c/(k2 - j c) = 1.
    np.testing.assert_allclose(omega, RATE, rtol=1e-9)
    with pytest.raises(ValueError, match='unstable: a root grows with 7.447'):
        instrument({'gyro.dtg.preset': 'sapegin_2016'})
    with pytest.warns(UserWarning, match='unstable: a root grows'):
        instrument({'gyro.dtg.preset': 'sapegin_2016', 'gyro.dtg.on_unstable': 'warn'})


def test_rotors_that_run_away_are_a_fault():
    """Diverging rotors raise a fault in place of an infinite reading; a restart settles them."""
    values = {**DTG, 'gyro.dtg.preset': 'sapegin_2016', 'gyro.dtg.on_unstable': 'warn',
              OUT + 'quantisation_arcsec': [0.3] * 3}
    with pytest.warns(UserWarning, match='unstable'):
        s = settings(values, duration_s=200.0, source='motion')
        motion = make_motion(s.motion_generator.motion, s.motion_generator.datum,
                             s.motion_generator.earth)
        with pytest.raises(StreamFault, match='the rotors of the gyros have diverged at') as fault:
            list(imu_blocks(s, motion))
    assert fault.value.restart


def test_a_custom_gyro():
    """Preset custom defaults to the tactical gyro; impossible values are named by their key."""
    custom = {'gyro.dtg.preset': 'custom'}
    assert rotor_parameters(settings({**DTG, **custom}).imu_sensor.gyro.dtg) == TACTICAL
    slow = {**custom, 'gyro.dtg.custom.speed_hz': 200.0}
    found = rotor_parameters(settings({**DTG, **slow}).imu_sensor.gyro.dtg)
    assert found == replace(TACTICAL, speed_hz=200.0)


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
    """Impossible gyros are refused with one message that has key, value and expectation."""
    with pytest.raises(ValueError) as raised:
        instrument({'gyro.dtg.preset': 'custom', 'gyro.dtg.custom.' + key: value})
    assert says in str(raised.value) and '\n' not in str(raised.value)


def test_channels_have_the_names_of_the_settings():
    """The choices of gyro.dtg.fault.channel are the names of the channels."""
    from dataclasses import fields
    from ins_sim.settings.tuned_gyro import TunedGyroFault
    choices = {f.name: f.metadata['choices'] for f in fields(TunedGyroFault)}['channel']
    assert choices == ('none', *CHANNELS)
