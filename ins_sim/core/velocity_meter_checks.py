"""What settings of the velocity meter must fulfil together."""

from .catalogue import build, values_of
from .velocity_meter_layout import lag_s, samples
from .velocity_meter_settings import VelocityMeterSettings


def checked(settings):
    """
    Return VelocityMeterSettings if they are sound.

    Raises ValueError, in one sentence that names key, value and expectation.
    """
    settings = build(VelocityMeterSettings, values_of(settings))
    for low, high in (('height_min_m', 'height_max_m'), ('speed_min_m_s', 'speed_max_m_s')):
        least, most = getattr(settings.limits, low), getattr(settings.limits, high)
        if not least < most:
            raise ValueError(f'limits.{low} is {least:g}; expected less than limits.{high}, '
                             f'{most:g}')
    _check_drop_outs(settings.drop_outs)
    if settings.mode == 'signal':
        _check_lags(settings)
    return settings


def _check_drop_outs(drop_outs):
    starts, ends = drop_outs.start_s, drop_outs.end_s
    if len(starts) != len(ends):
        raise ValueError(f'drop_outs.end_s has {len(ends)} entries; expected {len(starts)}, as '
                         'many as drop_outs.start_s')
    for k, (start, end) in enumerate(zip(starts, ends)):
        if not start < end:
            raise ValueError(f'drop_outs.end_s[{k}] is {end:g} s; expected more than '
                             f'drop_outs.start_s[{k}], {start:g} s')


def _check_lags(settings):
    """Check that a cycle holds the lags, and the lags the delay of some speed."""
    signal, limits, antennas = settings.signal, settings.limits, settings.antennas
    step, count = lag_s(settings), samples(settings)
    if signal.lags > count:
        raise ValueError(f'signal.lags is {signal.lags}, together {signal.lags * step * 1e3:g} '
                         f'ms; expected at most the {count} that a cycle of rate_hz holds')
    offset = antennas.x0_m * (0.5 if antennas.offsets == 'physical' else 1.0)
    longest, shortest = offset / limits.speed_min_m_s, offset / limits.speed_max_m_s
    if longest < step:
        raise ValueError(f'signal.prf_hz is {signal.prf_hz:g} Hz, and a lag of '
                         f'signal.pulses_per_lag {step * 1e3:g} ms; expected less than '
                         f'{longest * 1e3:g} ms, the delay at limits.speed_min_m_s')
    if shortest > (signal.lags - 2) * step:
        raise ValueError(f'signal.lags is {signal.lags}, the last but one at '
                         f'{(signal.lags - 2) * step * 1e3:g} ms; expected more than '
                         f'{shortest * 1e3:g} ms, the delay at limits.speed_max_m_s')
