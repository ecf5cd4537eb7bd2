"""The sensor_msgs/Imu messages of a topic of a bag, whoever wrote them."""

import numpy as np

from ins_sim.core.postprocessing.imu_record import RecordedImu


def read_imu_messages(bag, topic):
    """
    Return RecordedImu, frame id and notes (sentences) of a topic, in the order recorded.

    Stamps that are all zero give way to the log times.  Raises ValueError where there is no
    message, more than one frame, or no rate or acceleration (REP-145).
    """
    name = f'{bag.path}: {topic}'
    table = bag.arrays(topic)
    if not len(table):
        raise ValueError(f'{name} is empty; expected messages')
    if (table['angular_velocity_covariance'][:, 0] == -1.0).any() or (
            table['linear_acceleration_covariance'][:, 0] == -1.0).any():
        raise ValueError(f'{name} says by a covariance of -1 that it has no rate or no '
                         'acceleration (REP-145); expected both')
    frames = [texts[0] for texts in bag.frames(topic)]
    if len(frames) > 1:
        raise ValueError(f'{name} has the frames {", ".join(map(repr, frames[:4]))}; expected one '
                         'IMU on a topic')
    t_ns, notes = table['stamp_ns'], []
    if not t_ns.any():
        t_ns = table['log_ns']
        notes.append('the stamps of the IMU are all zero: the times of logging are used')
    # copies: the rest of the messages need not stay
    imu = RecordedImu(t_ns.copy(), table['angular_velocity'].copy(),
                      table['linear_acceleration'].copy(), _orientation(table))
    return imu, frames[0].lstrip('/'), notes


def _orientation(table):
    """Return unit quaternions (n, 4), NaN where the message has none."""
    q = table['orientation'].copy()
    norm = np.linalg.norm(q, axis=1)
    known = (table['orientation_covariance'][:, 0] != -1.0) & (np.abs(norm - 1.0) < 0.01)
    q[~known] = np.nan
    q[known] /= norm[known, None]
    return q
