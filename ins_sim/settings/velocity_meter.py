"""
Settings of the node velocity_meter, the correlation velocity meter.

Axes of the antennas: X1 forward, Z1 right (docs/theory/velocity_meter.md).
"""

from .field import group, setting, settings_class, SettingsGroup
from .fix_schedule import Window
from .node import Topics
from .place import Datum, Earth, Frames, Tf


@settings_class
class Antennas(SettingsGroup):
    """Three receiving antennas: 1 at (+X0, 0), 2 to the side at (0, Y0), 3 at (-X0, 0)."""

    x0_m: float = setting(0.20, 'distance of antennas 1 and 3 from the middle, X0', 'm', 1e-3,
                          10.0)
    y0_m: float = setting(0.08, 'distance of antenna 2 from the middle, Y0', 'm', 1e-3, 10.0)
    antenna_2: str = setting('right', 'side of antenna 2: right (s2 = +1) or left (s2 = -1)',
                             choices=('right', 'left'))
    offsets: str = setting('physical', 'what X0 and Y0 are: of the antennas, one transmitter '
                           'serving all (physical, kappa = 1/2), or of the phase centres there '
                           'and back (effective, kappa = 1)', choices=('physical', 'effective'))
    mounting_yaw_arcmin: float = setting(0.0, 'mounting error, antennas turned left positive, mu',
                                         'arcmin', -2700.0, 2700.0)


@settings_class
class Beam(SettingsGroup):
    """The beam, which sets the correlation lengths lambda/(4 pi sigma_theta)."""

    wavelength_m: float = setting(0.07, 'wavelength, lambda', 'm', 1e-4, 10.0)
    sigma_theta_x_rad: float = setting(0.10, 'standard deviation of the two-way power pattern '
                                       'fore and aft', 'rad', 1e-3, 1.0)
    sigma_theta_z_rad: float = setting(0.10, 'the same across; unlike the other it makes the '
                                       'lateral scale 1 + k_z = (z/x)^2 (in surrogate too)',
                                       'rad', 1e-3, 1.0)


@settings_class
class Signal(SettingsGroup):
    """Mode signal: pulses, receivers and correlators."""

    prf_hz: float = setting(1e5, 'pulse repetition frequency', 'Hz', 1.0, 1e7)
    pulses_per_lag: int = setting(6, 'pulse periods from lag to lag', '', 1, 1000)
    lags: int = setting(64, 'lags of each correlation function, from 0', '', 8, 4096)
    snr_db: float = setting(10.0, 'signal to noise ratio of a sample', 'dB', -30.0, 200.0)
    detection: str = setting('power', 'what is correlated: powers (square-law detector), or '
                             'complex amplitudes', choices=('power', 'complex'))
    normalisation: str = setting('window', 'mean power that correlations are divided by: that of '
                                 'the window, or cycle by cycle, as the paper has it, which makes '
                                 'V_z 5 % small in cycles of 10 ms', choices=('window', 'cycle'))
    decay_time_s: float = setting(0.0, 'the field itself decays as exp(-t^2/(2 T_d^2)), T_d; 0 = '
                                  'it is frozen', 's', 0.0, 1e3)


@settings_class
class Limits(SettingsGroup):
    """Where the instrument measures; elsewhere its fixes are invalid."""

    height_min_m: float = setting(50.0, 'least height', 'm', -1e4, 1e6)
    height_max_m: float = setting(15000.0, 'greatest height', 'm', -1e4, 1e6)
    speed_min_m_s: float = setting(30.0, 'least forward speed, true and measured', 'm/s', 0.1,
                                   1e4)
    speed_max_m_s: float = setting(400.0, 'greatest forward speed, true and measured', 'm/s', 0.1,
                                   1e4)

    def check(self):
        """Refuse limits in the wrong order."""
        for low, high in (('height_min_m', 'height_max_m'), ('speed_min_m_s', 'speed_max_m_s')):
            least, most = getattr(self, low), getattr(self, high)
            if not least < most:
                raise ValueError(f'limits.{low} is {least:g}; expected less than limits.{high}, '
                                 f'{most:g}')


