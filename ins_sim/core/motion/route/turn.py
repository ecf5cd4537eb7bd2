"""
Turns from one great circle to the next, flown inside the corner.

Beyond what the great circle asks, the heading turns at a rate that rises to its full value by the
fifth-order smooth step 10 s^3 - 15 s^4 + 6 s^5 while the vehicle rolls in, holds, and falls in the
same way: rate and roll have two continuous derivatives.  Where it begins and by how much it turns
is solved for, so that it ends on the next great circle and along it.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

from ins_sim.core.earth import ellipsoid
from .track import LegPiece, STEP_M

# of the integration, and between knots: at most this angle and STEP_M, and a roll in eight
STEP_ANGLE = 0.05
ROLL_STEPS = 8
# Below this legs are joined without a turn: the course jumps by no more, rad.
STRAIGHT = 1e-10
SHARPEST = math.radians(170.0)
# how far beside and how far turned from the next leg a turn may end, rad: 6e-6 m
_CLOSE = 1e-12
# of the slopes by differences: part of the leg, and rad
_STEP_START, _STEP_ANGLE = 1e-5, 1e-4


class TurnProfile:
    """
    The rate over a turn by angle (rad, signed), at most rate (rad/s), rolling in roll_s.

    longest_s: what a step may be; parts: length (s), step (s), and the rate as a polynomial of
    the time since the start of the part.
    """

    def __init__(self, angle, rate, roll_s, longest_s):
        hold_s = abs(angle) / rate - roll_s
        if hold_s < 0.0:
            hold_s, peak = 0.0, angle / roll_s
        else:
            peak = math.copysign(rate, angle)
        s = np.polynomial.Polynomial((0.0, 1.0 / roll_s))
        rise = peak * s ** 3 * (10.0 - 15.0 * s + 6.0 * s * s)
        step = min(longest_s, STEP_ANGLE / max(abs(peak), 1e-9))
        roll_step = min(roll_s / ROLL_STEPS, step)
        self.parts = [(roll_s, roll_step, rise)]
        if hold_s > 0.0:
            self.parts.append((hold_s, step, np.polynomial.Polynomial((peak,))))
        self.parts.append((roll_s, roll_step, peak - rise))


def fly_turn(flow, state, profile):
    """
    Return the Piece of a turn from state (lat, lon, heading, rad), and the state at its end.

    Eighth order (Dormand and Prince) with steps so short that it is exact to rounding.
    """
    t, states, turn, start = [], [], [], 0.0
    for length, step, polynomial in profile.parts:
        coefficients = polynomial.coef[::-1].tolist()

        def rates(time, y):
            rate = 0.0
            for c in coefficients:
                rate = rate * time + c
            lat, _, psi = y.tolist()
            return flow.rates(math.sin(lat), math.cos(lat), math.sin(psi), math.cos(psi), rate)

        solution = solve_ivp(rates, (0.0, length), state, 'DOP853', max_step=step,
                             first_step=min(step, length), rtol=1e-13, atol=1e-13)
        state = solution.y[:, -1]
        t.append(solution.t[:-1] + start)
        states.append(solution.y[:, :-1])
        turn.append(_taylor(polynomial, solution.t[:-1]))
        start += length
    lat, lon, psi = np.concatenate(states, axis=1)
    return LegPiece(np.concatenate(t), lat, lon, psi, np.concatenate(turn), start), state.tolist()


def _taylor(polynomial, t):
    """Return the Taylor coefficients (m, 6) of a polynomial at t (m,)."""
    rows = np.zeros((len(t), 6))
    factorial = 1.0
    for k in range(6):
        rows[:, k] = polynomial(t) / factorial
        polynomial, factorial = polynomial.deriv(), factorial * (k + 1)
    return rows


def turn_between(flow, before, after, rate, roll_s):
    """
    Return the turn from Leg before to Leg after, or None where both are one great circle.

    It is X of its start on before, m, the Piece, and X of its end on after, m.  rate: rad/s;
    roll_s: s.  Raises ValueError on a turn of about 180 deg, and where none fits.
    """
    heading = [float(flow.on_leg(leg, np.array([x]))[2][0])
               for leg, x in ((before, before.length), (after, 0.0))]
    angle = _wrap(heading[1] - heading[0])
    if abs(angle) < STRAIGHT:
        return None
    if abs(angle) > SHARPEST:
        raise ValueError(f'a turn of {math.degrees(abs(angle)):.1f} deg; expected at most '
                         f'{math.degrees(SHARPEST):.0f} deg')
    lead = flow.airspeed * (math.tan(0.5 * abs(angle)) / rate + 0.5 * roll_s)

    def attempt(start, by):
        lat, lon, psi, _ = flow.on_leg(before, np.array([start * before.length]))
        piece, end = fly_turn(flow, (lat[0], lon[0], psi[0]), TurnProfile(
            float(by), rate, roll_s, STEP_M / flow.airspeed))
        off = np.array((after.to_xz(*end[:2])[1] / ellipsoid.MEAN_RADIUS,
                        _wrap(flow.course(end[0], end[2]) - after.course(*end[:2]))))
        return off, piece, end

    unknown, best = np.array((1.0 - lead / before.length, angle)), None
    for _ in range(8):
        found = attempt(*unknown)
        if best is None or np.abs(found[0]).max() < np.abs(best[0][0]).max():
            best = found, unknown
        else:
            break
        slopes = np.stack([(attempt(*(unknown + h))[0] - found[0]) / h.sum()
                           for h in np.diag((_STEP_START, _STEP_ANGLE))], axis=1)
        try:
            unknown = unknown - np.linalg.solve(slopes, found[0])
        except np.linalg.LinAlgError:
            break
    (off, piece, end), (start, _) = best[0], best[1].tolist()
    if not np.abs(off).max() <= _CLOSE:
        raise ValueError(f'a turn of {math.degrees(angle):.1f} deg that ends on no path to the '
                         'next point; expected longer legs or a smaller turn')
    return start * before.length, piece, after.to_xz(*end[:2])[0]


def _wrap(angle):
    """Return an angle within half a turn, rad."""
    return math.remainder(angle, 2.0 * math.pi)
