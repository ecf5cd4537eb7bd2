"""Recorded poses: the input of a recorded motion, independent of the file format."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.interpolation import continuous_quaternions
from ins_sim.core.earth.rates import rate_of_n


@dataclass(frozen=True, eq=False)
class RecordedPoses:
    """
    Poses in the order of the record, (n,) each.

    path: where they are from; t_ns int64, the recorder's own stamps; lat_deg, lon_deg (unwrapped),
    height_m; q_nb (n, 4), signs continuous; resolution: the rounding step of lat_deg, lon_deg,
    height_m in their units, 0 where there is none; v_n (n, 3) m/s and omega_nb_b (n, 3) rad/s, the
    rate of b relative to n, or None where they were not recorded; notes: what was left out,
    changed or assumed on reading, in sentences.
    """

    path: str
    t_ns: np.ndarray
    lat_deg: np.ndarray
    lon_deg: np.ndarray
    height_m: np.ndarray
    q_nb: np.ndarray
    resolution: tuple[float, float, float] = (0.0, 0.0, 0.0)
    v_n: np.ndarray | None = None
    omega_nb_b: np.ndarray | None = None
    notes: tuple[str, ...] = ()


def poses_of_truth(path, t_ns, lat_deg, lon_deg, height_m, q_nb, v_b, omega_eb_b, notes=()):
    """
    Return the RecordedPoses of truth that was published, with velocity and rate.

    t_ns (n,) int64; lat_deg, lon_deg, height_m (n,); q_nb (n, 4); v_b (n, 3) m/s and omega_eb_b
    (n, 3) rad/s: velocity and rate relative to the Earth, in b; notes: of RecordedPoses.
    """
    q = np.moveaxis(q_nb, -1, 0)
    v_n = np.stack(quaternion.rotate(q, np.moveaxis(v_b, -1, 0)), axis=-1)
    # the rate of n relative to an Earth that, seen from itself, stands still
    turn_n = rate_of_n(np.radians(lat_deg), height_m, v_n, earth_rotation=False)
    turn_b = np.stack(quaternion.rotate_back(q, np.moveaxis(turn_n, -1, 0)), axis=-1)
    return RecordedPoses(path, t_ns, lat_deg, np.unwrap(lon_deg, period=360.0), height_m,
                         continuous_quaternions(q_nb), v_n=v_n, omega_nb_b=omega_eb_b - turn_b,
                         notes=notes)
