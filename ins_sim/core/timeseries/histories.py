"""Records: frozen structures of arrays, used for a single sample, a history or an ensemble."""

from dataclasses import dataclass, fields

import numpy as np

# Number of rows read, joined or compared together, for histories that need not fit in memory.
BLOCK = 8192


class History:
    """Slicing and joining along the leading (time) axis; fields that are None stay None."""

    def __len__(self):
        return len(self.t_ns)

    def __getitem__(self, index):
        return type(self)(**{name: value[index] for name, value in self.arrays().items()})

    def arrays(self):
        """Return {field: array} of the fields that are not None."""
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
    """A history with the fields lat, lon, height, v_n and q_nb."""

    def one(self, k):
        """Return lat, lon, height, v_n, q_nb of one instant as floats and tuples of floats."""
        return (float(self.lat[k]), float(self.lon[k]), float(self.height[k]),
                tuple(self.v_n[k].tolist()), tuple(self.q_nb[k].tolist()))


@dataclass(frozen=True, eq=False)
class Truth(PlacedHistory):
    """
    True motion at n instants.

    Attributes
    ----------
    t_ns : (n,) int64 motion times, ns
    lat, lon, height : (n,) rad, rad, m above the ellipsoid
    v_n : (n, 3) velocity East, North, Up, m/s
    q_nb : (n, 4) attitude quaternion
    omega_ib_b : (n, 3) angular rate of the body in inertial space, rad/s
    f_ib_b : (n, 3) specific force, m/s^2
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
    Mean readings over the intervals (t - dt, t] that end at the stamps.

    Attributes
    ----------
    t_ns : (n,) int64 stamps, ns
    omega, f : (n, 3) increments of the output mode divided by dt, rad/s and m/s^2 (see
        ``core.sensors.imu.ideal``)
    parity : (n,) parity of a pair of tuned gyros, rad/s; otherwise None
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
    """
    A navigation solution at n instants.

    Attributes
    ----------
    t_ns : (n,) int64, ns
    lat, lon, height : (n,) rad, rad, m
    v_n : (n, 3) velocity East, North, Up, m/s
    q_nb : (n, 4) attitude quaternion
    """

    t_ns: np.ndarray
    lat: np.ndarray
    lon: np.ndarray
    height: np.ndarray
    v_n: np.ndarray
    q_nb: np.ndarray


@dataclass(frozen=True, eq=False)
class NavErrors(History):
    """
    Errors of a solution (solution minus truth), resolved in n, at n instants.

    Attributes
    ----------
    t_ns : (n,) int64, ns
    attitude : (n, 3) rotation vector of the *inertial* attitude error, rad
    velocity, position : (n, 3) m/s and m
    drift : (n, 3) least-squares slope of the accumulated attitude error since the start, rad/s
    """

    t_ns: np.ndarray
    attitude: np.ndarray
    velocity: np.ndarray
    position: np.ndarray
    drift: np.ndarray


@dataclass(frozen=True, eq=False)
class AidedErrors(History):
    """
    Errors of an aided solution (solution minus truth), resolved in n, and the filter's estimates.

    Attributes
    ----------
    t_ns : (n,) int64, ns
    attitude : (n, 3) rotation vector, q_nb = exp(attitude) q_nb_true, rad
    velocity, position : (n, 3) m/s and m
    attitude_sigma, velocity_sigma, position_sigma : (n, 3) standard deviations by the filter; NaN
        if it has none
    estimates : (n, 3) mounting error mu (rad), kx and kz of the velocity meter; 0 if not estimated
    estimates_sigma : (n, 3) their standard deviations; NaN if the filter has none
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
    How a guided motion is steered, at n instants.

    Attributes
    ----------
    t_ns : (n,) int64, ns
    z, v_z : (n,) offset to the right of the track, m, and its rate, m/s
    beta : (n,) sideslip in the air, positive if the track is to the right of the nose, rad
    command : (n,) commanded sideslip, rad
    """

    t_ns: np.ndarray
    z: np.ndarray
    v_z: np.ndarray
    beta: np.ndarray
    command: np.ndarray


@dataclass(frozen=True, eq=False)
class SteeringEstimates(History):
    """
    Inputs and commands of an autopilot at its control instants.

    Attributes
    ----------
    t_ns : (n,) int64, ns
    z, v_z : (n,) estimated offset, m, and its rate, m/s; zero without a solution
    command : (n,) sideslip to be reached at the end of the next control period, rad
    steers : (n,) bool, whether the autopilot gave the command; otherwise the vehicle flew straight
    """

    t_ns: np.ndarray
    z: np.ndarray
    v_z: np.ndarray
    command: np.ndarray
    steers: np.ndarray
