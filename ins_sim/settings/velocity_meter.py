"""
Settings of the node velocity_meter, a correlation velocity meter.

The axes of the antennas are X1 forward and Z1 right (docs/theory/velocity_meter.md).
"""

from .field import group, setting, settings_class, SettingsGroup
from .fix_schedule import Window
from .node import Topics
from .place import Datum, Earth, Frames, Tf


@settings_class
class Antennas(SettingsGroup):
    """Three receiving antennas: 1 at (+X0, 0), 2 to the side at (0, Y0), 3 at (-X0, 0)."""

    x0_m: float = setting(0.20, 'Distance X0 of antennas 1 and 3 from the middle', 'm', 1e-3, 10.0)
    y0_m: float = setting(0.08, 'Distance Y0 of antenna 2 from the middle', 'm', 1e-3, 10.0)
    antenna_2: str = setting('right', 'Side of antenna 2: right (s2 = +1) or left (s2 = -1)',
                             choices=('right', 'left'))
    offsets: str = setting('physical', 'Meaning of X0 and Y0. physical: positions of the '
                           'antennas, with one common transmitter (kappa = 1/2); effective: '
                           'two-way phase centres (kappa = 1)', choices=('physical', 'effective'))
    mounting_yaw_arcmin: float = setting(0.0, 'Yaw mounting error mu of the antennas, positive to '
                                         'the left', 'arcmin', -2700.0, 2700.0)


@settings_class
class Beam(SettingsGroup):
    """Beam; it determines the correlation lengths lambda/(4 pi sigma_theta)."""

    wavelength_m: float = setting(0.07, 'Wavelength lambda', 'm', 1e-4, 10.0)
    sigma_theta_x_rad: float = setting(0.10, 'Standard deviation of the two-way power pattern '
                                       'fore and aft', 'rad', 1e-3, 1.0)
    sigma_theta_z_rad: float = setting(0.10, 'Standard deviation of the two-way power pattern '
                                       'across. If it differs from sigma_theta_x_rad, the lateral '
                                       'scale becomes 1 + k_z = (sigma_theta_z/sigma_theta_x)^2, '
                                       'in both modes', 'rad', 1e-3, 1.0)


@settings_class
class Signal(SettingsGroup):
    """Pulses, receivers and correlators of mode signal."""

    prf_hz: float = setting(1e5, 'Pulse repetition frequency', 'Hz', 1.0, 1e7)
    pulses_per_lag: int = setting(6, 'Number of pulse periods from one lag to the next', '', 1,
                                  1000)
    lags: int = setting(64, 'Number of lags of each correlation function, counted from lag 0', '',
                        8, 4096)
    snr_db: float = setting(10.0, 'Signal-to-noise ratio of a sample', 'dB', -30.0, 200.0)
    detection: str = setting('power', 'Signals that are correlated. power: powers of a square-law '
                             'detector; complex: complex amplitudes', choices=('power', 'complex'))
    normalisation: str = setting('window', 'Mean power by which correlations are divided. window: '
                                 'mean over the window; cycle: mean over each cycle, as in the '
                                 'published scheme, which makes V_z 5 % too small with cycles of '
                                 '10 ms', choices=('window', 'cycle'))
    decay_time_s: float = setting(0.0, 'Decay time T_d of the scattered field, which loses '
                                  'correlation as exp(-t^2/(2 T_d^2)); 0 = the field is frozen',
                                  's', 0.0, 1e3)


@settings_class
class Limits(SettingsGroup):
    """Range in which the meter measures; outside it fixes are invalid."""

    height_min_m: float = setting(50.0, 'Least height', 'm', -1e4, 1e6)
    height_max_m: float = setting(15000.0, 'Greatest height', 'm', -1e4, 1e6)
    speed_min_m_s: float = setting(30.0, 'Least forward speed, true and measured', 'm/s', 0.1, 1e4)
    speed_max_m_s: float = setting(400.0, 'Greatest forward speed, true and measured', 'm/s', 0.1,
                                   1e4)

    def check(self):
        """Raise ValueError unless lower limits are less than upper ones."""
        for low, high in (('height_min_m', 'height_max_m'), ('speed_min_m_s', 'speed_max_m_s')):
            least, most = getattr(self, low), getattr(self, high)
            if not least < most:
                raise ValueError(f'limits.{low} is {least:g}; expected less than limits.{high}, '
                                 f'{most:g}')


