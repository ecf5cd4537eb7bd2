"""What an input is worth, from two seconds of it: rate, noise, and whether its twist is right."""

from dataclasses import dataclass
from functools import reduce
import math
from operator import mul

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics.fixed_order import dot, length, total
from .knots import turn_between
from .stencils import MIDDLE, POINTS, weights

# How few knots may be judged.
FEWEST = 16
# Neighbours whose sixth divided difference is looked at: what a polynomial leaves is noise.
NEIGHBOURS = 7
# What poses and twist may differ by before lateness is looked for: m/s, rad/s; and from which
# correlation of neighbours on it is no noise.
DIFFERENT_M_S, DIFFERENT_RAD_S = 1e-3, 2e-4
CORRELATED, SURELY = 0.5, 0.7
# Rms of the vector of the force by the noise of an axis of the input: of velocities times the
# rate, of positions times its square (docs/theory/external_truth.md).
BY_TWIST, BY_POSE = 2.7, 6.5
# A twist that is so much noisier than the poses is left, from this noise of the force on, m/s^2.
NOISIER, NOISY = 2.0, 0.01


@dataclass(frozen=True)
class Fitting:
    """How a twist fits the poses: rms of the difference, m/s or rad/s, and its correlation."""

    rms: float
    correlation: float
    limit: float

    def is_wrong(self, surely=False):
        """Return whether it is late, or another quantity, beyond noise."""
        return self.rms > self.limit and self.correlation > (SURELY if surely else CORRELATED)


@dataclass(frozen=True)
class Judgement:
    """
    What two seconds of the input say.

    sigma_m, sigma_rad, sigma_m_s, sigma_rad_s: noise of position, attitude, velocity and rate by
    axis; spread_m: that of the position as a vector, by the median, which jumps do not spoil;
    in_parent: whether the twist is in the axes of the parent; velocity, rate: Fittings; delay_s of
    the twist, or None where nothing has changed; empty: whether the twist is zero throughout;
    knot_hz: rate of the knots.
    """

    sigma_m: float
    spread_m: float
    sigma_rad: float
    sigma_m_s: float
    sigma_rad_s: float
    in_parent: bool
    velocity: Fitting
    rate: Fitting
    delay_s: float | None
    empty: bool
    knot_hz: float

    def force_noise(self, by_twist):
        """Return what a scheme makes of the noise: rms of the vector of the force, m/s^2."""
        if by_twist:
            return BY_TWIST * self.sigma_m_s * self.knot_hz
        return BY_POSE * self.sigma_m * self.knot_hz * self.knot_hz

    def why_not(self, surely=False):
        """Return why the twist is not to be believed, or ''."""
        for name, fitting, unit in (('velocity', self.velocity, 'm/s'),
                                    ('rate', self.rate, 'rad/s')):
            if fitting.is_wrong(surely):
                return 'it is missing' if self.empty else (
                    f'its {name} is late or wrong, by {fitting.rms:.2g} {unit}')
        noise = self.force_noise(True)
        if not surely and noise > NOISY and noise > NOISIER * self.force_noise(False):
            return 'it is noisier than the poses'
        return ''


def judged(knots, in_parent=None):
    """
    Return the Judgement of consecutive knots, at least FEWEST - 2 Samples.

    in_parent: the axes of the twist where they are known.
    """
    t_ns, r, q, v, w = (np.array(column) for column in zip(*knots))
    step_s = np.diff(t_ns) * 1e-9
    q = tuple(q.T)
    turns = np.stack(turn_between(tuple(x[:-1] for x in q), tuple(x[1:] for x in q)), axis=-1)
    v_child, w_parent = (np.stack(turned(q, tuple(x.T)), axis=-1) for turned, x in (
        (quaternion.rotate, v), (quaternion.rotate_back, w)))
    moved = np.diff(r, axis=0)
    found = {}
    for parent in (False, True) if in_parent is None else (in_parent,):
        v_m, w_b = (v, w_parent) if parent else (v_child, w)
        rho = _difference(t_ns, step_s, moved, v_m)
        coning = np.cross(w_b[:-1], w_b[1:]) * (step_s * step_s / 12.0)[:, None]
        found[parent] = (_fitting(rho, step_s, DIFFERENT_M_S),
                         _fitting(_difference(t_ns, step_s, turns - coning, w_b), step_s,
                                  DIFFERENT_RAD_S), _delay(rho, v_m, None if parent else (q, v)),
                         v_m, w_b)
    parent = in_parent if in_parent is not None else _is_parent(found)
    velocity, rate, delay_s, v_m, w_b = found[parent]
    angles = np.concatenate([np.zeros((1, 3)), np.cumsum(turns, axis=0)])
    noise = _Noise(t_ns)
    return Judgement(
        *noise.of(r), noise.of(angles)[0], min(noise.of(x)[0] for x in (v, v_m)),
        min(noise.of(x)[0] for x in (w, w_b)), parent, velocity, rate, delay_s,
        not (v.any() or w.any()), float(1.0 / np.median(step_s)))


