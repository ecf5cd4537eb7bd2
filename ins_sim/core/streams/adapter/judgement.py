"""The quality of an input, judged from two seconds: rate, noise, and validity of its twist."""

from dataclasses import dataclass
from functools import reduce
import math
from operator import mul

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics.fixed_order import dot, length, total
from .knots import turn_between
from .stencils import MIDDLE, POINTS, weights

# Smallest number of knots that can be judged.
FEWEST = 16
# Number of neighbours in the sixth divided difference: what a polynomial does not fit is noise.
NEIGHBOURS = 7
# Difference between poses and twist, m/s and rad/s, beyond which the twist may be late, and the
# correlation of neighbouring differences beyond which this is not noise.
DIFFERENT_M_S, DIFFERENT_RAD_S = 1e-3, 2e-4
CORRELATED, SURELY = 0.5, 0.7
# Rms of the force vector per noise of an axis of the input: noise of velocities times the rate of
# the knots, noise of positions times its square (docs/theory/external_truth.md).
BY_TWIST, BY_POSE = 2.7, 6.5
# The twist is not used if its force noise exceeds NOISY, m/s^2, and NOISIER times that of poses.
NOISIER, NOISY = 2.0, 0.01


@dataclass(frozen=True)
class Fitting:
    """How a twist fits the poses: rms of the difference (m/s or rad/s), and its correlation."""

    rms: float
    correlation: float
    limit: float

    def is_wrong(self, surely=False):
        """Return whether the twist is late or wrong, beyond what noise explains."""
        return self.rms > self.limit and self.correlation > (SURELY if surely else CORRELATED)


@dataclass(frozen=True)
class Judgement:
    """
    The quality of the input over two seconds.

    Attributes
    ----------
    sigma_m, sigma_rad, sigma_m_s, sigma_rad_s : noise of position, attitude, velocity and rate, by
        axis
    spread_m : noise of the position vector from the median, which jumps do not affect, m
    in_parent : whether the twist is in the axes of the parent frame
    velocity, rate : Fitting of the velocity and of the angular rate
    delay_s : delay of the twist, s, or None at constant velocity
    empty : whether the twist is always zero
    knot_hz : rate of the knots
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
        """Return the expected noise of a scheme: rms of the force vector, m/s^2."""
        if by_twist:
            return BY_TWIST * self.sigma_m_s * self.knot_hz
        return BY_POSE * self.sigma_m * self.knot_hz * self.knot_hz

    def why_not(self, surely=False):
        """Return the reason why the twist cannot be used, or ''."""
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
    Return the Judgement of consecutive knots.

    Parameters
    ----------
    knots : at least FEWEST - 2 Samples
    in_parent : whether the twist is in the axes of the parent frame, or None to find out
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
    """Return changes minus the integral of the Hermite curve of their rates."""
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
    """Return the sum of the elementwise products of two arrays."""
    return dot(a.ravel(), b.ravel())


def _fitting(rho, step_s, limit):
    square = _product(rho, rho)
    rms = math.sqrt(square / len(rho)) / float(np.median(step_s))
    return Fitting(rms, _product(rho[1:], rho[:-1]) / square if square else 0.0, limit)


def _delay(rho, v_m, in_child):
    """
    Return the delay of the velocities, s, or None if they do not change.

    Parameters
    ----------
    rho : (n, 3) differences between poses and velocities, m
    v_m : velocities in the map frame, m/s
    in_child : attitudes and velocities in the child frame if the twist is given there, because the
        delay then acts in that frame; otherwise None
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
    """Return whether the twist is in the axes of the parent, by comparing both assumptions."""
    child, parent = found[False], found[True]
    wrong = [x[0].is_wrong() or x[1].is_wrong() for x in (child, parent)]
    if wrong[0] != wrong[1]:
        return wrong[0]
    return child[0].rms > DIFFERENT_M_S and parent[0].rms < 0.5 * child[0].rms


class _Noise:
    """
    Separates noise from motion: noise is the part that a polynomial through NEIGHBOURS misses.

    Parameters
    ----------
    t_ns : (n,) instants of the samples, ns
    """

    def __init__(self, t_ns):
        count = len(t_ns) - NEIGHBOURS + 1
        near = [(t_ns[k:k + count] - t_ns[:count]) * 1e-9 for k in range(NEIGHBOURS)]
        # Divided differences of sixth order, scaled to unit gain for white noise.
        factors = [reduce(mul, [1.0 / (a - b) for b in near if b is not a]) for a in near]
        norm = np.sqrt(total([x * x for x in factors]))
        self._factors = [(x / norm)[:, None] for x in factors]

    def of(self, values):
        """Return the noise of values (n, 3): rms by axis, and of the vector from the median."""
        count = len(self._factors[0])
        left = total([x * (values[k:k + count] - values[3:3 + count])
                      for k, x in enumerate(self._factors)])
        return (math.sqrt(_product(left, left) / left.size),
                float(np.median(length(left))) / 0.6745)
