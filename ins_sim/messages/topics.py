"""Table of all topics with names, types and frames.  ROS is not imported."""

from dataclasses import dataclass, replace
from math import nan

from .cdr import Reader, Writer

IMU = 'sensor_msgs/msg/Imu'
ODOMETRY = 'nav_msgs/msg/Odometry'
FIX = 'sensor_msgs/msg/NavSatFix'
MAGNETIC = 'sensor_msgs/msg/MagneticField'
PRESSURE = 'sensor_msgs/msg/FluidPressure'
VECTOR = 'geometry_msgs/msg/Vector3Stamped'
QUATERNION = 'geometry_msgs/msg/QuaternionStamped'
HEADER = 'std_msgs/msg/Header'
CLOCK = 'rosgraph_msgs/msg/Clock'
STRING = 'std_msgs/msg/String'
TWIST = 'geometry_msgs/msg/TwistWithCovarianceStamped'
DIAGNOSTICS = 'diagnostic_msgs/msg/DiagnosticArray'
TRANSFORMS = 'tf2_msgs/msg/TFMessage'

# Variance of unmeasured or unknown quantities, m^2, rad^2, (m/s)^2 or (rad/s)^2.
UNMEASURED = 1e9
# Variances of the truth, for 1 mm, 1 mm/s, 0.1 mrad, 1 urad/s and 10 um/s^2. They are not zero,
# because filters divide by them or take zero as unknown.  An error-free IMU has the last two.
TRUE_PLACE, TRUE_VELOCITY, TRUE_ATTITUDE, TRUE_RATE, TRUE_FORCE = 1e-6, 1e-6, 1e-8, 1e-12, 1e-10
# Variances of an error-free magnetometer and barometer, for 1 nT and 0.01 Pa.
TRUE_FIELD, TRUE_PRESSURE = 1e-18, 1e-4


@dataclass(frozen=True)
class Topic:
    """
    A topic.

    Attributes
    ----------
    name : relative name, or absolute if ROS requires it
    type_name : message type
    frames : frame ids by their default names, which ``named`` replaces by those of a vehicle
    constants : pairs (index, value) of doubles that are the same in all messages
    runs : slices (start, stop) of the doubles that each message sets; None: those of the type
    numbers : integers of a NavSatFix, see Writer
    latched : whether a late subscriber gets the last message
    """

    name: str
    type_name: str
    frames: tuple = ()
    constants: tuple = ()
    runs: tuple | None = None
    numbers: tuple = (0, 0, 0)
    latched: bool = False

    def named(self, names):
        """Return this topic with the frame ids of a vehicle; names is {default name: name}."""
        return replace(self, frames=tuple(names.get(frame, frame) for frame in self.frames))

    def writer(self):
        """Return the Writer of its messages."""
        return Writer(self.type_name, *self.frames, runs=self.runs,
                      constants=dict(self.constants), numbers=self.numbers)

    def reader(self, runs=None):
        """Return a Reader of its messages, by default of the same runs as the writer."""
        return Reader(self.type_name, self.writer().runs if runs is None else runs)