@settings_class
class Surrogate(SettingsGroup):
    """Errors of the window mean in mode surrogate (N cycles, sideslip beta)."""

    sigma_x_m_s: float = setting(8.0, 'Forward standard deviation sigma_x of one cycle; a fix has '
                                 'sigma_x/sqrt(N) sqrt(1 + (slip_x beta)^2)', 'm/s', 0.0, 1e3)
    slip_x: float = setting(6.0, 'Coefficient slip_x of the sideslip beta in the forward standard '
                            'deviation', '1/rad', 0.0, 1e3)
    sigma_z_m_s: float = setting(8.7, 'Lateral standard deviation sigma_z of one cycle; a fix has '
                                 'sqrt(sigma_z^2 + (slip_z beta)^2)/sqrt(N)', 'm/s', 0.0, 1e3)
    slip_z_m_s: float = setting(160.0, 'Coefficient slip_z of the sideslip beta in the lateral '
                                'standard deviation', 'm/s/rad', 0.0, 1e5)
    bias_x_m_s: float = setting(-16.0, 'Forward bias of one cycle; the bias of a fix is this '
                                'value divided by N', 'm/s', -1e3, 1e3)
    k_x: float = setting(0.0, 'Forward scale error', '', -0.5, 0.5)
    k_z: float = setting(0.0, 'Lateral scale error, in addition to the effect of the beam', '',
                         -0.5, 0.5)


@settings_class
class DropOuts(SettingsGroup):
    """Drop-outs, as over calm water; overlapping windows are invalid."""

    start_s: tuple[float, ...] = setting((), 'Motion times at which the drop-outs begin', 's', 0.0,
                                         1e7)
    end_s: tuple[float, ...] = setting((), 'Motion times at which the drop-outs end, one for each '
                                       'start', 's', 0.0, 1e7)

    def check(self):
        """Raise ValueError unless each drop-out has a start and a later end."""
        if len(self.start_s) != len(self.end_s):
            raise ValueError(f'drop_outs.end_s has {len(self.end_s)} entries; expected '
                             f'{len(self.start_s)}, as many as drop_outs.start_s')
        for k, (start, end) in enumerate(zip(self.start_s, self.end_s)):
            if not start < end:
                raise ValueError(f'drop_outs.end_s[{k}] is {end:g} s; expected more than '
                                 f'drop_outs.start_s[{k}], {start:g} s')


@settings_class
class VelocityMeterSettings(SettingsGroup):
    """Settings of the node velocity_meter."""

    SETTABLE, SPANS = ('drop_outs.start_s', 'drop_outs.end_s'), ('drop_outs',)
    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    topics: Topics = group(Topics)
    window: Window = group(Window)
    mode: str = setting('surrogate', 'Simulation mode. signal: echo fields, correlation functions '
                        'and fits; surrogate: the mean velocity over the window with the error '
                        'statistics of such a meter at 250 m/s', choices=('signal', 'surrogate'))
    attack_angle: str = setting('ins', 'Angle of attack used by the meter. ins: from the body '
                                'velocity of the INS; none: zero', choices=('ins', 'none'))
    antennas: Antennas = group(Antennas)
    beam: Beam = group(Beam)
    signal: Signal = group(Signal)
    limits: Limits = group(Limits)
    surrogate: Surrogate = group(Surrogate)
    drop_outs: DropOuts = group(DropOuts)
    seed: int = setting(0, 'Seed of the random errors; the same seed gives the same errors', '', 0,
                        2147483647)
    run: int = setting(0, 'Number of the run in a Monte Carlo ensemble; each number gives other '
                       'random errors', '', 0, 2147483647)
    rate_hz: float = setting(100.0, 'Rate of the navigation cycles; must equal the rate of the '
                             'IMU', 'Hz', 0.01, 20000.0)
    on_fault: str = setting('reset', 'What the node does after a gap, a backward time stamp or an '
                            'invalid message: start anew (reset) or end (stop)',
                            choices=('reset', 'stop'))

    @property
    def lag_s(self):
        """Return the time from one lag to the next, s."""
        return self.signal.pulses_per_lag / self.signal.prf_hz

    @property
    def samples(self):
        """Return the number of samples, one lag apart, in a navigation cycle."""
        # The margin keeps rounding from losing the last sample of a whole quotient.
        return int((1.0 + 1e-9) / (self.rate_hz * self.lag_s))

    def check(self):
        """Raise ValueError unless the lags fit a cycle and cover the delays of all speeds."""
        if self.mode != 'signal':
            return
        signal, limits, antennas = self.signal, self.limits, self.antennas
        step = self.lag_s
        if signal.lags > self.samples:
            raise ValueError(f'signal.lags is {signal.lags}, together {signal.lags * step * 1e3:g}'
                             f' ms; expected at most {self.samples}, the number that fits into a '
                             'cycle of rate_hz')
        offset = antennas.x0_m * (0.5 if antennas.offsets == 'physical' else 1.0)
        longest, shortest = offset / limits.speed_min_m_s, offset / limits.speed_max_m_s
        if longest < step:
            raise ValueError(f'signal.prf_hz is {signal.prf_hz:g} Hz, with which a lag of '
                             f'signal.pulses_per_lag lasts {step * 1e3:g} ms; expected less than '
                             f'{longest * 1e3:g} ms, the delay at limits.speed_min_m_s')
        if shortest > (signal.lags - 2) * step:
            raise ValueError(f'signal.lags is {signal.lags}, with the last but one at '
                             f'{(signal.lags - 2) * step * 1e3:g} ms; expected more than '
                             f'{shortest * 1e3:g} ms, the delay at limits.speed_max_m_s')
