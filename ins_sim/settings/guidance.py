"""Settings of the steering: the vehicle that takes commands, and the autopilot that gives them."""

from collections import namedtuple

from .field import group, setting, settings_class, SettingsGroup

# An autopilot: where its class is, 'module:class'.
AutopilotEntry = namedtuple('AutopilotEntry', 'location')
_FOLDER = 'ins_sim.core.guidance'
# The one table of the autopilots. Classes are named by text and imported when one is made,
# because settings need nothing but Python.
AUTOPILOTS = {
    'lateral': AutopilotEntry(f'{_FOLDER}.lateral:LateralAutopilot'),
    'hold_course': AutopilotEntry(f'{_FOLDER}.lateral:CourseHold'),
}


# The Odometry of strapdown and of aided_navigator.
INS_SOLUTION, AIDED_SOLUTION = 'ins/odometry', 'aided/odometry'


@settings_class
class GuidedSettings(SettingsGroup):
    """The vehicle of kind guided: beside the legs of motion.route, steered by its sideslip."""

    offset_m: float = setting(100.0, 'offset to the right of the first leg at the start', 'm',
                              -1e4, 1e4)
    offset_rate_m_s: float = setting(0.0, 'its rate', 'm/s', -100.0, 100.0)
    side_force_m_s2_rad: float = setting(20.0, 'acceleration to the side of the nose, for each '
                                         'rad of sideslip in the air', 'm/s^2/rad', 0.1, 1000.0)
    lag_s: float = setting(0.4, 'time constant with which the sideslip follows the command', 's',
                           0.01, 100.0)
    control_rate_hz: float = setting(100.0, 'rate of the commands; between two the command runs '
                                     'linearly', 'Hz', 0.1, 1000.0)


@settings_class
class Lateral(SettingsGroup):
    """Autopilots lateral and hold_course: command = k1 offset + k2 its rate, both estimated."""

    offset_gain_rad_m: float = setting(0.0125, 'k1: sideslip for each metre of offset (lateral)',
                                       'rad/m', 0.0, 10.0)
    rate_gain_rad_s_m: float = setting(0.04, 'k2: sideslip for each m/s of its rate', 'rad s/m',
                                       0.0, 10.0)


@settings_class
class GuidanceSettings(SettingsGroup):
    """The autopilot that steers a motion of kind guided by the navigation solution."""

    autopilot: str = setting('lateral', 'lateral: back to the leg; hold_course: along it, at '
                             'whatever offset', choices=AUTOPILOTS)
    lateral: Lateral = group(Lateral)
    limit_deg: float = setting(8.0, 'largest commanded sideslip', 'deg', 0.0, 30.0)
    engage_after_s: float = setting(0.0, 'engaged this long after the start of the run; until '
                                    'then it flies straight', 's', 0.0, 1e7)
    latency_s: float = setting(0.0, 'age of the solution that it uses', 's', 0.0, 10.0)
    timeout_s: float = setting(1.0, 'how much older than latency_s a solution may become before '
                               'the vehicle flies straight', 's', 0.0, 1e4)
    jump_m: float = setting(1000.0, 'a solution whose offset jumps by more is not steered by, '
                            'until it has gone on for timeout_s', 'm', 1.0, 1e6)
    topic: str = setting(AIDED_SOLUTION, 'the nav_msgs/Odometry that steers: of aided_navigator, '
                         'ins/odometry of strapdown, or, live, one of an estimator of your own, '
                         'its pose in map and its twist in base_link')

    def in_ns(self):
        """Return latency and timeout, ns."""
        return round(1e9 * self.latency_s), round(1e9 * self.timeout_s)


def check_control_rate(guided, node, rate_hz):
    """Raise ValueError unless every control instant has a sample of a node at rate_hz."""
    if round(1e9 / guided.control_rate_hz) % round(1e9 / rate_hz):
        raise ValueError(f'motion_generator: motion.guided.control_rate_hz is '
                         f'{guided.control_rate_hz:g} Hz; expected a whole part of rate_hz of '
                         f'{node}, {rate_hz:g} Hz: a control instant needs its sample')


def check_guided(generator, sensor, lead_ns):
    """
    Raise ValueError, in one sentence, where a loop cannot be closed.

    generator: MotionGeneratorSettings; sensor: ImuSensorSettings; lead_ns: how far a channel of
    negative delay reads ahead, ns.
    """
    guided, latency_s = generator.motion.guided, generator.guidance.latency_s
    control_ns = round(1e9 / guided.control_rate_hz)
    check_control_rate(guided, 'motion_generator', generator.rate_hz)
    check_control_rate(guided, 'imu_sensor', sensor.rate_hz)
    for key in ('jitter_us', 'latency_us'):
        value = getattr(sensor.sampling, key)
        if value:
            raise ValueError(f'imu_sensor: sampling.{key} is {value:g} us; expected 0 with '
                             'motion.kind guided, which is steered by the solution of an instant')
    least_s = (lead_ns + control_ns) * 1e-9
    if lead_ns and round(1e9 * latency_s) < lead_ns + control_ns:
        raise ValueError(f'motion_generator: guidance.latency_s is {latency_s:g} s with a channel '
                         f'of imu_sensor that reads {lead_ns * 1e-9:g} s ahead; expected at least '
                         f'{least_s:g} s, a control period more: a guided motion is known one '
                         'period ahead')
