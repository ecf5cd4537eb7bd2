"""Settings of the node imu_sensor."""

from .field import group, setting, settings_class, SettingsGroup
from .instrument_errors import AccelerometerErrors, GyroErrors, Sampling, Temperature
from .motion import MotionSettings
from .node import Topics
from .place import Datum, Earth, Frames, Tf
from .tuned_gyro import TunedGyroPairSettings


@settings_class
class DelaysUs(SettingsGroup):
    """
    Delay of each channel, by FLU axis.

    The delays tau1, tau2, tau3 of Bogdanov and Fomichev 2018 are those of y, x, z.
    """

    x: float = setting(0.0, 'Delay of the forward channel', 'us', -1e6, 1e6)
    y: float = setting(0.0, 'Delay of the left channel (tau1, to the right, in Bogdanov and '
                       'Fomichev 2018)', 'us', -1e6, 1e6)
    z: float = setting(0.0, 'Delay of the up channel', 'us', -1e6, 1e6)

    def in_ns(self):
        """Return the delays of the channels x, y, z in nanoseconds."""
        return tuple(round(1000.0 * d) for d in (self.x, self.y, self.z))


@settings_class
class Gyro(SettingsGroup):
    """The gyro triad."""

    model: str = setting('ideal', 'Model of the gyros. ideal: rate integration with gyro.errors; '
                         'dtg: two dynamically tuned gyros, which need output integrated',
                         choices=('ideal', 'dtg'))
    dtg: TunedGyroPairSettings = group(TunedGyroPairSettings)
    delay_us: DelaysUs = group(DelaysUs)
    errors: GyroErrors = group(GyroErrors)


@settings_class
class Accelerometer(SettingsGroup):
    """The accelerometer triad."""

    delay_us: DelaysUs = group(DelaysUs)
    errors: AccelerometerErrors = group(AccelerometerErrors)


@settings_class
class MagnetometerSettings(SettingsGroup):
    """Magnetometer on imu/mag (World Magnetic Model; pip extra ``magnetic``)."""

    publish: bool = setting(False, 'Whether the magnetometer publishes imu/mag')
    rate_hz: float = setting(50.0, 'Rate of the magnetometer, at most the rate of the truth',
                             'Hz', 0.01, 20000.0)
    noise_nt: float = setting(100.0, 'Standard deviation of the noise of a sample, each axis',
                              'nT', 0.0, 1e6)
    year: float = setting(2025.0, 'Decimal year for which the field is computed; the time stamps '
                          'are not used for it', 'year', 2025.0, 2030.0)


@settings_class
class BarometerSettings(SettingsGroup):
    """Barometer on imu/pressure: standard atmosphere."""

    publish: bool = setting(False, 'Whether the barometer publishes imu/pressure')
    rate_hz: float = setting(50.0, 'Rate of the barometer, at most the rate of the truth', 'Hz',
                             0.01, 20000.0)
    noise_pa: float = setting(2.0, 'Standard deviation of the noise of a sample', 'Pa', 0.0, 1e5)


OUTPUTS = ('rotation_vector', 'integrated')


@settings_class
class ImuSensorSettings(SettingsGroup):
    """Settings of the node imu_sensor."""

    SETTABLE = ('gyro.errors.bias_deg_h', 'accelerometer.errors.bias_ug', 'gyro.dtg.fault.channel',
                'gyro.dtg.fault.bias_deg_h', 'gyro.dtg.fault.scale', 'gyro.dtg.fault.start_s',
                'gyro.dtg.fault.end_s', 'sampling.drop_out_probability')
    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    motion: MotionSettings = group(MotionSettings)
    gyro: Gyro = group(Gyro)
    accelerometer: Accelerometer = group(Accelerometer)
    magnetometer: MagnetometerSettings = group(MagnetometerSettings)
    barometer: BarometerSettings = group(BarometerSettings)
    temperature: Temperature = group(Temperature)
    sampling: Sampling = group(Sampling)
    topics: Topics = group(Topics)
    seed: int = setting(0, 'Seed of the random errors; the same seed gives the same errors', '', 0,
                        2147483647)
    run: int = setting(0, 'Number of the run in a Monte Carlo ensemble; each number gives other '
                       'random errors', '', 0, 2147483647)
    rate_hz: float = setting(100.0, 'Rate of the IMU', 'Hz', 0.01, 20000.0)
    source: str = setting('stream', 'Source of the motion. stream: the truth messages; motion: '
                          'the closed form or recording given by motion.*, the truth messages '
                          'then only set the pace', choices=('stream', 'motion'))
    output: str = setting('rotation_vector', 'Meaning of a sample. rotation_vector: rotation '
                          'vector of the sampling period, and velocity increment in the body axes '
                          'at its start, both divided by the period; integrated: plain integrals '
                          'of angular rate and specific force in the moving body axes, divided by '
                          'the period', choices=OUTPUTS)
    history: str = setting('analytic', 'Motion before the first instant, which delayed channels '
                           'need: continued backward (analytic) or held (frozen). Streamed truth '
                           'is continued backward by 50 ms with rate and specific force '
                           'extrapolated linearly from its first two samples, and is constant '
                           'before that', choices=('analytic', 'frozen'))
    on_fault: str = setting('reset', 'What the node does after a gap, a backward time stamp or an '
                            'invalid message: start anew (reset) or end (stop)',
                            choices=('reset', 'stop'))

    def check(self):
        """Raise ValueError if tuned gyros are set with an output other than integrated."""
        if self.gyro.model == 'dtg' and self.output != 'integrated':
            raise ValueError(f'output is {self.output} with gyro.model dtg; expected integrated, '
                             'because the readings of a tuned gyro are integrals of the angular '
                             'rate')
