"""Settings of the guided motion: the vehicle that is steered and the autopilot that steers it."""

from collections import namedtuple

from .field import group, setting, settings_class, SettingsGroup

# An autopilot, with the location of its class as 'module:class'.
AutopilotEntry = namedtuple('AutopilotEntry', 'location')
_FOLDER = 'ins_sim.core.guidance'
# The table of autopilots. Classes are named by text and imported when one is created, so that
# settings import only the standard library.
AUTOPILOTS = {
    'lateral': AutopilotEntry(f'{_FOLDER}.lateral:LateralAutopilot'),
    'hold_course': AutopilotEntry(f'{_FOLDER}.lateral:CourseHold'),
}


# Odometry topics of strapdown and aided_navigator.
INS_SOLUTION, AIDED_SOLUTION = 'ins/odometry', 'aided/odometry'


@settings_class
class GuidedSettings(SettingsGroup):
    """Vehicle of motion.kind guided: flies along motion.route, steered by sideslip."""

    offset_m: float = setting(100.0, 'Offset of the vehicle to the right of the first leg at the '
                              'start', 'm', -1e4, 1e4)
    offset_rate_m_s: float = setting(0.0, 'Rate of that offset at the start', 'm/s', -100.0, 100.0)
    side_force_m_s2_rad: float = setting(20.0, 'Lateral acceleration for each radian of sideslip '
                                         'relative to the air', 'm/s^2/rad', 0.1, 1000.0)
    lag_s: float = setting(0.4, 'Time constant with which the sideslip follows the command', 's',
                           0.01, 100.0)
    control_rate_hz: float = setting(100.0, 'Rate of the commands; between two control instants '
                                     'the command is interpolated linearly', 'Hz', 0.1, 1000.0)


@settings_class
class Lateral(SettingsGroup):
    """Gains of lateral and hold_course: command = k1 offset + k2 rate (estimates)."""

    offset_gain_rad_m: float = setting(0.0125, 'Gain k1 of the autopilot lateral: commanded '
                                       'sideslip for each metre of offset from the leg', 'rad/m',
                                       0.0, 10.0)
    rate_gain_rad_s_m: float = setting(0.04, 'Gain k2 of both autopilots: commanded sideslip for '
                                       'each m/s of the rate of the offset', 'rad s/m', 0.0, 10.0)


@settings_class
class GuidanceSettings(SettingsGroup):
    """Autopilot that steers a motion of kind guided, using the navigation solution."""

    autopilot: str = setting('lateral', 'Steering law. lateral: return to the leg; hold_course: '
                             'fly parallel to the leg at any offset', choices=AUTOPILOTS)
    lateral: Lateral = group(Lateral)
    limit_deg: float = setting(8.0, 'Largest commanded sideslip', 'deg', 0.0, 30.0)
    engage_after_s: float = setting(0.0, 'Time from the start of the run at which the autopilot '
                                    'engages; until then the vehicle flies straight', 's', 0.0,
                                    1e7)
    latency_s: float = setting(0.0, 'Age of the navigation solution that the autopilot uses', 's',
                               0.0, 10.0)
    timeout_s: float = setting(1.0, 'Time by which the solution may be older than latency_s '
                               'before the vehicle flies straight', 's', 0.0, 1e4)
    jump_m: float = setting(1000.0, 'Largest change of the offset between two solutions that the '
                            'autopilot follows. After a larger one it flies straight until the '
                            'new solutions have lasted for timeout_s', 'm', 1.0, 1e6)
    topic: str = setting(AIDED_SOLUTION, 'Topic of the nav_msgs/Odometry that the autopilot uses: '
                         'aided/odometry of aided_navigator, ins/odometry of strapdown or, in a '
                         'live run, the topic of your own estimator (pose in map, twist in '
                         'base_link)')

    def in_ns(self):
        """Return latency and timeout in nanoseconds."""
        return round(1e9 * self.latency_s), round(1e9 * self.timeout_s)


def check_control_rate(guided, node, rate_hz):
    """Raise ValueError unless a node at rate_hz has a sample at every control instant."""
    if round(1e9 / guided.control_rate_hz) % round(1e9 / rate_hz):
        raise ValueError(f'motion_generator: motion.guided.control_rate_hz is '
                         f'{guided.control_rate_hz:g} Hz; expected rate_hz of {node}, '
                         f'{rate_hz:g} Hz, divided by a whole number, so that every control '
                         'instant has a sample')


def check_guided(generator, sensor, lead_ns):
    """
    Raise ValueError if the loop of navigation and guidance cannot be closed.

    Parameters
    ----------
    generator : MotionGeneratorSettings
    sensor : ImuSensorSettings
    lead_ns : time by which a channel with negative delay reads ahead, ns
    """
    guided, latency_s = generator.motion.guided, generator.guidance.latency_s
    control_ns = round(1e9 / guided.control_rate_hz)
    check_control_rate(guided, 'motion_generator', generator.rate_hz)
    check_control_rate(guided, 'imu_sensor', sensor.rate_hz)
    for key in ('jitter_us', 'latency_us'):
        value = getattr(sensor.sampling, key)
        if value:
            raise ValueError(f'imu_sensor: sampling.{key} is {value:g} us; expected 0 with '
                             'motion.kind guided, whose autopilot needs the solution at exact '
                             'control instants')
    least_s = (lead_ns + control_ns) * 1e-9
    if lead_ns and round(1e9 * latency_s) < lead_ns + control_ns:
        raise ValueError(f'motion_generator: guidance.latency_s is {latency_s:g} s with a channel '
                         f'of imu_sensor that reads {lead_ns * 1e-9:g} s ahead; expected at least '
                         f'{least_s:g} s, one control period more, because a guided motion is '
                         'known only one period ahead')
