"""Recorded poses: the input of a recorded motion, independent of the file format."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.interpolation import continuous_quaternions
from ins_sim.core.earth.rates import rate_of_n


@dataclass(frozen=True, eq=False)
class RecordedPoses:
    """
    Poses in the order of the record; all arrays have n rows.

    Attributes
    ----------
    path : origin of the poses
    t_ns : int64, stamps of the recorder
    lat_deg, lon_deg, height_m : position; the longitude is unwrapped
    q_nb : (n, 4), with continuous signs
    resolution : rounding steps of lat_deg, lon_deg, height_m in their units; 0 for no rounding
    v_n, omega_nb_b : (n, 3) m/s, and rate of b relative to n in rad/s; None if not recorded
    notes : sentences on what was left out, changed or assumed when reading

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
    Return the RecordedPoses of published truth, with velocity and rate.

    Parameters
    ----------
    path : origin of the poses
    t_ns : (n,) int64
    lat_deg, lon_deg, height_m : (n,)
    q_nb : (n, 4)
    v_b, omega_eb_b : (n, 3) velocity (m/s) and rate (rad/s) relative to the Earth, in b
    notes : see RecordedPoses

    """
    q = np.moveaxis(q_nb, -1, 0)
    v_n = np.stack(quaternion.rotate(q, np.moveaxis(v_b, -1, 0)), axis=-1)
    # Transport rate only: the rate of n relative to the Earth.
    turn_n = rate_of_n(np.radians(lat_deg), height_m, v_n, earth_rotation=False)
    turn_b = np.stack(quaternion.rotate_back(q, np.moveaxis(turn_n, -1, 0)), axis=-1)
    return RecordedPoses(path, t_ns, lat_deg, np.unwrap(lon_deg, period=360.0), height_m,
                         continuous_quaternions(q_nb), v_n=v_n, omega_nb_b=omega_eb_b - turn_b,
                         notes=notes)
