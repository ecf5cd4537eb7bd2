"""Records: frozen structs of arrays, one class for a sample, a history and an ensemble."""

from dataclasses import dataclass, fields

import numpy as np

# Rows that are read, joined or compared at once where a history need not be in memory.
BLOCK = 8192


class History:
    """Slicing and joining along the leading (time) axis; a field that is None stays None."""

    def __len__(self):
        return len(self.t_ns)

    def __getitem__(self, index):
        return type(self)(**{name: value[index] for name, value in self.arrays().items()})

    def arrays(self):
        """Return {field: array} of the fields that are there."""
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        return {name: value for name, value in values.items() if value is not None}

    def blocks(self, length=BLOCK):
        """Yield the history in blocks of consecutive rows."""
        for first in range(0, len(self), length):
            yield self[first:first + length]

    @classmethod
    def concatenate(cls, parts):
        """Join histories in the order given."""
        parts = [part.arrays() for part in parts]
        return cls(**{name: np.concatenate([part[name] for part in parts]) for name in parts[0]})


class PlacedHistory(History):
    """A history with lat, lon, height, v_n and q_nb."""

    def one(self, k):
        """Return lat, lon, height, v_n, q_nb of one instant as floats and tuples of floats."""
        return (float(self.lat[k]), float(self.lon[k]), float(self.height[k]),
                tuple(self.v_n[k].tolist()), tuple(self.q_nb[k].tolist()))


@dataclass(frozen=True, eq=False)
class Truth(PlacedHistory):
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
class ImuSamples(History):
    """
    Mean reading over the interval (t - dt, t] that ends at the stamp.

    t_ns (n,) int64; omega (n, 3) rad/s and f (n, 3) m/s^2: the increments of the output mode
    divided by dt (see ``core.sensors.imu.ideal``).  parity (n,) rad/s: of a pair of tuned gyros,
    else None.
    """

    t_ns: np.ndarray
    omega: np.ndarray
    f: np.ndarray
    parity: np.ndarray | None = None

    @classmethod
    def of_readings(cls, t_ns, readings):
        """Return the record of instants t_ns (n,) and a list of (omega, f, parity or None)."""
        omega, f, parity = zip(*readings)
        return cls(np.asarray(t_ns, dtype=np.int64), np.array(omega), np.array(f),
                   None if parity[0] is None else np.array(parity))


@dataclass(frozen=True, eq=False)
class NavStates(PlacedHistory):
    """Solution: t_ns (n,); lat, lon (n,) rad; height (n,) m; v_n (n, 3) m/s; q_nb (n, 4)."""

    t_ns: np.ndarray
    lat: np.ndarray
    lon: np.ndarray
    height: np.ndarray
    v_n: np.ndarray
    q_nb: np.ndarray


@dataclass(frozen=True, eq=False)
class NavErrors(History):
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


@dataclass(frozen=True, eq=False)
class AidedErrors(History):
    """
    Errors of an aided solution, solution less truth, resolved in n, and what the filter thinks.

    t_ns (n,); attitude: rotation vector, q_nb = exp(attitude) q_nb_true, rad; velocity m/s;
    position m; the three sigmas: standard deviations by the filter, all NaN where it has none;
    estimates: mounting mu (rad), kx, kz of the velocity meter, and their standard deviations,
    NaN too where there is none.  Each (n, 3).
    """

    t_ns: np.ndarray
    attitude: np.ndarray
    velocity: np.ndarray
    position: np.ndarray
    attitude_sigma: np.ndarray
    velocity_sigma: np.ndarray
    position_sigma: np.ndarray
    estimates: np.ndarray
    estimates_sigma: np.ndarray


@dataclass(frozen=True, eq=False)
class SteeredStates(History):
    """
    How a guided motion is steered, at instants.

    t_ns (n,) int64; z (n,) m, offset to the right of the track; v_z (n,) m/s, its rate; beta (n,)
    rad, sideslip in the air, positive with the track to the right of the nose; command (n,) rad,
    the commanded sideslip.
    """

    t_ns: np.ndarray
    z: np.ndarray
    v_z: np.ndarray
    beta: np.ndarray
    command: np.ndarray


@dataclass(frozen=True, eq=False)
class SteeringEstimates(History):
    """
    What an autopilot saw and commanded, at the control instants.

    t_ns (n,) int64; z (n,) m and v_z (n,) m/s, estimated, zero without a solution; command (n,)
    rad, the sideslip to be flown at the end of the next control period; steers (n,) bool: whether
    the autopilot commanded it, or the vehicle flew straight.
    """

    t_ns: np.ndarray
    z: np.ndarray
    v_z: np.ndarray
    command: np.ndarray
    steers: np.ndarray
