"""Records: frozen structs of arrays, one class for a sample, a history and an ensemble."""

from dataclasses import dataclass, fields

import numpy as np


class Record:
    """Slicing and joining along the leading (time) axis, for every record class."""

    def __len__(self):
        return len(self.t_ns)

    def __getitem__(self, index):
        return type(self)(**{f.name: getattr(self, f.name)[index] for f in fields(self)})

    @classmethod
    def concatenate(cls, parts):
        """Join histories in the order given."""
        parts = list(parts)
        return cls(**{f.name: np.concatenate([getattr(p, f.name) for p in parts])
                      for f in fields(cls)})


@dataclass(frozen=True, eq=False)
class Truth(Record):
    """
    True motion at instants.

    t_ns (n,) int64; lat, lon (n,) rad; height (n,) m above the ellipsoid; v_n (n, 3) m/s;
    q_nb (n, 4); omega_ib_b (n, 3) rad/s; f_ib_b (n, 3) m/s^2.
    """

    t_ns: np.ndarray
    lat: np.ndarray
    lon: np.ndarray
    height: np.ndarray
    v_n: np.ndarray
    q_nb: np.ndarray
    omega_ib_b: np.ndarray
    f_ib_b: np.ndarray


@dataclass(frozen=True, eq=False)
class ImuSamples(Record):
    """
    Mean reading over the interval (t - dt, t] that ends at the stamp.

    t_ns (n,) int64; omega (n, 3) rad/s and f (n, 3) m/s^2: the increments of the output mode
    divided by dt (see ``ins_sim.core.imu``).
    """

    t_ns: np.ndarray
    omega: np.ndarray
    f: np.ndarray


@dataclass(frozen=True, eq=False)
class NavStates(Record):
    """Solution: t_ns (n,); lat, lon (n,) rad; height (n,) m; v_n (n, 3) m/s; q_nb (n, 4)."""

    t_ns: np.ndarray
    lat: np.ndarray
    lon: np.ndarray
    height: np.ndarray
    v_n: np.ndarray
    q_nb: np.ndarray


@dataclass(frozen=True, eq=False)
class NavErrors(Record):
    """
    Solution less truth, resolved in n: t_ns (n,) and four (n, 3) arrays.

    attitude: rotation vector of the *inertial* attitude error, rad; velocity m/s; position m;
    drift: least-squares slope of the accumulated attitude error since the start, rad/s.
    """

    t_ns: np.ndarray
    attitude: np.ndarray
    velocity: np.ndarray
    position: np.ndarray
    drift: np.ndarray
