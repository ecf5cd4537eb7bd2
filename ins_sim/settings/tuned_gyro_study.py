"""Settings of one table of the tuned-gyro study: default, unit, bounds and doc of every key."""

from .field import setting, settings_class, SettingsGroup
from .tuned_gyro import ROTORS

SWEEPS = {'base_rate': 'base rate [rad/s]', 'rotor_speed': 'rotor speed [Hz]'}


@settings_class
class TunedGyroStudySettings(SettingsGroup):
    """One table and its figure: a rocking base recovered through two tuned gyros."""

    sweep: str = setting('base_rate', 'what the values are: angular frequency of the base or '
                         'speed of the rotors, tuned there', choices=tuple(SWEEPS))
    values: tuple[float, ...] = setting((1.0,), 'values of the table, rad/s or Hz', '', 1e-3, 1e4)
    paper_deg: tuple[float, ...] = setting((), 'what the paper prints for each of them; none = '
                                           'no comparison', 'deg', 0.0, 90.0)
    paper_limits_hz: tuple[float, ...] = setting((), 'lowest and highest stable speed in the '
                                                 'paper; none = no comparison', 'Hz', 1e-3, 1e4)
    curve_values: tuple[float, ...] = setting((), 'values of the curve in the figure; none = '
                                              'those of the table', '', 1e-3, 1e4)
    amplitude_deg: float = setting(10.0, 'amplitude of the rocking in roll', 'deg', 1e-3, 89.0)
    base_rate_rad_s: float = setting(1.0, 'angular frequency of the base where the speed is swept',
                                     'rad/s', 1e-3, 1e4)
    rotor_speed_hz: float = setting(230.0, 'speed of the rotors where the base rate is swept, and '
                                    'where the search for the limits begins', 'Hz', 1e-3, 1e4)
    preset: str = setting('sapegin_2016', 'parameters of both gyros '
                          '(sensors.tuned_gyro.rotor.PRESETS)',
                          choices=ROTORS)
    method: str = setting('rk4', 'integration of the gyros: rk4 as in the paper, or exact',
                          choices=('rk4', 'exact'))
    step_ms: float = setting(0.75, 'step of gyros and orientation', 'ms', 1e-3, 100.0)

    def check(self):
        """Check the lists against each other."""
        if len(self.paper_deg) not in (0, len(self.values)):
            raise ValueError(f'paper_deg has {len(self.paper_deg)} entries; expected none or '
                             f'{len(self.values)}, one for each of values')
        if len(self.paper_limits_hz) not in (0, 2):
            raise ValueError(f'paper_limits_hz has {len(self.paper_limits_hz)} entries; expected '
                             'none or 2')
        if not self.values:
            raise ValueError('values is empty; expected at least one')
