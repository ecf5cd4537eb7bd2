"""Which scheme an input calls for, and the sentences that say so."""

from dataclasses import dataclass
import math

from .judgement import Judgement
from .stamps import Steadiness

# Noise of the force, m/s^2, from which on a twist of zero holds what seems to be at rest.
UNREST = 0.1
# Bandwidth of the loop that holds the path to the positions, rad/s, at least and at most.
LOOSE, TIGHT = 0.53, 1.0
# What noise of the positions may add to the force, as a part of what that of the twist makes.
SHARE = 0.1


@dataclass(frozen=True)
class Scheme:
    """
    How truth is made of an input.

    by_twist: whether its twist is believed, in_parent in the axes of its parent frame; reason: why
    it is not, or ''; settled: whether the twist could be judged; every, half_ns: as of KnotFit;
    hold: as of TwistKnots.
    """

    by_twist: bool
    in_parent: bool
    reason: str
    settled: bool
    every: int
    half_ns: float
    hold: float


def knot_count(period_ns, dt_ns):
    """Return how many samples a knot stands for: knots are not denser than the IMU's readings."""
    return max(1, math.ceil(dt_ns / period_ns - 0.05))


def chosen(settings, judgement, steady, dt_ns):
    """Return the Scheme for an input; settings: TruthAdapterSettings."""
    every = knot_count(steady.period_ns, dt_ns)
    reason = judgement.why_not()
    settled = not judgement.empty or bool(reason)
    if settings.twist == 'ignore':
        by_twist, reason = False, 'twist is ignore'
    elif settings.twist == 'use':
        by_twist = True
    elif not settled:
        by_twist = judgement.force_noise(False) > UNREST
        reason = '' if by_twist else 'it is zero while nothing moves'
    else:
        by_twist = not reason
    half_ns = 0.5 * every * steady.period_ns if every > 1 else 0.0
    if not by_twist:
        half_ns = max(half_ns, 0.5e9 * settings.smoothing_s)
    return Scheme(by_twist, judgement.in_parent, reason, settled, every, half_ns,
                  position_hold(judgement))


def position_hold(judgement):
    """
    Return the bandwidth of the loop that holds the path to the positions, rad/s.

    Noise of the twist and of the attitudes lets the path wander by one over the square root of the
    bandwidth; noise of the positions becomes a force by its square
    (docs/theory/external_truth.md).
    """
    allowed = SHARE * judgement.force_noise(True) / math.sqrt(3.0)
    if allowed >= TIGHT * TIGHT * judgement.sigma_m:
        return TIGHT
    return max(LOOSE, math.sqrt(allowed / judgement.sigma_m))


def report(name, scheme: Scheme, judgement: Judgement, steady: Steadiness):
    """Return the sentence on an input and on the scheme for it."""
    j = judgement
    pose = f'{1e3 * j.sigma_m:.2g} mm, {math.degrees(j.sigma_rad):.2g} deg'
    if j.empty:
        twist = 'twist zero'
    else:
        late = 'delay unknown at constant velocity' if j.delay_s is None else (
            f'{round(1e3 * j.delay_s, 2) + 0.0:g} ms late')
        twist = (f'twist {1e3 * j.sigma_m_s:.2g} mm/s, {math.degrees(j.sigma_rad_s):.2g} deg/s, '
                 f'in the {"parent" if scheme.in_parent else "child"} frame, {late}')
    if scheme.by_twist:
        how = 'the twist is believed' + (f' although {scheme.reason}' if scheme.reason else '')
    else:
        how = f'only the poses are used ({scheme.reason})'
    dense = f', a knot for every {scheme.every} samples' if scheme.every > 1 else ''
    return (f'{name}: {1e9 / steady.period_ns:.4g} Hz, jitter {1e-6 * steady.jitter_ns:.2g} ms; '
            f'noise by axis: pose {pose}, {twist}; {how}{dense}; expected noise of the force: '
            f'{j.force_noise(scheme.by_twist):.2g} m/s^2 (rms of the vector)')
