"""
Turns from one great circle to the next, flown inside the corner.

The heading turns, relative to the great circle, at a rate that rises to its full value by the
fifth-order smooth step 10 s^3 - 15 s^4 + 6 s^5 while the vehicle rolls in, then is constant, and
falls in the same way: rate and roll have two continuous derivatives. The start of the turn and its
angle are found iteratively, so that the turn ends on the next great circle and along it.
"""

import math

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics.elementary import sincos
from ins_sim.core.numerics.extrapolation import extrapolated_step
from .track import LegPiece, STEP_M

# Step of the integration and distance of the knots: at most this angle, STEP_M, and a fraction of
# the roll time; the error between the knots is 2e-10 m/s (docs/design/route.md).
STEP_ANGLE = 0.05
ROLL_STEPS = 12
# Legs whose courses differ by less than this are joined without a turn, rad.
STRAIGHT = 1e-10
SHARPEST = math.radians(170.0)
# Tolerance of the end of a turn, in position and course relative to the next leg, rad: 6e-6 m.
_CLOSE = 1e-12
# Steps of the difference quotients: fraction of the leg, and angle in rad.
_STEP_START, _STEP_ANGLE = 1e-5, 1e-4


class TurnProfile:
    """
    The turn rate over a turn by angle (rad, signed), at most rate (rad/s), rolling in roll_s.

    longest_s: largest allowed step.  parts: for each part its length (s), its largest step (s),
    and the coefficients of the rate as a polynomial in the time since the start of the part,
    constant first.
    """

    def __init__(self, angle, rate, roll_s, longest_s):
        hold_s = abs(angle) / rate - roll_s
        if hold_s < 0.0:
            hold_s, peak = 0.0, angle / roll_s
        else:
            peak = math.copysign(rate, angle)
        r = 1.0 / roll_s
        cube = peak * (r * r * r)
        rise = (0.0, 0.0, 0.0, 10.0 * cube, -15.0 * cube * r, 6.0 * cube * (r * r))
        step = min(longest_s, STEP_ANGLE / max(abs(peak), 1e-9))
        roll_step = min(roll_s / ROLL_STEPS, step)
        self.parts = [(roll_s, roll_step, rise)]
        if hold_s > 0.0:
            self.parts.append((hold_s, step, (peak,)))
        self.parts.append((roll_s, roll_step, (peak, *(-c for c in rise[1:]))))


def fly_turn(flow, state, profile):
    """
    Return the LegPiece of a turn and the state at its end; state: lat, lon, heading, rad.

    The integration is of eighth order, with steps so short that it is exact to rounding.
    """
    t, states, turn, start, state = [], [], [], 0.0, tuple(state)
    for length, longest, polynomial in profile.parts:

        def rates(time, y):
            rate = 0.0
            for c in polynomial[::-1]:
                rate = rate * time + c
            return flow.rates(*sincos(y[0]), *sincos(y[2]), rate)

        count = math.ceil(length / longest)
        step = length / count
        for k in range(count):
            t.append(k * step + start)
            states.append(state)
            turn.append(_taylor(polynomial, k * step))
            state = extrapolated_step(rates, k * step, state, step)
        start += length
    lat, lon, psi = np.array(states).T
    return LegPiece(np.array(t), lat, lon, psi, np.array(turn), start), state


def _taylor(polynomial, t):
    """Return the six Taylor coefficients at t of a polynomial, by Horner's scheme."""
    c = [*polynomial, *(0.0,) * (6 - len(polynomial))]
    for k in range(5):
        for j in range(4, k - 1, -1):
            c[j] += t * c[j + 1]
    return c


def turn_between(flow, before, after, rate, roll_s):
    """
    Return the turn from Leg before to Leg after, or None if both are on one great circle.

    Parameters
    ----------
    flow : Flow
    before, after : Legs
    rate : largest turn rate, rad/s
    roll_s : duration of the roll-in and of the roll-out, s

    Returns
    -------
    start, piece, end : distance X of the start on before (m), LegPiece, X of the end on after (m)

    Raises
    ------
    ValueError : for a turn of about 180 deg, or if no turn fits

    """
    heading = [float(flow.on_leg(leg, np.array([x]))[2][0])
               for leg, x in ((before, before.length), (after, 0.0))]
    angle = _wrap(heading[1] - heading[0])
    if abs(angle) < STRAIGHT:
        return None
    if abs(angle) > SHARPEST:
        raise ValueError(f'a turn of {math.degrees(abs(angle)):.1f} deg; expected at most '
                         f'{math.degrees(SHARPEST):.0f} deg')
    sin_half, cos_half = sincos(0.5 * abs(angle))
    lead = flow.airspeed * (sin_half / cos_half / rate + 0.5 * roll_s)

    def attempt(start, by):
        lat, lon, psi, _ = flow.on_leg(before, np.array([start * before.length]))
        piece, end = fly_turn(flow, (float(lat[0]), float(lon[0]), float(psi[0])), TurnProfile(
            by, rate, roll_s, STEP_M / flow.airspeed))
        off = (after.to_xz(*end[:2])[1] / ellipsoid.MEAN_RADIUS,
               _wrap(flow.course(end[0], end[2]) - after.course(*end[:2])))
        return off, piece, end

    start, by, best = 1.0 - lead / before.length, angle, None
    for _ in range(8):
        found = attempt(start, by)
        if best is not None and not _largest(found[0]) < _largest(best[0][0]):
            break
        best, (x, y) = (found, start), found[0]
        # Newton's method, with derivatives by difference quotients.
        (a, c), (b, d) = (
            [(p - q) / h for p, q in zip(attempt(start + h_1, by + h_2)[0], found[0])]
            for h, h_1, h_2 in ((_STEP_START, _STEP_START, 0.0), (_STEP_ANGLE, 0.0, _STEP_ANGLE)))
        determinant = a * d - b * c
        if determinant == 0.0:
            break
        start -= (d * x - b * y) / determinant
        by -= (a * y - c * x) / determinant
    (off, piece, end), start = best
    if not _largest(off) <= _CLOSE:
        raise ValueError(f'a turn of {math.degrees(angle):.1f} deg does not end on the leg to '
                         'the next point; expected longer legs or a smaller turn')
    return start * before.length, piece, after.to_xz(*end[:2])[0]


def _largest(off):
    return max(abs(off[0]), abs(off[1]))


def _wrap(angle):
    """Return an angle reduced to half a turn either way, rad."""
    return math.remainder(angle, 2.0 * math.pi)
