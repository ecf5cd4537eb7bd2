"""The solution that an autopilot receives, and when the vehicle flies straight."""

import math

from ins_sim.core.earth.great_circle import Leg
from ins_sim.core.guidance.autopilot import Autopilot
from ins_sim.core.guidance.margin import phase_margin
from ins_sim.core.guidance.steering import margin_sentence, Steering
from ins_sim.settings import guidance
from ins_sim.settings.catalogue import build
from ins_sim.settings.guidance import AutopilotEntry, GuidanceSettings, GuidedSettings
import numpy as np
import pytest
from support.guided.flights import fly, guided

LEGS = (Leg(0.96, 0.64, 0.98, 0.68), Leg(0.98, 0.68, 1.0, 0.66))
TICK_NS = 10_000_000


def steering(turns=(), **values):
    """Return a Steering on two legs."""
    return Steering(build(GuidanceSettings, values), LEGS, turns)


def beside(z=0.0, leg=LEGS[0]):
    """Return a solution at rest, z metres on the sphere to the right of a leg."""
    lat, lon = leg.from_xz(10_000.0, z)
    return lat, lon, 500.0, (0.0, 0.0, 0.0)


def test_the_command_is_that_of_the_estimate():
    """The command is k1 z + k2 v_z of a true motion, up to its limit."""
    motion = fly(guided(offset_m=5.0), 0.5)
    made = Steering(GuidanceSettings(), motion.route.legs, motion.turns)
    truth, states = motion.one(500_000_000), motion.states(np.array([500_000_000]))
    made.take(500_000_000, truth[:4])
    command = made.command(500_000_000)
    assert not command.why
    assert command.z == pytest.approx(states.z[0], abs=1e-5)
    assert command.v_z == pytest.approx(states.v_z[0], abs=1e-5)
    assert command.beta == pytest.approx(0.0125 * states.z[0] + 0.04 * states.v_z[0], abs=1e-6)
    made.take(510_000_000, beside(50.0, motion.route.legs[0]))
    assert made.command(510_000_000).beta == math.radians(8.0)
    assert made.counts == {'limited': 1}


def test_hold_course_leaves_the_offset():
    """course_hold controls only the rate of the offset and leaves the offset."""
    made = steering(autopilot='hold_course')
    lat, lon, height, _ = beside(80.0)
    made.take(0, (lat, lon, height, (0.0, 0.0, 0.0)))
    assert made.command(0).beta == 0.0
    made.take(1, (lat, lon, height, (1.0, 0.0, 0.0)))
    command = made.command(1)
    assert command.beta == 0.04 * command.v_z != 0.0


def test_the_solution_is_as_old_as_the_latency():
    """
    The newest solution that is at least latency_s old is used.

    Before there is one the vehicle flies straight.
    """
    made = steering(latency_s=0.03)
    for k in range(10):
        made.take(k * TICK_NS, beside(float(k)))
        command = made.command(k * TICK_NS)
        assert command.why == ('no solution' if k < 3 else '')
        assert command.z == pytest.approx(max(0.0, k - 3.0), rel=0.01, abs=1e-8)


def test_engaged_after_a_time_and_by_hand():
    """The autopilot is engaged after a time, or by calls that replace the schedule."""
    made = steering(engage_after_s=0.02)
    made.take(0, beside(5.0))
    assert [made.command(k * TICK_NS).why for k in range(4)] == ['not engaged'] * 2 + [''] * 2
    made.disengage()
    assert made.command(5 * TICK_NS).why == 'not engaged' and not made.engaged
    made.engage(6 * TICK_NS)
    assert made.command(6 * TICK_NS).beta > 0.0
    assert not made.notes


def test_turns_are_flown_without_the_autopilot():
    """After a turn the autopilot steers on the next leg; a note states when it starts."""
    made = steering(turns=[(1.0, 2.0)])
    made.disengage()
    made.engage(1_500_000_000)
    assert len(made.notes) == 1 and 'engaged at 1.500000000 s in a turn' in made.notes[0]
    for t_ns, leg, why in ((999_999_999, 0, ''), (1_000_000_000, 0, 'in a turn'),
                           (1_999_999_999, 0, 'in a turn'), (2_000_000_000, 1, '')):
        made.take(t_ns, beside(5.0, LEGS[leg]))
        command = made.command(t_ns)
        assert command.why == why and bool(command.beta) == (not why)
    assert command.z == pytest.approx(5.0, rel=0.01)
    assert made.counts == {'in a turn': 2}


@pytest.mark.parametrize('spoil, why', [
    (lambda s: (math.nan, *s[1:]), 'no number'), (lambda s: (*s[:3], (math.inf, 0.0, 0.0)),
                                                  'no number')], ids=('nan', 'inf'))
