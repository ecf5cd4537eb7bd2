"""How a recorded IMU is read: its columns and units, its stamps, and what may be odd about it."""

from .field import column, group, setting, settings_class, SettingsGroup

# What a sample of an IMU is, see the setting ``input``.
INPUTS = ('instant', 'integrated', 'rotation_vector')


@settings_class
class ImuColumns(SettingsGroup):
    """Headers of a CSV file of an IMU."""

    t_s: str = column('time')
    gx_rps: str = column('angular rate about x')
    gy_rps: str = column('angular rate about y')
    gz_rps: str = column('angular rate about z')
    ax_mps2: str = column('specific force along x')
    ay_mps2: str = column('specific force along y')
    az_mps2: str = column('specific force along z')


@settings_class
class SampleUnits(SettingsGroup):
    """Units of an IMU; auto: those in the headers of a CSV file, else SI."""

    rate: str = setting('auto', 'unit of the angular rate', choices=('auto', 'rad/s', 'deg/s'))
    force: str = setting('auto', 'unit of the specific force; g is 9.80665 m/s^2',
                         choices=('auto', 'm/s^2', 'g', 'mg'))


@settings_class
class RecordUnits(SampleUnits):
    """Units of a recorded IMU; auto: those in the headers of a CSV file, else SI."""

    time: str = setting('auto', 'unit of the column of time; of a bag without use',
                        choices=('auto', 's', 'ms', 'us', 'ns'))


@settings_class
class StampSettings(SettingsGroup):
    """The stamps of the samples."""

    source: str = setting('auto', 'header: those in the messages, or column t_s; log: when the '
                          'bag logged them; even: the first stamp and then rate_hz; auto: '
                          'header, but log where all stamps are zero',
                          choices=('auto', 'header', 'log', 'even'))
    rate_hz: float = setting(0.0, 'rate of stamps that are made even', 'Hz', 0.0, 1e5)
    on_repeat: str = setting('drop', 'a stamp that is that of the sample before. drop: the sample '
                             'is left out and counted; spread: the samples with it are spread '
                             'evenly up to the next stamp', choices=('drop', 'spread'))

    def check(self):
        """Refuse even stamps without a rate, and a rate without use."""
        if (self.source == 'even') != (self.rate_hz >= 0.01):
            raise ValueError(f'stamps.source is {self.source} and stamps.rate_hz '
                             f'{self.rate_hz:g} Hz; expected a rate of 0.01 Hz or more '
                             'with even stamps, and 0 with others')


@settings_class
class AcceptSettings(SettingsGroup):
    """What is refused or left out unless it is said here that it is meant so."""

    unmeasured: bool = setting(False, 'take rates and accelerations whose covariance begins with '
                               '-1, which says that they are not measured (REP-145)')
    frames: bool = setting(False, 'take a topic whose messages have several frame_ids; the most '
                           'frequent one counts')
    orientations: bool = setting(False, 'take orientations of any length but zero, normalised')


@settings_class
class AcceptNavigated(AcceptSettings):
    """The same, and of what is navigated."""

    zero_fixes: bool = setting(False, 'take fixes at latitude 0, longitude 0')
    zero_readings: str = setting('refuse', 'rates and forces that are exactly zero in turns, as '
                                 'of drivers that send one of both with each message. refuse; '
                                 'fill: they are drawn straight between their neighbours; keep',
                                 choices=('refuse', 'fill', 'keep'))


@settings_class
class ConvertSettings(SettingsGroup):
    """The command convert."""

    columns: ImuColumns = group(ImuColumns)
    units: RecordUnits = group(RecordUnits)
    stamps: StampSettings = group(StampSettings)
    accept: AcceptSettings = group(AcceptSettings)


CONVERT = {'convert': ConvertSettings}