@settings_class
class Surrogate(SettingsGroup):
    """Mode surrogate: errors of the window mean; N cycles, beta sideslip."""

    sigma_x_m_s: float = setting(8.0, 'forward sigma of one cycle: sigma_x/sqrt(N) '
                                 'sqrt(1 + (slip_x beta)^2)', 'm/s', 0.0, 1e3)
    slip_x: float = setting(6.0, 'slip_x in it', '1/rad', 0.0, 1e3)
    sigma_z_m_s: float = setting(8.7, 'lateral sigma of one cycle: sqrt(sigma_z^2 + (slip_z '
                                 'beta)^2)/sqrt(N)', 'm/s', 0.0, 1e3)
    slip_z_m_s: float = setting(160.0, 'slip_z in it', 'm/s/rad', 0.0, 1e5)
    bias_x_m_s: float = setting(-16.0, 'forward bias of one cycle, over N', 'm/s', -1e3, 1e3)
    k_x: float = setting(0.0, 'forward scale error', '', -0.5, 0.5)
    k_z: float = setting(0.0, 'lateral scale error, besides that of the beam', '', -0.5, 0.5)


@settings_class
class DropOuts(SettingsGroup):
    """Flights over calm water, which gives no echo: windows that overlap are invalid."""

    start_s: tuple[float, ...] = setting((), 'motion times of their begins', 's', 0.0, 1e7)
    end_s: tuple[float, ...] = setting((), 'motion times of their ends, as many', 's', 0.0, 1e7)

    def check(self):
        """Refuse lists that do not go together."""
        if len(self.start_s) != len(self.end_s):
            raise ValueError(f'drop_outs.end_s has {len(self.end_s)} entries; expected '
                             f'{len(self.start_s)}, as many as drop_outs.start_s')
        for k, (start, end) in enumerate(zip(self.start_s, self.end_s)):
            if not start < end:
                raise ValueError(f'drop_outs.end_s[{k}] is {end:g} s; expected more than '
                                 f'drop_outs.start_s[{k}], {start:g} s')


@settings_class
class VelocityMeterSettings(SettingsGroup):
    """Node velocity_meter."""

    SETTABLE, SPANS = ('drop_outs.start_s', 'drop_outs.end_s'), ('drop_outs',)
    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    topics: Topics = group(Topics)
    window: Window = group(Window)
    mode: str = setting('surrogate', 'signal: fields, correlation functions and fits; surrogate: '
                        'the window mean with the errors of such a meter at 250 m/s',
                        choices=('signal', 'surrogate'))
    attack_angle: str = setting('ins', 'angle of attack: from the body velocity of the INS, or '
                                'none (0)', choices=('ins', 'none'))
    antennas: Antennas = group(Antennas)
    beam: Beam = group(Beam)
    signal: Signal = group(Signal)
    limits: Limits = group(Limits)
    surrogate: Surrogate = group(Surrogate)
    drop_outs: DropOuts = group(DropOuts)
    seed: int = setting(0, 'seed of the random errors: the same seed, the same errors', '', 0,
                        2147483647)
    run: int = setting(0, 'number of the run in an ensemble: each draws other random errors', '',
                       0, 2147483647)
    rate_hz: float = setting(100.0, 'rate of the navigation cycles, that of the IMU', 'Hz', 0.01,
                             20000.0)
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew (reset) or end the node (stop)', choices=('reset', 'stop'))

    @property
    def lag_s(self):
        """Return the time from lag to lag, s."""
        return self.signal.pulses_per_lag / self.signal.prf_hz

    @property
    def samples(self):
        """Return how many samples, a lag apart, a navigation cycle has."""
        # A quotient that is whole but for rounding is whole.
        return int((1.0 + 1e-9) / (self.rate_hz * self.lag_s))

    def check(self):
        """Refuse a signal whose lags do not fit a cycle, or miss the delay of every speed."""
        if self.mode != 'signal':
            return
        signal, limits, antennas = self.signal, self.limits, self.antennas
        step = self.lag_s
        if signal.lags > self.samples:
            raise ValueError(f'signal.lags is {signal.lags}, together {signal.lags * step * 1e3:g}'
                             f' ms; expected at most the {self.samples} that a cycle of rate_hz '
                             'holds')
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