def _diagonal(first, size, *variances):
    """Return the constants of a diagonal covariance (size x size), three of each variance."""
    return tuple((first + k * (size + 1), variances[k // 3]) for k in range(size))


TRUTH_IMU = Topic('truth/imu', IMU, ('imu_link',),
                  _diagonal(4, 3, TRUE_ATTITUDE) + _diagonal(16, 3, TRUE_RATE)
                  + _diagonal(28, 3, TRUE_FORCE))
TRUTH_ODOMETRY = Topic('truth/odometry', ODOMETRY, ('map', 'base_link'),
                       _diagonal(7, 6, TRUE_PLACE, TRUE_ATTITUDE)
                       + _diagonal(49, 6, TRUE_VELOCITY, TRUE_RATE))
TRUTH_ATTITUDE = Topic('truth/attitude', QUATERNION, ('enu',))
# With a known diagonal covariance.
TRUTH_FIX = Topic('truth/fix', FIX, ('base_link',), _diagonal(3, 3, TRUE_PLACE),
                  numbers=(0, 0, 2))
# Unmeasured orientation: identity, with -1 as first element of its covariance (REP-145).
IMU_RAW = Topic('imu/data_raw', IMU, ('imu_link',), ((3, 1.0), (4, -1.0)), ((13, 16), (25, 28)))
# x: parity of the sample, y: its mean over the last window, z: threshold of the mean; rad/s.
IMU_PARITY = Topic('imu/parity', VECTOR, ('imu_link',))
# Content of imu/data_raw with the orientation of the INS (REP-145).
IMU_DATA = Topic('imu/data', IMU, ('imu_link',), (), ((0, 4), (4, 13), (13, 16), (25, 28)))
# Field in b, T; static pressure, Pa.
IMU_MAG = Topic('imu/mag', MAGNETIC, ('imu_link',))
IMU_PRESSURE = Topic('imu/pressure', PRESSURE, ('imu_link',))
# Pose and twist, each followed by its covariance.
_WITH_COVARIANCE = ((0, 7), (7, 43), (43, 49), (49, 85))
# Free INS solution in odom, continuous but drifting (REP-105).
INS_ODOMETRY = Topic('ins/odometry', ODOMETRY, ('odom', 'base_link'), (), _WITH_COVARIANCE)
# With a known covariance.
INS_FIX = Topic('ins/fix', FIX, ('base_link',), (), ((0, 3), (3, 12)), (0, 0, 3))
# Components East, North, Up at the vehicle, although the frame id is map: the axes of map are
# East, North, Up at the datum, turned against these by the angle between both places.
ERROR_ATTITUDE = Topic('ins/error/attitude', VECTOR, ('map',))
ERROR_VELOCITY = Topic('ins/error/velocity', VECTOR, ('map',))
ERROR_POSITION = Topic('ins/error/position', VECTOR, ('map',))
ERROR_DRIFT = Topic('ins/error/drift', VECTOR, ('map',))
# Complete fix, see velocity_record; stamped at the end of its window.
METER_RECORD = Topic('velocity_meter/record', DIAGNOSTICS, ('velocity_meter_link',))
# Stamped at the middle of the window; the up component and the rate are not measured.
_NO_RATE = ((27, UNMEASURED), (34, UNMEASURED), (41, UNMEASURED))
METER_VELOCITY = Topic('velocity_meter/velocity', TWIST, ('velocity_meter_link',),
                       ((20, UNMEASURED), *_NO_RATE), ((0, 3), (6, 7), (13, 14)))
# Service GPS, with a known diagonal covariance.
GNSS_FIX = Topic('gnss/fix', FIX, ('gnss_link',), (), ((0, 3), (3, 4), (7, 8), (11, 12)),
                 (0, 1, 2))
# Without a position the values are NaN, as in ROS drivers.
GNSS_NO_FIX = replace(GNSS_FIX, constants=tuple((k, nan) for k in range(3)), runs=(),
                      numbers=(-1, 1, 0))
GNSS_VELOCITY = Topic('gnss/velocity', TWIST, ('enu',), _NO_RATE,
                      ((0, 3), (6, 7), (13, 14), (20, 21)))
AIDED_ODOMETRY = Topic('aided/odometry', ODOMETRY, ('map', 'base_link'), (), _WITH_COVARIANCE)
# With a known diagonal covariance, or unknown for filters without covariance.
AIDED_FIX = Topic('aided/fix', FIX, ('base_link',), (), GNSS_FIX.runs, (0, 0, 2))
AIDED_FIX_ALONE = replace(AIDED_FIX, numbers=(0, 0, 0))
# Solution minus truth, and three standard deviations of the filter.
AIDED_ERRORS = tuple(Topic(f'aided/error/{name}', VECTOR, ('map',))
                     for name in ('attitude', 'velocity', 'position'))
AIDED_SIGMAS = tuple(Topic(f'aided/sigma/{name}', VECTOR, ('map',))
                     for name in ('attitude', 'velocity', 'position'))
# x: along the leg, y: height, z: to the right of the leg; m.
AIDED_ORTHODROME = Topic('aided/orthodrome', VECTOR, ('leg',))
# At a control instant. x: commanded sideslip, rad; y and z: estimated offset to the right of the
# leg, m, and its rate, m/s, zero without an estimate.
GUIDANCE_COMMAND = Topic('guidance/command', VECTOR, ('leg',))
# Odometry of another simulator for truth_adapter, in any frames.
OTHER_ODOMETRY = Topic('odom', ODOMETRY, ('odom', 'base_link'))
ACK = Topic('sim/ack', HEADER)
STATUS = Topic('sim/status', STRING, latched=True)
# Announcement of the run, see run_announcement.
RUN = Topic('sim/run', DIAGNOSTICS, latched=True)
CLOCK_TOPIC = Topic('/clock', CLOCK)
# See ``transforms``.
TF = Topic('/tf', TRANSFORMS)
TF_STATIC = Topic('/tf_static', TRANSFORMS, latched=True)

ERRORS = (ERROR_ATTITUDE, ERROR_VELOCITY, ERROR_POSITION, ERROR_DRIFT)
TRUTH = (TRUTH_ODOMETRY, TRUTH_ATTITUDE, TRUTH_FIX, TRUTH_IMU)
DATA = (*TRUTH, IMU_RAW, INS_ODOMETRY, INS_FIX, *ERRORS)
# Topics that are published on request, or with tuned gyros.
BESIDE = (IMU_DATA, IMU_MAG, IMU_PRESSURE, IMU_PARITY)
# Topics of velocity_meter, gnss and aided_navigator.
AIDING = (METER_RECORD, METER_VELOCITY, GNSS_FIX, GNSS_VELOCITY, AIDED_ODOMETRY, AIDED_FIX,
          *AIDED_ERRORS, *AIDED_SIGMAS, AIDED_ORTHODROME)
# Topics of motion_generator with a guided motion.
GUIDANCE = (GUIDANCE_COMMAND,)
# Topics that may have no message at the first sample, or none at all.
SELDOM = (METER_RECORD, METER_VELOCITY, GNSS_FIX, GNSS_VELOCITY, *AIDED_SIGMAS, *GUIDANCE)


def imu_raw(rate_variance, force_variance, topic=IMU_RAW):
    """
    Return IMU_RAW, or IMU_DATA, with the given variances by axis, (rad/s)^2 and (m/s^2)^2.

    Variances are at least those of the truth.
    """
    variances = (*(max(v, TRUE_RATE) for v in rate_variance),
                 *(max(v, TRUE_FORCE) for v in force_variance))
    return replace(topic, constants=(*topic.constants, *zip((16, 20, 24, 28, 32, 36), variances)))


def with_variance(topic, variance):
    """Return IMU_MAG or IMU_PRESSURE with the variance of each number, T^2 or Pa^2, not zero."""
    if topic is IMU_PRESSURE:
        return replace(topic, constants=((1, max(variance, TRUE_PRESSURE)),))
    return replace(topic, constants=_diagonal(3, 3, max(variance, TRUE_FIELD)))
