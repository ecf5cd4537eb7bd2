"""Settings of a strapdown that has no truth: that of a real IMU."""

from .field import setting, settings_class, SettingsGroup
from .self_alignment import GivenState


@settings_class
class StandaloneInputs(SettingsGroup):
    """Topics of a strapdown without truth; a remapping serves as well."""

    imu: str = setting('imu/data_raw', 'sensor_msgs/Imu')
    fix: str = setting('gnss/fix', 'sensor_msgs/NavSatFix')
    pressure: str = setting('imu/pressure', 'sensor_msgs/FluidPressure')
    magnetic_field: str = setting('imu/mag', 'sensor_msgs/MagneticField, in the frame of the IMU')


@settings_class
class GapSettings(SettingsGroup):
    """Gaps in the readings of a strapdown without truth."""

    factor: float = setting(3.0, 'a step longer than this many median steps is a gap', '', 1.1,
                            1e6)
    longest_bridge_s: float = setting(1.0, 'over a gap up to this long rate and force are drawn '
                                      'straight; after a longer one the start is searched anew',
                                      's', 0.0, 1e5)


@settings_class
class StandaloneStart(GivenState):
    """Where the start comes from."""

    source: str = setting('truth', 'truth: from the simulation. Without truth, for a real IMU, '
                          'given: position, velocity and attitude of initial.*; alignment: at '
                          'rest, level from gravity; fix: position from inputs.fix, attitude of '
                          'initial.*, or with initial.heading course on the move',
                          choices=('truth', 'given', 'alignment', 'fix'))
    heading: str = setting('auto', 'heading of an alignment, or of a start from a fix. '
                           'gyrocompass; given: heading_deg; course: that of the fixes, once '
                           'they have moved; magnetometer; auto: the first of gyrocompass, '
                           'course, magnetometer that can be had',
                           choices=('auto', 'gyrocompass', 'given', 'course', 'magnetometer'))
    position: str = setting('fix', 'position of an alignment: that of inputs.fix, or given',
                            choices=('fix', 'given'))
    declination: str = setting('model', 'of the magnetic field. model: by the World Magnetic '
                               'Model, where pygeomag is installed; given: declination_deg',
                               choices=('model', 'given'))
    declination_deg: float = setting(0.0, 'declination, East of true north', 'deg', -180.0, 180.0)
    magnetic_sigma_deg: float = setting(5.0, 'standard deviation of a magnetic heading', 'deg',
                                        0.1, 180.0)

    def check_used(self):
        """
        Refuse a heading that its source leaves unused.

        A heading that is given but not used would look as if it had been used.
        """
        used = self.source == 'given' or self.heading == 'given'
        if self.heading_deg and not used:
            raise ValueError(f'initial.heading_deg is {self.heading_deg} and would not be used; '
                             'expected initial.heading (or initial.source) given')
        if self.source == 'fix' and self.heading not in ('auto', 'given', 'course'):
            raise ValueError(f'initial.heading is {self.heading} and initial.source fix; expected '
                             'given or course: a start on the move has no other')
