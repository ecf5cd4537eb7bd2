"""Invalid sensor settings are refused with one message; presets, covariances and sampling."""

from dataclasses import FrozenInstanceError
import math
import re

import numpy as np
import pytest
from scipy.stats import binom, chi2

from ins_sim.settings.catalogue import build, flatten
from ins_sim.settings.instrument_errors import (AccelerometerErrors, GyroErrors, Sampling,
                                                Temperature)
from ins_sim.settings.presets import ACCELEROMETER, GYRO, preset, preset_triads, PRESETS
from ins_sim.core.sensors.imu.sampling import Sampler
from ins_sim.core.sensors.imu.triad_errors import TriadErrors
from ins_sim.core.numerics.units import DEG
from ins_sim.core.sensors.imu.triad_model import KEYS, triad_model, white_variance

DT = 0.01
QUANTILE = 1e-6


def three(value):
    """Return a value for all axes."""
    return (value,) * 3


@pytest.mark.parametrize('cls, key, value, says', [
    (GyroErrors, 'angle_random_walk_deg_sqrt_h', three(-0.1), 'is -0.1 deg/sqrt(h); expected 0'),
    (GyroErrors, 'rate_random_walk_deg_h_sqrt_h', (0.0, -1.0, 0.0), 'is -1 deg/h/sqrt(h); exp'),
    (GyroErrors, 'bias_instability_deg_h', three(-1e-9), 'expected 0 to'),
    (GyroErrors, 'gauss_markov_time_s', three(0.0), 'is 0 s; expected 0.001 to'),
    (GyroErrors, 'gauss_markov_time_s', three(-5.0), 'is -5 s; expected 0.001 to'),
    (GyroErrors, 'gauss_markov_time_s', three(math.nan), 'expected a finite number'),
    (GyroErrors, 'gauss_markov_time_s', (9.0, 9.0), 'expected 3 correlation times'),
    (GyroErrors, 'turn_on_bias_sigma_deg_h', three(-1.0), 'expected 0 to'),
    (GyroErrors, 'bias_deg_h', three(math.inf), 'expected a finite number'),
    (GyroErrors, 'bias_deg_h', (1.0, 2.0), 'has 2 entries; expected 3'),
    (GyroErrors, 'bias_deg_h', ('a', 1.0, 2.0), "is 'a'; expected a number"),
    (GyroErrors, 'bandwidth_order', 3, 'is 3; expected 1 to 2'),
    (GyroErrors, 'bandwidth_hz', three(-1.0), 'expected 0 to'),
    (GyroErrors, 'quantisation_arcsec', three(-1.0), 'expected 0 to'),
    (GyroErrors, 'saturation_deg_s', three(-1.0), 'expected 0 to'),
    (AccelerometerErrors, 'velocity_random_walk_m_s_sqrt_h', three(-1.0), 'expected 0 to'),
    (AccelerometerErrors, 'gauss_markov_time_s', three(0.0), 'expected 0.001 to')])
def test_a_bad_value_is_refused(cls, key, value, says):
    """A bad value is refused with a message that has key, value and expectation."""
    with pytest.raises(ValueError) as raised:
        TriadErrors(cls(**{key: value}), 1, 0, 'gyro', DT)
    message = str(raised.value)
    assert message.startswith(f'gyro.{key}') and says in message and '\n' not in message
    assert len(re.findall(r'\. [A-Z]', message)) == 0


@pytest.mark.parametrize('terms, says', [
    ({'angle_random_walk_deg_sqrt_h': 6.0, 'saturation_deg_s': 4.0},
     'gyro.saturation_deg_s is 4 on axis x; expected at least 5, 5 standard deviations of the '
     'white noise (angle_random_walk_deg_sqrt_h) of a sample'),
    ({'quantisation_arcsec': 360.0, 'saturation_deg_s': 4.0},
     'gyro.saturation_deg_s is 4 on axis x; expected at least 10, one pulse '
     '(quantisation_arcsec) a sample')])
def test_saturation_below_noise_is_refused(terms, says):
    """A saturation below the noise, or below one output pulse, is refused."""
    with pytest.raises(ValueError) as raised:
        TriadErrors(GyroErrors(**{k: three(v) for k, v in terms.items()}), 1, 0, 'gyro', DT)
    assert str(raised.value) == says


def test_infinite_correlation_time():
    """Only a correlation time may be infinite, which gives a random walk; in files too."""
    key = 'gauss_markov_time_s'
    model = triad_model(GyroErrors(gauss_markov_time_s=three(math.inf)), DT)
    assert model.gauss_markov_time == three(math.inf)
    assert build(GyroErrors, {key: three(math.inf)}).gauss_markov_time_s == three(math.inf)
    with pytest.raises(ValueError, match='bias_deg_h is inf; expected a finite number'):
        build(GyroErrors, {'bias_deg_h': three(math.inf)})


