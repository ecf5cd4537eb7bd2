"""Errors of the navigation with a recorded IMU, at the stamps of a reference."""

from dataclasses import dataclass
import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.navigation.errors import position_error
from .reference import SampledTrack

# Times after the start at which errors are reported, s.
AFTER_S = (10.0, 30.0, 60.0)


@dataclass(frozen=True, eq=False)
class Comparison:
    """
    Solution minus reference, resolved in east, north, up: SampledTracks of (n, 3), or None.

    Attributes
    ----------
    name : name of the reference
    position : position error, m
    velocity : velocity error, m/s
    attitude : rotation vector from the reference to the solution, rad (Up: counter-clockwise)

    """

    name: str
    position: SampledTrack | None
    velocity: SampledTrack | None
    attitude: SampledTrack | None


@dataclass(frozen=True)
class ErrorRow:
    """
    Errors at some time after the start, None if unknown.

    Attributes
    ----------
    after_s : time after the start, s
    horizontal_m : length of the horizontal position error, m
    vertical_m : height error, positive up, m
    speed_m_s : length of the horizontal velocity error, m/s
    tilt_deg : angle between the true and the estimated vertical, deg
    heading_deg : heading error, positive clockwise, deg

    """

    after_s: float
    horizontal_m: float | None
    vertical_m: float | None
    speed_m_s: float | None
    tilt_deg: float | None
    heading_deg: float | None


def compare_with_reference(states, reference):
    """
    Return the Comparison of NavStates, one for each segment, with a Reference, or None.

    Between its samples the solution is interpolated linearly, its attitude with a constant
    rotation rate. None is returned if the reference has no stamp within a segment.
    """
    tracks = []
    for kind, errors in (('position', _position), ('velocity', _velocity),
                         ('attitude', _attitude)):
        track = getattr(reference, kind)
        parts = [] if track is None else [_within(s, track, errors) for s in states]
        parts = [p for p in parts if len(p.t_ns)]
        tracks.append(SampledTrack(np.concatenate([p.t_ns for p in parts]),
                                   np.concatenate([p.values for p in parts])) if parts else None)
    return None if tracks == [None] * 3 else Comparison(reference.name, *tracks)


def _within(states, track, errors):
    inside = (track.t_ns >= states.t_ns[0]) & (track.t_ns <= states.t_ns[-1])
    t_ns, values = track.t_ns[inside], track.values[inside]
    if len(states.t_ns) < 2 or not len(t_ns):
        return SampledTrack(t_ns[:0], np.empty((0, 3)))
    return SampledTrack(t_ns, errors(states, t_ns, values))


def _position(states, t_ns, values):
    own = SampledTrack(states.t_ns, np.stack(
        [states.lat, np.unwrap(states.lon), states.height], -1))
    return np.array([position_error(*a, *b) for a, b in zip(_drawn(own, t_ns).tolist(),
                                                            values.tolist())])


def _velocity(states, t_ns, values):
    return _drawn(SampledTrack(states.t_ns, states.v_n), t_ns) - values


def _attitude(states, t_ns, values):
    k = np.clip(np.searchsorted(states.t_ns, t_ns), 1, len(states) - 1)
    start = states.t_ns[k - 1]
    part = (t_ns - start) / (states.t_ns[k] - start)
    found = []
    for u, a, b, q in zip(part.tolist(), states.q_nb[k - 1].tolist(), states.q_nb[k].tolist(),
                          values.tolist()):
        x, y, z = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(a), b))
        own = quaternion.multiply(a, quaternion.exponential((u * x, u * y, u * z)))
        found.append(quaternion.logarithm(quaternion.multiply(own, quaternion.conjugate(q))))
    return np.array(found)


def _drawn(track, t_ns):
    """Return the values at stamps within the track, interpolated over steps of any length."""
    start = track.t_ns[0]
    return np.stack([np.interp(t_ns - start, track.t_ns - start, v) for v in track.values.T], -1)


def error_rows(comparison, start_ns, end_ns):
    """Return the ErrorRows AFTER_S after the start, while there is a solution, and at its end."""
    length_s = (end_ns - start_ns) * 1e-9
    return [_row(comparison, start_ns, after) for after in
            (*(a for a in AFTER_S if a < length_s), length_s)]


def _row(comparison, start_ns, after_s):
    """Return the errors at the stamp nearest to an instant, within one second."""
    def at(track):
        if track is None:
            return None
        off = np.abs(track.t_ns - (start_ns + round(after_s * 1e9)))
        k = int(np.argmin(off))
        return track.values[k].tolist() if off[k] <= 1_000_000_000 else None

    place, v, turn = (at(t) for t in (comparison.position, comparison.velocity,
                                      comparison.attitude))
    return ErrorRow(
        after_s, place and _level(place), place and place[2], v and _level(v),
        turn and math.degrees(_level(turn)), turn and -math.degrees(turn[2]))


def _level(vector):
    return math.sqrt(vector[0] * vector[0] + vector[1] * vector[1])