def _difference(t_ns, step_s, changes, rates):
    """Return what changes differ by from the integral of the Hermite curve of their rates."""
    steps = np.diff(t_ns)
    count = len(t_ns) - POINTS + 1
    first = weights([steps[k:k + count] for k in range(POINTS - 1)], MIDDLE)[0]
    slopes = total([first[k][:, None] * (rates[k:k + count] - rates[MIDDLE:MIDDLE + count])
                    for k in range(POINTS) if k != MIDDLE])
    at = slice(MIDDLE, MIDDLE + count - 1)
    h = step_s[at][:, None]
    v0, v1 = rates[at], rates[MIDDLE + 1:MIDDLE + count]
    return changes[at] - 0.5 * h * (v0 + v1) - h * h / 12.0 * (slopes[:-1] - slopes[1:])


def _product(a, b):
    """Return the sum of the products of the elements of two arrays."""
    return dot(a.ravel(), b.ravel())


def _fitting(rho, step_s, limit):
    square = _product(rho, rho)
    rms = math.sqrt(square / len(rho)) / float(np.median(step_s))
    return Fitting(rms, _product(rho[1:], rho[:-1]) / square if square else 0.0, limit)


def _delay(rho, v_m, in_child):
    """
    Return how late the velocities are, s, or None where they do not change.

    in_child: attitudes and velocities in the child, where they are given in its axes: it is there
    that they are late.
    """
    if in_child is None:
        change = np.diff(v_m, axis=0)
    else:
        q, v = in_child
        change = np.stack(quaternion.rotate(tuple(x[:-1] for x in q), tuple(np.diff(
            v, axis=0).T)), axis=-1)
    change = change[MIDDLE:MIDDLE + len(rho)]
    square = _product(change, change)
    return _product(rho, change) / square if square > 1e-12 * len(rho) else None


def _is_parent(found):
    """Return whether the twist is in the axes of the parent, where both have been tried."""
    child, parent = found[False], found[True]
    wrong = [x[0].is_wrong() or x[1].is_wrong() for x in (child, parent)]
    if wrong[0] != wrong[1]:
        return wrong[0]
    return child[0].rms > DIFFERENT_M_S and parent[0].rms < 0.5 * child[0].rms


class _Noise:
    """
    Tells noise from motion by what a polynomial through NEIGHBOURS samples leaves.

    t_ns (n,): instants of the samples.
    """

    def __init__(self, t_ns):
        count = len(t_ns) - NEIGHBOURS + 1
        near = [(t_ns[k:k + count] - t_ns[:count]) * 1e-9 for k in range(NEIGHBOURS)]
        # Divided differences of sixth order, of unit gain for white noise.
        factors = [reduce(mul, [1.0 / (a - b) for b in near if b is not a]) for a in near]
        norm = np.sqrt(total([x * x for x in factors]))
        self._factors = [(x / norm)[:, None] for x in factors]

    def of(self, values):
        """Return the noise of values (n, 3): by axis by the rms, of the vector by the median."""
        count = len(self._factors[0])
        left = total([x * (values[k:k + count] - values[3:3 + count])
                      for k, x in enumerate(self._factors)])
        return (math.sqrt(_product(left, left) / left.size),
                float(np.median(length(left))) / 0.6745)
