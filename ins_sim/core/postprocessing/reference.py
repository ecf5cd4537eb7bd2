"""References for a solution: position, velocity and attitude, each with its own stamps."""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import to_compass
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation.errors import position_error

# Values are interpolated between two stamps that are no further apart than this.
LONGEST_STEP_S = 5.0


@dataclass(frozen=True, eq=False)
class SampledTrack:
    """Values (n, k) at increasing stamps t_ns (n,) int64."""

    t_ns: np.ndarray
    values: np.ndarray

    def at(self, t_ns):
        """
        Return the values at stamps (m,), linearly interpolated, (m, k).

        NaN before the first and after the last stamp, and if the neighbours are more than
        LONGEST_STEP_S apart.
        """
        t_ns = np.asarray(t_ns, dtype=np.int64)
        after = np.clip(np.searchsorted(self.t_ns, t_ns), 1, max(1, len(self.t_ns) - 1))
        if len(self.t_ns) < 2:
            return np.where((t_ns == self.t_ns[0])[:, None], self.values[:1], np.nan)
        step = self.t_ns[after] - self.t_ns[after - 1]
        part = ((t_ns - self.t_ns[after - 1]) / step)[:, None]
        value = (1.0 - part) * self.values[after - 1] + part * self.values[after]
        held = (part[:, 0] >= 0.0) & (part[:, 0] <= 1.0) & (step <= LONGEST_STEP_S * 1e9)
        # At a stamp of the track the value is exact, however far the neighbours are.
        held |= (part[:, 0] == 0.0) | (part[:, 0] == 1.0)
        return np.where(held[:, None], value, np.nan)

    def near(self, t_ns):
        """Return the value at a stamp, or the nearest within LONGEST_STEP_S, (k,), or NaN."""
        p = self.at([t_ns])[0]
        if np.isnan(p).any():
            j = int(np.argmin(np.abs(self.t_ns - t_ns)))
            if abs(int(self.t_ns[j]) - t_ns) <= LONGEST_STEP_S * 1e9:
                return self.values[j]
        return p


@dataclass(frozen=True, eq=False)
class Reference:
    """
    A reference in n; each track may be None.

    Attributes
    ----------
    name : name of the reference
    position : SampledTrack of lat, lon (rad, unwrapped) and height (m)
    velocity : SampledTrack of v_n, m/s
    attitude : SampledTrack of q_nb with continuous signs

    """

    name: str
    position: SampledTrack | None = None
    velocity: SampledTrack | None = None
    attitude: SampledTrack | None = None

    def velocity_at(self, t_ns):
        """Return v_n at stamps, (m, 3), NaN if unknown."""
        if self.velocity is None:
            return np.full((len(t_ns), 3), np.nan)
        return self.velocity.at(t_ns)

    def attitude_at(self, t_ns):
        """Return q_nb at one stamp as a tuple, or None."""
        if self.attitude is None:
            return None
        q = self.attitude.at([t_ns])[0]
        x, y, z, w = q.tolist()
        size = math.sqrt(x * x + y * y + z * z + w * w)
        return None if np.isnan(q).any() else (x / size, y / size, z / size, w / size)

    def displacements(self):
        """
        Return the displacements between stamps: t_ns (m,) of the middles; east, north (m, 2), m.

        They are computed from the velocity if there is one, otherwise from the position; None if
        there is neither.
        """
        if self.velocity is not None and len(self.velocity.t_ns) > 1:
            t_ns, v = self.velocity.t_ns, self.velocity.values[:, :2]
            dt = np.diff(t_ns)[:, None] * 1e-9
            way = 0.5 * dt * (v[1:] + v[:-1])
        elif self.position is not None and len(self.position.t_ns) > 1:
            t_ns, p = self.position.t_ns, self.position.values
            way = np.array([position_error(*b, *a)[:2] for a, b in zip(p.tolist(),
                                                                       p[1:].tolist())])
        else:
            return None
        return (t_ns[1:] + t_ns[:-1]) // 2, way


@dataclass(frozen=True, eq=False)
class OdometryReference:
    """
    Poses in a frame of unknown place and heading, with z up.

    Attributes
    ----------
    name : name of the topic or file
    frame : name of the frame
    t_ns : (n,) stamps
    r : (n, 3) positions in the frame, m
    q : (n, 4) quaternions from b to the frame, with continuous signs
    v_b : (n, 3) velocities in b, m/s

    """

    name: str
    frame: str
    t_ns: np.ndarray
    r: np.ndarray
    q: np.ndarray
    v_b: np.ndarray

    def velocity_b(self):
        """Return the SampledTrack of v_b."""
        return SampledTrack(self.t_ns, self.v_b)

    def as_enu(self):
        """Return a Reference without position; the frame is assumed to be east, north, up."""
        v = quaternion.rotate(self.q.T, self.v_b.T)
        return Reference(self.name, velocity=SampledTrack(self.t_ns, np.stack(v, axis=-1)),
                         attitude=SampledTrack(self.t_ns, self.q))

    def aligned_to(self, t_ns, lat, lon, height, q_nb):
        """
        Return the Reference with place and heading of the solution at t_ns; None if unknown then.

        The frame is rotated about the vertical by the difference of the headings, and its plane is
        tangent there: at the distance d the height is too large by d^2 / 2R.
        """
        own = self.as_enu().attitude_at(t_ns)
        if own is None:
            return None
        origin = SampledTrack(self.t_ns, self.r).at([t_ns])[0]
        headings = to_compass(np.array([own, q_nb]))[2]
        turn = quaternion.exponential((0.0, 0.0, float(headings[0] - headings[1])))
        r = quaternion.rotate(turn, (self.r - origin).T)
        position = ellipsoid.moved(lat, lon, height, r)
        q = quaternion.multiply(turn, tuple(self.q.T))
        v = quaternion.rotate(q, self.v_b.T)
        tracks = (SampledTrack(self.t_ns, np.stack(x, axis=-1)) for x in (position, v, q))
        return Reference(f'{self.name} laid on the start', *tracks)


def keep_rising(t_ns, *arrays):
    """Return stamps and arrays ordered by stamp, without repeated stamps and NaN."""
    good = np.all([np.isfinite(a).all(axis=1) for a in arrays], axis=0)
    t_ns, first = np.unique(t_ns[good], return_index=True)
    return t_ns, *(a[good][first] for a in arrays)
