"""Bags for the tests of navigate, written by rosbags instead of the package's own writers."""

import numpy as np
import pytest

rosbag2 = pytest.importorskip('rosbags.rosbag2')
typesys = pytest.importorskip('rosbags.typesys')
StoragePlugin, Writer = rosbag2.StoragePlugin, rosbag2.Writer
STORE = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
TYPES = STORE.types


def message(name, **values):
    """Return a message of a type such as 'sensor_msgs/msg/Imu'."""
    return TYPES[name](**values)


def header(t_ns, frame):
    """Return a Header."""
    sec, nanosec = divmod(int(t_ns), 1_000_000_000)
    return message('std_msgs/msg/Header', frame_id=frame, stamp=message(
        'builtin_interfaces/msg/Time', sec=sec, nanosec=nanosec))


def vector(v):
    """Return a Vector3."""
    return message('geometry_msgs/msg/Vector3', **dict(zip('xyz', map(float, v))))


def quaternion(q):
    """Return a Quaternion."""
    return message('geometry_msgs/msg/Quaternion', **dict(zip('xyzw', map(float, q))))


def imu_messages(t_ns, omega, f, frame='imu_link', q=None, stamps=None):
    """Return [(log time, Imu)]; without q the orientation is marked as unknown (REP-145)."""
    out = []
    for k, t in enumerate(t_ns):
        unknown = np.zeros(9)
        unknown[0] = -1.0
        out.append((int(t), message(
            'sensor_msgs/msg/Imu', header=header(t if stamps is None else stamps[k], frame),
            orientation=quaternion((0, 0, 0, 1) if q is None else q[k]),
            orientation_covariance=unknown if q is None else np.zeros(9),
            angular_velocity=vector(omega[k]), angular_velocity_covariance=np.zeros(9),
            linear_acceleration=vector(f[k]), linear_acceleration_covariance=np.zeros(9))))
    return out


def fix_messages(t_ns, lat, lon, height, status=0):
    """Return [(log time, NavSatFix)] from latitude and longitude in rad, height in m."""
    out = []
    for t, a, b, c in zip(t_ns, lat, lon, height):
        out.append((int(t), message(
            'sensor_msgs/msg/NavSatFix', header=header(t, 'gnss_link'),
            status=message('sensor_msgs/msg/NavSatStatus', status=status, service=1),
            latitude=float(np.degrees(a)), longitude=float(np.degrees(b)), altitude=float(c),
            position_covariance=np.zeros(9), position_covariance_type=0)))
    return out


def twist_messages(t_ns, v_n):
    """Return [(log time, TwistStamped)]."""
    return [(int(t), message(
        'geometry_msgs/msg/TwistStamped', header=header(t, 'enu'),
        twist=message('geometry_msgs/msg/Twist', linear=vector(v), angular=vector((0, 0, 0)))))
        for t, v in zip(t_ns, v_n)]


def covariance_twist_messages(t_ns, v_n):
    """Return [(log time, TwistWithCovarianceStamped)]."""
    out = []
    for t, v in zip(t_ns, v_n):
        twist = message('geometry_msgs/msg/Twist', linear=vector(v), angular=vector((0, 0, 0)))
        out.append((int(t), message(
            'geometry_msgs/msg/TwistWithCovarianceStamped', header=header(t, 'enu'),
            twist=message('geometry_msgs/msg/TwistWithCovariance', twist=twist,
                          covariance=np.zeros(36)))))
    return out


def odometry_messages(t_ns, r, q, v_b):
    """Return [(log time, Odometry)]."""
    out = []
    for t, p, o, v in zip(t_ns, r, q, v_b):
        point = message('geometry_msgs/msg/Point', **dict(zip('xyz', map(float, p))))
        pose = message('geometry_msgs/msg/Pose', position=point, orientation=quaternion(o))
        twist = message('geometry_msgs/msg/Twist', linear=vector(v), angular=vector((0, 0, 0)))
        out.append((int(t), message(
            'nav_msgs/msg/Odometry', header=header(t, 'odom'), child_frame_id='base_link',
            pose=message('geometry_msgs/msg/PoseWithCovariance', pose=pose,
                         covariance=np.zeros(36)),
            twist=message('geometry_msgs/msg/TwistWithCovariance', twist=twist,
                          covariance=np.zeros(36)))))
    return out


def tf_messages(t_ns, transforms):
    """Return [(log time, TFMessage)] from {(parent, child): q}."""
    return [(int(t_ns), message('tf2_msgs/msg/TFMessage', transforms=[message(
        'geometry_msgs/msg/TransformStamped', header=header(t_ns, parent), child_frame_id=child,
        transform=message('geometry_msgs/msg/Transform', translation=vector((0.1, 0.0, 0.2)),
                          rotation=quaternion(q)))
        for (parent, child), q in transforms.items()]))]


def write_bag(path, topics, storage='mcap'):
    """Write a bag from {(topic, type name): [(log time, message)]} and return its path."""
    with Writer(path, version=9, storage_plugin=StoragePlugin[storage.upper()]) as bag:
        for (name, type_name), messages in topics.items():
            connection = bag.add_connection(name, type_name, typestore=STORE)
            for log_ns, content in messages:
                bag.write(connection, log_ns, STORE.serialize_cdr(content, type_name))
    return path


IMU, FIX, TWIST = 'sensor_msgs/msg/Imu', 'sensor_msgs/msg/NavSatFix', \
    'geometry_msgs/msg/TwistStamped'
COVARIANCE_TWIST = 'geometry_msgs/msg/TwistWithCovarianceStamped'
ODOMETRY, TF = 'nav_msgs/msg/Odometry', 'tf2_msgs/msg/TFMessage'