def test_bad_solutions_are_not_steered_by(spoil, why):
    """A bad solution causes one note and a count; the next good one is used again."""
    made = steering()
    for k in range(12):
        solution = beside(5.0)
        made.take(k * TICK_NS, spoil(solution) if k in (4, 8) else solution)
        command = made.command(k * TICK_NS)
        assert command.why == (why if k in (4, 8) else '')
        assert math.isfinite(command.beta + command.z + command.v_z)
        assert (command.beta == 0.0) == bool(command.why)
    assert len(made.notes) == 1 and 'flies straight' in made.notes[0]
    assert made.counts == {why: 2}


def test_a_jump_is_not_steered_by_until_the_solution_has_gone_on():
    """After a jump the vehicle flies straight until timeout_s has passed without another jump."""
    made = steering(timeout_s=0.05)
    for k in range(30):
        made.take(k * TICK_NS, beside(3000.0 if k in (4, 5) else 5.0))
        command = made.command(k * TICK_NS)
        assert command.why == ('jump' if 4 <= k <= 6 + 5 else '')
        assert (command.beta == 0.0) == bool(command.why)
    assert made.notes == [
        'the solution jumps by 2992 m to the right at 0.040000000 s; expected at most '
        'guidance.jump_m, 1000 m: the vehicle flies straight until the solution has continued '
        'without a jump for 0.05 s']
    assert made.counts == {'jump': 8}


def test_two_publishers_that_alternate_never_steer():
    """If every solution jumps, the vehicle always flies straight."""
    made = steering()
    for k in range(20):
        made.take(k * TICK_NS, beside(2000.0 * (k % 2)))
        assert made.command(k * TICK_NS).why == ('jump' if k else '')
    assert len(made.notes) == 1


def test_a_solution_that_stops_is_held_and_then_left():
    """The last solution is held for timeout_s, then one note is given; a new one is used."""
    made = steering(timeout_s=0.05)
    made.take(0, beside(5.0))
    whys = [made.command(k * TICK_NS).why for k in range(12)]
    assert whys == [''] * 6 + ['old'] * 6
    made.take(12 * TICK_NS, beside(5.0))
    assert not made.command(12 * TICK_NS).why
    assert len(made.notes) == 1 and 'at most 0.05 s old' in made.notes[0]


class Spoilt(Autopilot):
    """A user's autopilot that fails."""

    given = math.nan

    def command(self, t_ns, z, v_z):
        """Return something that is not a number."""
        return self.given


def test_an_autopilot_of_ones_own(monkeypatch):
    """An autopilot is added by an entry in the table; its command is checked."""
    monkeypatch.setitem(guidance.AUTOPILOTS, 'spoilt', AutopilotEntry(f'{__name__}:Spoilt'))
    monkeypatch.setitem(__import__('sys').modules, __name__, __import__('types').SimpleNamespace(
        Spoilt=Spoilt))
    for given in (math.nan, None, 'left', 10 ** 400, np.zeros(2)):
        made = steering(autopilot='spoilt')
        made.autopilot.given = given
        made.take(0, beside(5.0))
        command = made.command(0)
        assert command.beta == 0.0 and command.why == 'no command'
        assert made.notes == [f'the autopilot commands {repr(given)[:50]} at 0.000000000 s; '
                              'expected a number: the vehicle flies straight']


def test_phase_margin_is_that_of_the_characteristic_equation():
    """
    With a delay equal to the phase margin s = i w is a root of the characteristic equation.

    A message warns of this.
    """
    gains, force, lag_s = (0.0125, 0.04), 20.0, 0.4
    w = np.array([1e-3 * k for k in range(1, 5000)])
    loop = force * (gains[0] + 1j * w * gains[1]) / ((1j * w) ** 2 * (1.0 + 1j * w * lag_s))
    crossover = w[np.argmin(np.abs(np.abs(loop) - 1.0))]
    margin = phase_margin(gains, force, lag_s, 0.0)
    assert margin == pytest.approx(math.pi + np.angle(loop[w == crossover])[0] % (-2.0 * math.pi),
                                   abs=2e-3)
    delay_s = margin / crossover
    assert phase_margin(gains, force, lag_s, delay_s) == pytest.approx(0.0, abs=2e-3)
    assert margin_sentence(build(GuidanceSettings, {'latency_s': delay_s - 0.05}),
                           GuidedSettings()) is None
    assert 'phase margin of -' in margin_sentence(build(
        GuidanceSettings, {'latency_s': delay_s + 0.05}), GuidedSettings())