@pytest.mark.parametrize('cls', [GyroErrors, AccelerometerErrors, Temperature, Sampling])
def test_every_key_has_unit_bounds_and_doc(cls):
    """The defaults pass their own check, and each key changes a coefficient."""
    known = flatten(cls)
    assert build(cls, {name: f.default for name, f in known.items()}) == cls()
    for f in known.values():
        assert f.metadata['doc'] and f.metadata['low'] is not None
    if cls in KEYS:
        assert set(KEYS[cls]) == set(known)
        assert all(f.metadata['size'] == 3 for name, f in known.items()
                   if name != 'bandwidth_order')


def test_reported_variance():
    """The reported variance is N^2/dt + (q/dt)^2/6 by axis, or the square of the override."""
    gyro = GyroErrors(angle_random_walk_deg_sqrt_h=(0.1, 0.2, 0.0),
                      quantisation_arcsec=(0.0, 0.0, 0.6),
                      reported_sigma_deg_s=(-1.0, 0.5, 0.0))
    assert white_variance(gyro, DT) == pytest.approx(
        ((0.1 * DEG / 60.0) ** 2 / DT, (0.5 * DEG) ** 2, 0.0))
    free = GyroErrors(quantisation_arcsec=three(0.6))
    assert white_variance(free, DT) == pytest.approx(three((0.6 / 3600.0 * DEG / DT) ** 2 / 6.0))
    accel = AccelerometerErrors(velocity_random_walk_m_s_sqrt_h=three(0.03))
    assert white_variance(accel, DT) == pytest.approx(three(0.03 ** 2 / 3600.0 / DT))
    assert white_variance(GyroErrors(), DT) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize('name', PRESETS)
def test_presets_are_complete_and_cannot_be_changed(name):
    """Each preset builds and names its class and values; changing a copy does not change it."""
    one = PRESETS[name]
    assert one.name == name and one.datasheet and 'ARW' in one.figures and 'VRW' in one.figures
    values = preset(name)
    for prefix, cls, made in zip((GYRO, ACCELEROMETER), KEYS, preset_triads(name)):
        part = {k.removeprefix(prefix): v for k, v in values.items() if k.startswith(prefix)}
        assert part and build(cls, part) == made
        TriadErrors(made, 1, 0, prefix, DT)
    values[GYRO + 'bias_deg_h'] = values.clear()
    assert preset(name) == dict(one.values) and preset(name) != values
    with pytest.raises(TypeError):
        one.values['x'] = 1
    with pytest.raises(FrozenInstanceError):
        one.name = 'x'


def test_an_unknown_preset_names_the_nearest():
    """An unknown preset is refused with a message that names the nearest one."""
    with pytest.raises(ValueError, match="unknown instrument preset 'tactical_mens'; the nearest "
                       "known one is 'tactical_mems'"):
        preset('tactical_mens')


def test_sampling():
    """Latency is constant, jitter has its sigma and keeps the order, and losses their share."""
    dt, n = 10_000_000, 20000
    assert Sampler(Sampling(), 1, 0, 'sampling', dt).stamp(5, 7) == 7
    late = Sampler(Sampling(latency_us=1500.0), 1, 0, 'sampling', dt)
    assert [late.stamp(k, k * dt) - k * dt for k in (0, 9)] == [1_500_000] * 2
    made = Sampler(Sampling(jitter_us=900.0, drop_out_probability=0.1), 1, 0, 'sampling', dt)
    stamps = [made.stamp(k, k * dt) for k in range(n)]
    lost = stamps.count(None)
    print(f'{lost} of {n} samples lost at 0.1')
    assert binom.ppf(QUANTILE, n, 0.1) < lost < binom.isf(QUANTILE, n, 0.1)
    kept = [s for s in stamps if s is not None]
    assert all(a < b for a, b in zip(kept, kept[1:]))
    z = np.array([s - k * dt for k, s in enumerate(stamps) if s is not None]) / 900e3
    assert chi2.ppf(QUANTILE, len(z)) < (z ** 2).sum() < chi2.isf(QUANTILE, len(z))
    again = Sampler(Sampling(jitter_us=900.0, drop_out_probability=0.1), 1, 0, 'sampling', dt)
    assert [again.stamp(k, k * dt) for k in (n - 1, 0, 77)] == [stamps[k] for k in (n - 1, 0, 77)]


@pytest.mark.parametrize('terms, says', [
    ({'jitter_us': 1001.0}, 'sampling.jitter_us is 1001 us; expected at most 1000 us, a tenth'),
    ({'jitter_us': -1.0}, 'sampling.jitter_us is -1 us; expected 0'),
    ({'drop_out_probability': 1.5}, 'sampling.drop_out_probability is 1.5; expected 0 to 1'),
    ({'latency_us': math.nan}, 'sampling.latency_us is nan; expected a finite number')])
def test_bad_sampling_is_refused(terms, says):
    """Bad sampling settings are refused with key, value and expectation."""
    with pytest.raises(ValueError) as raised:
        Sampler(Sampling(**terms), 1, 0, 'sampling', 10_000_000)
    assert says in str(raised.value)
