"""What the messages of each topic contain, with units, for the reference pages."""

from . import topics

_ENU = 'in East, North, Up at the vehicle'
_VARIANCE = 'A variance of 1e9 means: not measured or not known.'
# Topics that every node has, or that come from other packages.
DIAGNOSTICS = topics.Topic('/diagnostics', topics.DIAGNOSTICS)

CONTENTS = {
    topics.TRUTH_ODOMETRY: (
        'True position (m) and attitude in map, true velocity (m/s) and angular rate relative to '
        'map (rad/s) in base_link. The covariances state 1 mm, 0.1 mrad, 1 mm/s and 1 urad/s.'),
    topics.TRUTH_ATTITUDE: (
        'True attitude: the quaternion (x, y, z, w) from base_link to East, North, Up at the '
        'vehicle. It differs from truth/odometry by the angle between vehicle and datum.'),
    topics.TRUTH_FIX: 'True latitude and longitude (deg) and height above the ellipsoid (m).',
    topics.TRUTH_IMU: (
        'Output of a perfect IMU: inertial angular rate (rad/s) and specific force (m/s^2) at the '
        'stamp, with the true attitude in map.'),
    topics.IMU_RAW: (
        'Reading of the simulated IMU: angular rate (rad/s) and specific force (m/s^2), means '
        'over the interval that ends at the stamp (parameter output of imu_sensor). The '
        'covariances hold the noise of the instrument; there is no orientation, as REP-145 '
        'defines by -1 at the head of its covariance.'),
    topics.IMU_DATA: (
        'The reading of imu/data_raw with the orientation of the INS in map and its covariance '
        '(rad^2).'),
    topics.IMU_MAG: 'Magnetic field in body axes (T), from the World Magnetic Model, with noise.',
    topics.IMU_PRESSURE: 'Static pressure of the standard atmosphere (Pa), with noise.',
    topics.IMU_PARITY: (
        'Test of a pair of tuned gyros for faults. x: parity of the reading; y: mean parity of '
        'the last window; z: its threshold. All in rad/s.'),
    topics.INS_ODOMETRY: (
        'Solution of the strapdown: position (m) and attitude in odom, velocity (m/s) and angular '
        'rate (rad/s) in base_link, with covariances propagated from the initial errors and the '
        'errors of the instrument. Continuous, but drifting, as REP-105 requires of odom.'),
    topics.INS_FIX: (
        'Position of the strapdown: latitude and longitude (deg), height above the ellipsoid (m), '
        'with its covariance (m^2).'),
    topics.ERROR_ATTITUDE: (
        f'Attitude error of the strapdown: rotation vector, solution relative to truth, {_ENU} '
        '(rad).'),
    topics.ERROR_VELOCITY: f'Velocity of the strapdown minus true velocity, {_ENU} (m/s).',
    topics.ERROR_POSITION: f'Position of the strapdown minus true position, {_ENU} (m).',
    topics.ERROR_DRIFT: (
        'Drift of the strapdown: least-squares slope of the accumulated attitude error since the '
        f'start, {_ENU} (rad/s).'),
    topics.METER_RECORD: (
        'Every window of the velocity meter, valid or not: begin and end (ns), velocity forward '
        'and left (m/s) with standard deviations, delays of the correlation maxima (s), and the '
        'status. Stamped at the end of the window.'),
    topics.METER_VELOCITY: (
        'Mean velocity forward and left (m/s) of each valid window, stamped at its middle. '
        f'{_VARIANCE}'),
    topics.GNSS_FIX: (
        'Position of the antenna: latitude and longitude (deg), height above the ellipsoid (m), '
        'with variances (m^2). During an outage the status is -1 and the position is NaN.'),
    topics.GNSS_VELOCITY: (
        'Velocity of the antenna in East, North, Up (m/s) with variances, for each valid fix. '
        f'{_VARIANCE}'),
    topics.AIDED_ODOMETRY: (
        'Aided solution: position (m) and attitude in map, velocity (m/s) and angular rate '
        f'(rad/s) in base_link, with the covariances of the filter. {_VARIANCE}'),
    topics.AIDED_FIX: (
        'Position of the aided solution: latitude and longitude (deg), height above the ellipsoid '
        '(m), with variances (m^2) if the filter has them.'),
    topics.AIDED_ERRORS[0]: (
        f'Attitude error of the aided solution: rotation vector, {_ENU} (rad).'),
    topics.AIDED_ERRORS[1]: f'Velocity of the aided solution minus true velocity, {_ENU} (m/s).',
    topics.AIDED_ERRORS[2]: f'Position of the aided solution minus true position, {_ENU} (m).',
    topics.AIDED_SIGMAS[0]: f'Three standard deviations of the attitude by the filter, {_ENU} '
                            '(rad).',
    topics.AIDED_SIGMAS[1]: f'Three standard deviations of the velocity by the filter, {_ENU} '
                            '(m/s).',
    topics.AIDED_SIGMAS[2]: f'Three standard deviations of the position by the filter, {_ENU} '
                            '(m).',
    topics.AIDED_ORTHODROME: (
        'Position of the aided solution relative to the great-circle leg. x: distance along the '
        'leg; y: height; z: offset to the right of the leg. All in m.'),
    topics.GUIDANCE_COMMAND: (
        'Command of the autopilot. x: commanded sideslip (rad); y: estimated offset to the right '
        'of the leg (m); z: its rate (m/s). y and z are zero without an estimate.'),
    topics.OTHER_ODOMETRY: (
        'Input of truth_adapter: pose and twist of a vehicle in another simulator (m, m/s, '
        'rad/s), in frames of any name.'),
    topics.ACK: (
        'Acknowledgement of lock-step: the stamp up to which a node has processed its input; '
        'frame_id is the name of the node.'),
    topics.STATUS: 'State of the run: running, paused or finished.',
    topics.RUN: (
        'Announcement of the run: epoch, first and last motion time (ns) and rate (Hz). A '
        'subscriber that joins later also gets it.'),
    topics.CLOCK_TOPIC: 'Simulation time, about 100 times a second, for use_sim_time.',
    topics.TF: 'Transforms of the vehicle, as set by tf.source.',
    topics.TF_STATIC: 'Fixed transforms: mounting of the instruments, and map to odom if the '
                      'strapdown alone places the vehicle.',
    DIAGNOSTICS: 'State, counters and last fault of each node, once a second of wall time.',
}
