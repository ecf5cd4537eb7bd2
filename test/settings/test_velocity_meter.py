"""Bad settings of the velocity meter are refused with one message at construction."""

import math

from support.meter_studies import meter_settings
import pytest

from ins_sim.settings.catalogue import build, flatten
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.settings.velocity_meter import Limits, Signal, VelocityMeterSettings


@pytest.mark.parametrize('values, says', [
    ({'antennas.x0_m': 0.0}, 'antennas.x0_m is 0 m; expected 0.001 to 10 m'),
    ({'antennas.y0_m': 0.0}, 'antennas.y0_m is 0 m; expected 0.001 to 10 m'),
    ({'antennas.antenna_2': 'up'}, "antennas.antenna_2 is 'up'; expected one of right, left"),
    ({'signal.lags': 167}, 'signal.lags is 167, together 10.02 ms; expected at most 166, the '
     'number that fits into a cycle of rate_hz'),
    ({'signal.prf_hz': 1e7}, 'signal.lags is 64, with the last but one at 0.0372 ms; expected '
     'more than 0.25 ms, the delay at limits.speed_max_m_s'),
    ({'signal.prf_hz': 0.0}, 'signal.prf_hz is 0 Hz; expected 1 to 1e+07 Hz'),
    ({'signal.snr_db': math.nan}, 'signal.snr_db is nan; expected a finite number'),
    ({'signal.pulses_per_lag': 0}, 'signal.pulses_per_lag is 0; expected 1 to 1000'),
    ({'signal.detection': 'phase'}, "signal.detection is 'phase'; expected one of power, complex"),
    ({'limits.speed_min_m_s': 400.0}, 'limits.speed_min_m_s is 400; expected less than '
     'limits.speed_max_m_s, 400'),
    ({'limits.height_min_m': 2e4}, 'limits.height_min_m is 20000; expected less than '
     'limits.height_max_m, 15000'),
    ({'surrogate.sigma_x_m_s': -1.0}, 'surrogate.sigma_x_m_s is -1 m/s; expected 0 to'),
    ({'drop_outs.start_s': (10.0, 20.0), 'drop_outs.end_s': (15.0,)}, 'drop_outs.end_s has 1 '
     'entries; expected 2, as many as drop_outs.start_s'),
    ({'drop_outs.start_s': (10.0,), 'drop_outs.end_s': (10.0,)}, 'drop_outs.end_s[0] is 10 s; '
     'expected more than drop_outs.start_s[0], 10 s'),
    ({'drop_outs.start_s': (-1.0,), 'drop_outs.end_s': (10.0,)}, 'drop_outs.start_s is -1 s; '
     'expected 0 to')])
def test_a_bad_value_is_refused(values, says):
    """A bad value is refused with key, value and expectation."""
    with pytest.raises(ValueError) as raised:
        build(VelocityMeterSettings, {'mode': 'signal', **values})
    message = str(raised.value)
    assert message.startswith(says) and '\n' not in message and not message.endswith('.')


def test_settings_made_by_hand_check_themselves():
    """Contradicting values are refused however the settings are created."""
    with pytest.raises(ValueError, match='signal.lags is 167'):
        VelocityMeterSettings(mode='signal', signal=Signal(lags=167))
    with pytest.raises(ValueError, match='limits.speed_min_m_s is 400'):
        Limits(speed_min_m_s=400.0)


def test_lags_too_long_for_the_fastest_delay():
    """A PRF so low that every delay is less than one lag is refused."""
    with pytest.raises(ValueError) as raised:
        VelocityMeter(meter_settings(mode='signal', signal__prf_hz=5000.0, signal__lags=8,
                                     limits__speed_min_m_s=100.0))
    assert str(raised.value) == (
        'signal.prf_hz is 5000 Hz, with which a lag of signal.pulses_per_lag lasts 1.2 ms; '
        'expected less than 1 ms, the delay at limits.speed_min_m_s')


def test_a_cycle_that_takes_too_much():
    """A high PRF with a long cycle, which would exceed the memory, is refused."""
    with pytest.raises(ValueError) as raised:
        VelocityMeter(meter_settings(mode='signal', signal__prf_hz=1e7, signal__lags=4096,
                                     rate_hz=1.0))
    assert str(raised.value) == (
        'signal.prf_hz is 1e+07 Hz with signal.pulses_per_lag 6: a cycle needs 2097152 modes of '
        'the field; expected at most 1048576')


def test_the_surrogate_has_no_signals():
    """Mode surrogate ignores the settings of the signals."""
    VelocityMeter(meter_settings(signal__lags=4000))


def test_every_key_has_bounds_and_a_doc():
    """The defaults of the velocity meter pass their own check, and every key has bounds."""
    known = flatten(VelocityMeterSettings)
    assert build(VelocityMeterSettings, {name: f.default for name, f in known.items()}) == \
        VelocityMeterSettings()
    for f in known.values():
        assert f.metadata['doc']
        assert f.metadata['choices'] or f.metadata['low'] is not None or f.type in (bool, str)
