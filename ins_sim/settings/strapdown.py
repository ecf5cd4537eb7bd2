"""Settings of the node strapdown."""

from .field import group, setting, settings_class, SettingsGroup
from .imu import OUTPUTS
from .node import Topics
from .place import Datum, Earth, Frames, Tf


@settings_class
class Vertical(SettingsGroup):
    """The vertical channel."""

    channel: str = setting('truth', 'height and vertical velocity from truth, free, or damped '
                           'towards the height of the truth', choices=('truth', 'free', 'damped'))
    time_constant_s: float = setting(20.0, 'time constant of the damped channel', 's', 0.1, 1e4)


@settings_class
class Initial(SettingsGroup):
    """Initial errors, added to the truth, resolved in East, North, Up."""

    after_s: float = setting(0.0, 'start this long after the first IMU sample', 's', 0.0, 1e6)
    attitude_error_deg: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'rotation vector of the '
                                                    'attitude error', 'deg', -180.0, 180.0, size=3)
    velocity_error_m_s: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'velocity error', 'm/s',
                                                    -1e4, 1e4, size=3)
    position_error_m: tuple[float, ...] = setting((0.0, 0.0, 0.0), 'position error', 'm', -1e6,
                                                  1e6, size=3)


@settings_class
class StrapdownSettings(SettingsGroup):
    """Node strapdown."""

    datum: Datum = group(Datum)
    earth: Earth = group(Earth)
    frames: Frames = group(Frames)
    tf: Tf = group(Tf)
    vertical: Vertical = group(Vertical)
    initial: Initial = group(Initial)
    topics: Topics = group(Topics)
    rate_hz: float = setting(100.0, 'rate of the IMU', 'Hz', 0.01, 20000.0)
    input: str = setting('rotation_vector', 'what the IMU sends (imu_sensor: output)',
                         choices=OUTPUTS)
    orientation: str = setting('quaternion', 'attitude algorithm: quaternion (exact), or by RK4 '
                               'the matrix of Poisson\'s equation or the Euler vector',
                               choices=('quaternion', 'poisson', 'euler_vector'))
    imu_time: str = setting('stamp', 'instant of a reading: its stamp, or the nearest multiple of '
                            'the period in motion time (nominal; for jitter and latency)',
                            choices=('stamp', 'nominal'))
    imu_latency_us: float = setting(0.0, 'known latency of the stamps, taken off before the '
                                    'nominal instant is found', 'us', -1e6, 1e6)
    output_every: int = setting(1, 'publish every n-th step', 'steps', 1, 1000000)
    on_fault: str = setting('reset', 'after a gap, a backwards stamp or a bad message: start '
                            'anew from truth (reset) or end the node (stop)',
                            choices=('reset', 'stop'))
