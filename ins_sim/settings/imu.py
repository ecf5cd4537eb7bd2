"""Settings of the node imu_sensor."""

from .field import group, setting, settings_class, SettingsGroup
from .instrument_errors import AccelerometerErrors, GyroErrors, Sampling, Temperature
from .motion import MotionSettings
from .node import Topics
from .place import Datum, Earth, Frames, Tf
from .tuned_gyro import TunedGyroPairSettings


@settings_class
class DelaysUs(SettingsGroup):
    """Delay of each channel, by FLU axis (the paper's tau1, tau2, tau3 are y, x, z)."""

    x: float = setting(0.0, 'delay of the forward channel', 'us', -1e6, 1e6)
    y: float = setting(0.0, 'delay of the left channel (tau1, right, in the paper)', 'us',
                       -1e6, 1e6)
    z: float = setting(0.0, 'delay of the up channel', 'us', -1e6, 1e6)

    def in_ns(self):
        """Return the delays of the channels x, y, z in nanoseconds."""
        return tuple(round(1000.0 * d) for d in (self.x, self.y, self.z))


@settings_class
class Gyro(SettingsGroup):
    """The gyro triad."""

    model: str = setting('ideal', 'ideal, or dtg: two dynamically tuned gyros (needs output '
                         'integrated)', choices=('ideal', 'dtg'))
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
    """The magnetometer beside the IMU, imu/mag: the World Magnetic Model (extra magnetic)."""

    publish: bool = setting(False, 'publish imu/mag')
    rate_hz: float = setting(50.0, 'its rate, at most that of the truth', 'Hz', 0.01, 20000.0)
    noise_nt: float = setting(100.0, 'noise of a sample, standard deviation, each axis', 'nT',
                              0.0, 1e6)
    year: float = setting(2025.0, 'decimal year of the field, whatever the stamps', 'year',
                          2025.0, 2030.0)


@settings_class
class BarometerSettings(SettingsGroup):
    """The barometer beside the IMU, imu/pressure: the standard atmosphere."""

    publish: bool = setting(False, 'publish imu/pressure')
    rate_hz: float = setting(50.0, 'its rate, at most that of the truth', 'Hz', 0.01, 20000.0)
    noise_pa: float = setting(2.0, 'noise of a sample, standard deviation', 'Pa', 0.0, 1e5)


OUTPUTS = ('rotation_vector', 'integrated')


@settings_class
class ImuSensorSettings(SettingsGroup):
    """Node imu_sensor."""

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
    seed: int = setting(0, 'seed of the random errors: the same seed, the same errors', '', 0,
                        2147483647)
    run: int = setting(0, 'number of the run in an ensemble: each draws other random errors', '',
                       0, 2147483647)
    rate_hz: float = setting(100.0, 'rate of the IMU', 'Hz', 0.01, 20000.0)
    source: str = setting('stream', 'where the motion comes from: the streamed truth, or the '
                          'closed form or recording of motion.* (the stream then only paces)',
                          choices=('stream', 'motion'))
    output: str = setting('rotation_vector', 'rotation_vector: mean of the finite rotation and of '
                          'the inertially rotated velocity increment; integrated: plain '
                          'integrals of rate and specific force', choices=OUTPUTS)
    history: str = setting('analytic', 'motion before the first instant: continued backwards '
                           '(analytic) or held (frozen). A stream is continued by the straight '
                           'line through rate and force of its first two samples for 50 ms, and '
                           'by constant ones before', choices=('analytic', 'frozen'))
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew (reset) or end the node (stop)', choices=('reset', 'stop'))

    def check(self):
        """Refuse tuned gyros without the output that they have."""
        if self.gyro.model == 'dtg' and self.output != 'integrated':
            raise ValueError(f'output is {self.output} with gyro.model dtg; expected integrated: '
                             'a tuned gyro reads the integral of its rate')
