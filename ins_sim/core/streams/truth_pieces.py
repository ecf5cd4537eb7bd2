"""
Blocks of streamed truth as arrays, for offline runs.

The computations of ``TruthBuffer`` for many samples together, with the same bits: the piece of the
curve between each two samples, and its value at many instants.
"""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.interpolation import (hermite_coefficients, newton_differences,
                                                 newton_value)
from ins_sim.core.attitude.rotation_vectors import exponentials


@dataclass(frozen=True)
class TruthPieces:
    """
    The m pieces of a curve between consecutive truth samples, as arrays (m,).

    Attributes
    ----------
    start_ns, end_ns : motion times, ns
    q : attitude q_mb at the start, four arrays
    per_step : reciprocal of the length, 1/ns
    curve : ``hermite_coefficients`` of the attitude
    cubics : for each field, ``newton_differences`` at the end
    times : stamps of the last three samples at the end, ns
    """

    start_ns: np.ndarray
    end_ns: np.ndarray
    q: tuple
    per_step: np.ndarray
    curve: tuple
    cubics: dict
    times: tuple

    @classmethod
    def of_tuples(cls, pieces):
        """Return the pieces from a list of tuples, the form in which ``TruthBuffer`` has them."""
        start_ns, end_ns, q, per_step, curve, cubics, times = zip(*pieces)
        columns = {field: _columns([cubic[field] for cubic in cubics]) for field in cubics[0]}
        return cls(np.array(start_ns), np.array(end_ns), _columns(q), np.array(per_step),
                   _columns(curve), columns, _columns(times))

    def tuples(self, first):
        """Return the pieces from index ``first`` as tuples, the form of ``TruthBuffer``."""
        return [(int(self.start_ns[k]), int(self.end_ns[k]), _row(self.q, k),
                 float(self.per_step[k]), _row(self.curve, k),
                 {field: list(_row(cubic, k)) for field, cubic in self.cubics.items()},
                 tuple(int(t[k]) for t in self.times))
                for k in range(first, len(self.start_ns))]

    def behind(self, other):
        """Return another TruthPieces followed by this one."""
        return TruthPieces(*(_joined(getattr(other, name), getattr(self, name))
                             for name in self.__dataclass_fields__))

    def attitude(self, t_ns, piece):
        """Return q_mb, four arrays, at t_ns in the pieces with these indices."""
        s = (t_ns - self.start_ns[piece]) * self.per_step[piece]
        r = tuple(s * (a[piece] + s * (b[piece] + s * c[piece])) for a, b, c in zip(*self.curve))
        return quaternion.multiply(tuple(x[piece] for x in self.q), exponentials(r))

    def cubic(self, t_ns, piece, field):
        """Return a field, three arrays, at t_ns in the pieces with these indices."""
        differences = [[x[piece] for x in d] for d in self.cubics[field]]
        return newton_value(differences, *((t_ns - t[piece]) * 1e-9 for t in self.times))


class TruthBlock:
    """
    A block of new samples that gives the motion as ``TruthBuffer`` did when each sample came.

    Parameters
    ----------
    pieces : TruthPieces; those from index ``new`` on end at the new samples
    new : index of the first new piece
    before : BeforeTruth of the stream
    reach_ns : see TruthBuffer
    """

    def __init__(self, pieces, new, before, reach_ns):
        self.pieces = pieces
        self._new, self._before, self._reach_ns = new, before, reach_ns

    def attitude(self, t_ns, newest):
        """Return q_mb (n, 4) at t_ns (n,), with new sample ``newest`` (n,) as the last known."""
        q = np.stack(self.pieces.attitude(t_ns, self._piece(t_ns, newest)), axis=-1)
        first_ns, q_first = self._before.first[:2]
        q[t_ns == first_ns] = q_first
        before = np.flatnonzero(t_ns < first_ns)
        if len(before):
            q[before] = self._before.attitudes(t_ns[before])
        return q

    def cubic(self, t_ns, newest, field):
        """Return a field (3, n) at t_ns (n,), with new sample ``newest`` (n,) as the last."""
        values = np.array(self.pieces.cubic(t_ns, self._piece(t_ns, newest), field))
        before = np.flatnonzero(t_ns <= self._before.first[0])
        if len(before):
            for row, value in zip(values, self._before.value(t_ns[before], field)):
                row[before] = value
        return values

    def _piece(self, t_ns, newest):
        pieces, last = self.pieces, self._new + newest
        # Pieces that the buffer had already dropped at that time are excluded.
        first = np.searchsorted(pieces.end_ns, pieces.end_ns[last] - self._reach_ns)
        found = np.searchsorted(pieces.start_ns, t_ns, side='right') - 1
        return np.minimum(np.maximum(found, first), last)


def pieces_of_samples(t_ns, q_mb, omega_mb_b, fields, differences):
    """
    Return the TruthPieces that end at the samples from the fourth on.

    Parameters
    ----------
    t_ns : (n + 3,) motion times of three known samples and n new ones, ns
    q_mb, omega_mb_b : attitude and rate (rad/s) of the same samples, components as arrays
    fields : {field: values of the new samples, three arrays}
    differences : {field: ``newton_differences`` at the last known sample}
    """
    steps = t_ns[3:] - t_ns[2:-1]
    back = [1e9 / (t_ns[3:] - t_ns[k:-3 + k]) for k in (2, 1, 0)]
    start, end = tuple(x[2:-1] for x in q_mb), tuple(x[3:] for x in q_mb)
    turned = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(start), end))
    curve = hermite_coefficients(steps * 1e-9, turned, tuple(x[2:-1] for x in omega_mb_b),
                                 tuple(x[3:] for x in omega_mb_b))
    cubics = {field: _differences(differences[field], values, back)
              for field, values in fields.items()}
    return TruthPieces(t_ns[2:-1], t_ns[3:], start, 1.0 / steps, curve, cubics,
                       (t_ns[3:], t_ns[2:-1], t_ns[1:-2]))


def _differences(last, values, back):
    """Return ``newton_differences`` of consecutive samples; each order needs the one below it."""
    found = [values]
    for before, r in zip(last, back):
        # Values of the preceding samples: the known one, then those just found.
        shifted = [np.concatenate([[a], x[:-1]]) for a, x in zip(before, found[-1])]
        found.append(newton_differences([shifted], found[-1], r, 0.0, 0.0)[1])
    return found


def _columns(rows):
    """Return equally nested tuples of numbers as nested tuples of arrays."""
    if isinstance(rows[0], (tuple, list)):
        return tuple(_columns(column) for column in zip(*rows))
    return np.array(rows)


def _row(columns, k):
    """Return entry k of nested tuples of arrays as nested tuples of floats."""
    if isinstance(columns, (tuple, list)):
        return tuple(_row(column, k) for column in columns)
    return float(columns[k])


def _joined(first, second):
    """Return nested tuples, or dicts, of arrays joined end to end."""
    if isinstance(first, dict):
        return {key: _joined(first[key], second[key]) for key in first}
    if isinstance(first, (tuple, list)):
        return tuple(_joined(a, b) for a, b in zip(first, second))
    return np.concatenate([first, second])
