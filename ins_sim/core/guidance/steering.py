"""Steering: which solution the autopilot gets, and when the vehicle flies straight."""

from bisect import bisect_right
from collections import deque
import math
from typing import NamedTuple

from ins_sim.core.earth.sphere_metric import across_leg
from ins_sim.core.numerics.instants import seconds
from .autopilot import make_autopilot
from .margin import phase_margin

# Reasons why an autopilot does not steer.
NOT_ENGAGED, TURN, NO_SOLUTION = 'not engaged', 'in a turn', 'no solution'
NO_NUMBER, JUMP, OLD, NO_COMMAND = 'no number', 'jump', 'old', 'no command'
# The autopilot steers, at the limit of the command.
LIMITED = 'limited'


class SteeringCommand(NamedTuple):
    """
    The command at a control instant, and its origin.

    Attributes
    ----------
    t_ns : the instant, motion time, ns
    beta : sideslip, rad
    z, v_z : the estimate, m and m/s, zero without one
    why : '' if the autopilot steers, otherwise the reason why the vehicle flies straight
    """

    t_ns: int
    beta: float
    z: float
    v_z: float
    why: str


class Steering:
    """
    An autopilot with the solutions it uses.

    ``take`` receives solutions; ``command`` answers a control instant from the newest solution
    that is at least ``latency_s`` old. The vehicle flies straight (command zero) until the
    autopilot is engaged, in turns, and if the solution is missing, not finite or too old. After a
    jump of the solution it flies straight until ``timeout_s`` has passed without another jump.

    Parameters
    ----------
    settings : GuidanceSettings
    legs : sequence of great_circle.Leg
    turns : sequence of (start, end)
        Motion times of the turns between the legs, s.

    Attributes
    ----------
    engaged : bool
    notes : list of str
        Sentences about events that occurred for the first time; the owner empties it.
    counts : dict
        {why: number of control instants} at which the vehicle flew straight, and of LIMITED.
    """

    def __init__(self, settings, legs, turns=()):
        self._legs = legs
        self._turns = [(round(1e9 * start), round(1e9 * end)) for start, end in turns]
        self._ends = [end for _, end in self._turns]
        self._latency_ns, self._timeout_ns = settings.in_ns()
        self._after_ns = round(1e9 * settings.engage_after_s)
        self._limit, self._jump = math.radians(settings.limit_deg), settings.jump_m
        self.autopilot = make_autopilot(settings)
        self.reset()

    def reset(self):
        """Forget all solutions; the next control instant is the first of a run."""
        self._solutions, self._used, self._jumped_ns = deque(), None, None
        self._engage_ns, self.engaged, self._steers = None, False, False
        self._scheduled = True
        self.notes, self.counts = [], {}

    def engage(self, t_ns):
        """Engage the autopilot; in a turn it steers from the end of the turn on, with a note."""
        self.engaged, self._scheduled = True, False
        if self.in_turn(t_ns):
            self.notes.append(f'the autopilot was engaged at {seconds(t_ns)} in a turn; it '
                              'steers from the end of the turn on')

    def disengage(self):
        """Disengage the autopilot: the vehicle flies straight."""
        self.engaged = self._scheduled = False

    def in_turn(self, t_ns):
        """Return whether the route turns at a motion time."""
        k = self._leg_index(t_ns)
        return k < len(self._turns) and self._turns[k][0] <= t_ns

    def _leg_index(self, t_ns):
        return bisect_right(self._ends, t_ns)

    def take(self, t_ns, solution):
        """
        Store a solution of motion time t_ns, ns.

        solution: (lat, lon, height, v_n, ...), rad, m and m/s.  If its stamp is not later than the
        last one, it replaces all solutions from that stamp on.
        """
        solutions = self._solutions
        while solutions and solutions[-1][0] >= t_ns:
            solutions.pop()
        if self._used is not None and self._used[0] >= t_ns:
            self._used = None
        solutions.append((t_ns, solution))

    def command(self, t_ns):
        """Return the SteeringCommand at a control instant, motion time in ns."""
        if self._engage_ns is None:
            self._engage_ns = t_ns + self._after_ns
        if self._scheduled and t_ns >= self._engage_ns:
            self.engage(t_ns)
        z, v_z, why = self._estimate(t_ns)
        if not self.engaged:
            why = NOT_ENGAGED
        elif self.in_turn(t_ns):
            why = TURN
        beta = 0.0
        if not why:
            if not self._steers:
                self.autopilot.reset()
            given = self.autopilot.command(t_ns, z, v_z)
            beta = _number(given)
            if beta is None:
                why, beta = NO_COMMAND, 0.0
                self._say(why, f'the autopilot commands {given!r:.50} at {seconds(t_ns)}; '
                          'expected a number: the vehicle flies straight')
        if why:
            self.give_up(why)
        else:
            self._steers = True
            if abs(beta) > self._limit:
                beta = math.copysign(self._limit, beta)
                self._count(LIMITED)
        return SteeringCommand(t_ns, beta, z, v_z, why)

    def give_up(self, why):
        """Count a control instant at which the autopilot does not steer, by reason."""
        self._steers = False
        self._count(why)

    def _estimate(self, t_ns):
        """Return z, v_z, and '' or the reason why they must not be used."""
        wanted_ns, solutions = t_ns - self._latency_ns, self._solutions
        while len(solutions) > 1 and solutions[1][0] <= wanted_ns:
            solutions.popleft()
        if solutions and solutions[0][0] <= wanted_ns:
            self._use(t_ns, *solutions.popleft())
        if self._used is None:
            return 0.0, 0.0, NO_SOLUTION
        stamp_ns, z, v_z, why = self._used[:4]
        age_ns = wanted_ns - stamp_ns
        if not why and age_ns > self._timeout_ns:
            why = OLD
            self._say(why, f'the autopilot still uses the solution of {seconds(stamp_ns)} at '
                      f'{seconds(t_ns)}; expected one at most '
                      f'{(self._latency_ns + self._timeout_ns) * 1e-9:g} s old: the vehicle flies '
                      'straight until a new one arrives')
        return z, v_z, why

    def _use(self, t_ns, stamp_ns, solution):
        """Use a solution for steering from now on."""
        lat, lon, height, v_n = solution[:4]
        index = self._leg_index(t_ns)
        last, why = self._used, ''
        if not math.isfinite(lat + lon + height + v_n[0] + v_n[1]):
            self._say(NO_NUMBER, f'the solution at {seconds(stamp_ns)} is not finite; expected '
                      'a finite one: the vehicle flies straight until there is one')
            self._used = stamp_ns, 0.0, 0.0, NO_NUMBER, index
            return
        z, v_z = across_leg(self._legs[index], lat, lon, height, v_n)
        if last is not None and last[3] != NO_NUMBER and last[4] == index:
            expected = last[1] + last[2] * ((stamp_ns - last[0]) * 1e-9)
            if abs(z - expected) > self._jump:
                self._jumped_ns = stamp_ns
                self._say(JUMP, f'the solution jumps by {z - expected:.4g} m to the right at '
                          f'{seconds(stamp_ns)}; expected at most guidance.jump_m, '
                          f'{self._jump:g} m: the vehicle flies straight until the solution has '
                          f'continued without a jump for {self._timeout_ns * 1e-9:g} s')
        if self._jumped_ns is not None:
            if 0 <= stamp_ns - self._jumped_ns <= self._timeout_ns:
                why = JUMP
            else:
                self._jumped_ns = None
        self._used = stamp_ns, z, v_z, why, index

    def _say(self, why, sentence):
        if why not in self.counts:
            self.notes.append(sentence)

    def _count(self, why):
        self.counts[why] = self.counts.get(why, 0) + 1


def _number(value):
    """Return the value that an autopilot commands as a finite float, or None."""
    try:
        value = float(value)
    except (TypeError, ValueError, OverflowError):
        return None
    return value if abs(value) < math.inf else None


def margin_sentence(settings, guided):
    """
    Return the warning that the latency makes the loop unstable with exact navigation, or None.

    Exact navigation is assumed.  settings: GuidanceSettings; guided: GuidedSettings.
    """
    gains = make_autopilot(settings).gains()
    if gains is None:
        return None
    period_s = 1.0 / guided.control_rate_hz
    margin = phase_margin(gains, guided.side_force_m_s2_rad, guided.lag_s,
                          settings.latency_s + period_s)
    if margin is None or margin > 0.0:
        return None
    return (f'guidance.latency_s is {settings.latency_s:g} s and the control period '
            f'{period_s:g} s, which leaves the loop a phase '
            f'margin of {math.degrees(margin):.1f} deg; expected more than 0: it is unstable '
            'even with exact navigation')
