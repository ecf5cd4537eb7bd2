"""Choice of the scheme for an input, and the sentences that report it."""

from dataclasses import dataclass
import math

from .judgement import Judgement
from .stamps import Steadiness

# If poses are noisier than this force, m/s^2, a zero twist means a vehicle at rest.
UNREST = 0.1
# Smallest and largest bandwidth of the loop that ties the path to the positions, rad/s.
LOOSE, TIGHT = 0.53, 1.0
# Largest force noise from the positions, as a fraction of that from the twist.
SHARE = 0.1


@dataclass(frozen=True)
class Scheme:
    """
    How truth is made from an input.

    Attributes
    ----------
    by_twist : whether the twist is used
    in_parent : whether the twist is in the axes of the parent frame
    reason : why the twist is not used, or ''
    settled : whether the twist could be judged
    every, half_ns : see KnotFit
    hold : see TwistKnots
    """

    by_twist: bool
    in_parent: bool
    reason: str
    settled: bool
    every: int
    half_ns: float
    hold: float


def knot_count(period_ns, dt_ns):
    """Return the number of samples per knot; knots are not denser than the IMU's readings."""
    return max(1, math.ceil(dt_ns / period_ns - 0.05))


def chosen(settings, judgement, steady, dt_ns):
    """
    Return the Scheme for an input.

    Parameters
    ----------
    settings : TruthAdapterSettings
    judgement : Judgement
    steady : Steadiness
    dt_ns : period of the IMU, ns
    """
    every = knot_count(steady.period_ns, dt_ns)
    reason = judgement.why_not()
    settled = not judgement.empty or bool(reason)
    if settings.twist == 'ignore':
        by_twist, reason = False, 'parameter twist is ignore'
    elif settings.twist == 'use':
        by_twist = True
    elif not settled:
        by_twist = judgement.force_noise(False) > UNREST
        reason = '' if by_twist else 'it is zero while the vehicle does not move'
    else:
        by_twist = not reason
    half_ns = 0.5 * every * steady.period_ns if every > 1 else 0.0
    if not by_twist:
        half_ns = max(half_ns, 0.5e9 * settings.smoothing_s)
    return Scheme(by_twist, judgement.in_parent, reason, settled, every, half_ns,
                  position_hold(judgement))


def position_hold(judgement):
    """
    Return the bandwidth of the loop that ties the path to the positions, rad/s.

    Noise of the twist and of the attitudes makes the path wander, by one over the square root of
    the bandwidth. Noise of the positions appears as force, by the square of the bandwidth
    (docs/theory/external_truth.md).
    """
    allowed = SHARE * judgement.force_noise(True) / math.sqrt(3.0)
    if allowed >= TIGHT * TIGHT * judgement.sigma_m:
        return TIGHT
    return max(LOOSE, math.sqrt(allowed / judgement.sigma_m))


def report(name, scheme: Scheme, judgement: Judgement, steady: Steadiness):
    """Return the sentence that describes an input and the scheme for it."""
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
        how = f'only the poses are used, not the twist ({scheme.reason})'
    dense = f', a knot for every {scheme.every} samples' if scheme.every > 1 else ''
    return (f'{name}: {1e9 / steady.period_ns:.4g} Hz, jitter {1e-6 * steady.jitter_ns:.2g} ms; '
            f'noise by axis: pose {pose}, {twist}; {how}{dense}; expected noise of the force: '
            f'{j.force_noise(scheme.by_twist):.2g} m/s^2 (rms of the vector)')
