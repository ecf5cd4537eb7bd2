"""The input that steers the vehicle, node objects without DDS: for any input it keeps flying."""

import math
import struct
from types import SimpleNamespace

from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND, Writer
import pytest
from support.hostile.flight import HostileFlight, STEERED

pytest.importorskip('rclpy')

NAME = topics.AIDED_ODOMETRY.name
# So near to the leg that the command is not limited.
NEAR = {'motion.kind': 'guided', 'rate_hz': 100.0, 'topics.depth': 500, 'duration_s': 0.0,
        'motion.guided.offset_m': 5.0, 'time.epoch_s': 0}
# Offsets of the doubles in an Odometry message.
DOUBLES = 85


class Steered(HostileFlight):
    """A closed loop whose steering messages pass through ``change(data) -> data or None``."""

    def __init__(self, generator=None, **more):
        more = {'motion_generator': {**NEAR, **(generator or {})}, **more}
        super().__init__(1, more, STEERED)
        self.change = lambda data: data

    def __enter__(self):
        super().__enter__()
        self.generator, bus = self.fed.nodes['motion_generator'], self.fed.bus
        self.commands, put = [], bus.put

        def changed(name, data):
            data = self.change(data) if name == NAME else data
            if data is not None:
                put(name, data)

        bus.put = changed
        return self

    def _heard(self, name, data):
        super()._heard(name, data)
        if name == topics.GUIDANCE_COMMAND.name:
            stamp_ns, values = topics.GUIDANCE_COMMAND.reader().read(data)
            self.commands.append((stamp_ns, *values))

    @property
    def said(self):
        """Return the log messages of the generator."""
        return '\n'.join(self.fed.logs['motion_generator'].kept)

    @property
    def why(self):
        """Return the reason why the autopilot does not steer, or '' if it does."""
        return self.generator._steerer._command.why

    def engage(self, on):
        """Call the service that engages the autopilot; return its response."""
        return self.generator._on_engage(SimpleNamespace(data=on), SimpleNamespace())


@pytest.fixture
def flight(ros_domain):
    with Steered() as flight:
        flight.good(100)
        assert flight.why == '' and flight.commands[-1][1] != 0.0
        yield flight


def with_double(data, index, change):
    """Return an Odometry message with one double replaced."""
    spoilt, at = bytearray(data), len(data) - 8 * (DOUBLES - index)
    struct.pack_into('<d', spoilt, at, change(*struct.unpack_from('<d', data, at)))
    return bytes(spoilt)


def moved(data, shift_ns):
    """Return a message whose stamp is later by a shift."""
    stamp_ns, _ = topics.AIDED_ODOMETRY.reader(((0, 1),)).read(data)
    return data[:4] + struct.pack('<iI', *divmod(stamp_ns + shift_ns, SECOND)) + data[12:]


def in_frames(data, *frames):
    """Return a message in other frames."""
    values = struct.unpack_from(f'<{DOUBLES}d', data, len(data) - 8 * DOUBLES)
    text = Writer(topics.ODOMETRY, *frames, runs=((0, DOUBLES),)).pack(0, values)
    return text[:4] + data[4:12] + text[12:]


@pytest.mark.parametrize('change, sentence', [
    (lambda data: None, 'the autopilot still uses the solution of 0.990000000 s'),
    (lambda data: with_double(data, 0, lambda _: math.nan), 'aided/odometry at 1.000000000 s '
     'holds the position (nan'),
    (lambda data: with_double(data, 43, lambda _: 1e30), 'holds the linear velocity (1e+30'),
    (lambda data: in_frames(data, 'odom', 'base_link'), "aided/odometry has the frames 'odom' and "
     "'base_link'; expected 'map' and 'base_link'"),
    (lambda data: in_frames(data, 'map', 'imu'), "the frames 'map' and 'imu'"),
    (lambda data: moved(data, SECOND), 'has the stamp 2.000000000 s, but the truth has only '
     'reached 1.000000000 s; expected a solution of this run that is not ahead of the truth'),
    (lambda data: data[:4] + struct.pack('<iI', 0, SECOND // 2) + data[12:],
     'aided/odometry jumps back from 0.990000000 s to 0.500000000 s'),
    (lambda data: data[:100], 'nav_msgs/msg/Odometry'),
    (lambda data: with_double(data, 1, lambda y: y + 3e5), 'the solution jumps by -'),
    (lambda data: with_double(data, 5, lambda _: 3.0), 'aided/odometry at 1.000000000 s has an '
     'orientation of length 3')],
    ids=('silence', 'nan', 'speed', 'frame', 'child frame', 'ahead', 'back', 'short', 'jump',
         'quaternion'))
def test_what_steers_goes_wrong_and_comes_back(change, sentence, flight):
    """A bad solution gives one message, is held for 1 s, and a good one steers again."""
    before = len(flight.commands)
    flight.change = change
    flight.good(250)
    assert sentence in flight.said, flight.said
    assert flight.fed.logs['motion_generator'].lines < 20
    held = [beta for _, beta, _, _ in flight.commands[before:]]
    if 'jumps by' in sentence:
        # It flies straight for a second; then, 300 km from the leg, it continues from where it is.
        assert not any(held[1:100]) and held[-1] != 0.0
    else:
        assert held[50] != 0.0 and held[-1] == 0.0 and flight.why == 'old'
    assert max(map(abs, held)) <= math.radians(8.0)
    flight.change = lambda data: data
    flight.good(110 if 'jumps by' in sentence else 5)
    assert flight.why == '' and flight.commands[-1][1] != 0.0
    assert not flight.rescued


def test_two_publishers_are_named(flight):
    """Diagnostics name two publishers of the topic that steers."""
    flight.generator.count_publishers = lambda name: 2 if name.endswith(NAME) else 1
    flight.generator.get_publishers_info_by_topic = lambda name: []
    flight.generator.monitor.publish()
    assert f'/{NAME} has 2 publishers' in flight.said


def test_two_that_alternate_300_km_apart_do_not_steer(flight):
    """If two publishers 300 km apart alternate, every second solution is a jump: no steering."""
    turn = [0]

    def alternate(data):
        turn[0] += 1
        return with_double(data, 1, lambda y: y + 3e5) if turn[0] % 2 else data

    flight.change = alternate
    flight.good(50)
    assert flight.said.count('the solution jumps by') == 1
    assert all(beta == 0.0 for _, beta, _, _ in flight.commands[-45:])


def test_disengaged_it_flies_straight(flight):
    """The service disengages and engages the autopilot."""
    assert flight.engage(False).message == 'disengaged: the vehicle flies straight'
    flight.good(50)
    assert flight.why == 'not engaged' and flight.commands[-1][1] == 0.0
    # The estimate is published nevertheless.
    assert flight.commands[-1][2] > 0.1
    assert flight.engage(True).message == 'engaged'
    flight.good(5)
    assert flight.why == ''
    _, values = flight.generator._steerer.describe()
    assert ('control instants: not engaged', 50) in values


def test_engaged_in_a_turn_it_waits_for_its_end(ros_domain):
    """Engaged in a turn the autopilot starts at the end of the turn, and logs this."""
    route = {'motion.route.points.latitude_deg': [55.0, 55.5, 55.6],
             'motion.route.points.longitude_deg': [37.0, 37.3, 38.2]}
    with Steered({**route, 'start_s': 285.0, 'guidance.engage_after_s': 1e6}) as flight:
        flight.good(20)
        assert flight.generator._steerer.steering.in_turn(285 * SECOND)
        assert flight.engage(True).message == 'engaged, from the end of the turn on'
        flight.good(20)
        assert flight.why == 'in a turn' and 'in a turn; it steers from' in flight.said


@pytest.mark.parametrize('generator, sentence', [
    ({'guidance.latency_s': 5.0}, 'guidance.latency_s is 5 s and the control period 0.01 s, '
     'which leaves the loop a phase margin of -'),
    ({'guidance.topic': 'nobody/odometry'}, 'no message on nobody/odometry in 5 s; expected '
     'solutions on guidance.topic; the vehicle flies straight until one arrives')],
    ids=('latency', 'nobody'))
def test_a_loop_that_cannot_be_closed_is_named_once(generator, sentence, ros_domain):
    """A latency without phase margin, and a topic without publisher, give one message."""
    with Steered(generator) as flight:
        flight.good(520)
        assert flight.said.count(sentence) == 1
        assert not flight.rescued and len(flight.commands) == 519


def test_a_command_beyond_the_limit_is_counted(ros_domain):
    """From 100 m off the leg the command is at its limit, and these instants are counted."""
    with Steered({'motion.guided.offset_m': 100.0}) as flight:
        flight.good(30)
        assert flight.commands[-1][1] == math.radians(8.0)
        assert ('control instants: limited', 29) in flight.generator._steerer.describe()[1]


def test_a_filter_that_refuses_turns_steers_on(ros_domain):
    """With filter paper in a turn the loop stays closed; the navigator logs rejected fixes."""
    with Steered(aided_navigator={'rate_hz': 100.0, 'filter': 'paper', 'window.cycles': 50,
                                  'topics.depth': 500}) as flight:
        flight.good(300)
        assert flight.why == '' and not flight.rescued


def test_an_autopilot_that_raises_is_named(flight):
    """If an autopilot raises an exception, the vehicle flies straight and no node ends."""
    flight.generator._steerer.steering.autopilot.command = lambda *_: 1 / 0
    flight.good(20)
    assert 'the autopilot raised ZeroDivisionError (division by zero) at ' in flight.said
    assert flight.commands[-1][1] == 0.0


def test_after_a_reset_the_flight_is_the_same(flight):
    """After a reset the flight has the same bits; no solution of the old run is used."""
    first = list(flight.commands)
    flight.good(1)
    flight.commands.clear()
    flight.start_anew()
    flight.good(100)
    assert flight.commands == first


class LockStep:
    """A Steerer in lock-step with a simulated clock."""

    def __init__(self, flight):
        self._flight, self._steerer = flight, flight.generator._steerer
        self._sent = flight.generator._next

    def may_send(self, wait_s):
        """Return whether the next sample may be sent after a wait."""
        self._flight.fed.clock.now_s += wait_s
        reached = self._steerer.reach(self._sent, self._sent + 200, True)
        sends, self._sent = reached > self._sent, reached
        return sends


def test_solutions_that_come_seldom_are_not_waited_for_at_every_instant(flight):
    """
    If solutions come with every tenth sample, the interval is learnt and there is no other wait.

    The newest solution up to the instant is used.
    """
    turn = [0]

    def tenth(data):
        turn[0] += 1
        return data if turn[0] % 10 == 0 else None

    flight.change = tenth
    flight.good(195)
    steerer = flight.generator._steerer
    newest_ns = steerer._newest_ns
    lock = LockStep(flight)
    while lock.may_send(0.0):
        assert steerer._motion.known_ns <= newest_ns + SECOND // 10
    # It waits for the next solution.
    assert steerer._motion.known_ns == newest_ns + SECOND // 10
    assert flight.why == '' and 'no solution for' not in flight.said


def test_solutions_that_are_always_late_are_said_once(flight):
    """In real time the last solution is used; a delay of a second is logged once."""
    held = []

    def late(data):
        held.append(data)
        return held.pop(0) if len(held) > 30 else None

    flight.change = late
    flight.good(250)
    assert flight.why == ''
    assert flight.said.count(f'solutions on {NAME} have been late for 1 s, now by 0.3') == 1


def test_in_lock_step_it_waits_less_and_less_for_who_is_silent(flight):
    """In lock-step a silent estimator is waited for 5 s, 2.5 s, ...: 10 s in all."""
    flight.change = lambda data: None
    flight.good(1)
    lock = LockStep(flight)
    for patience_s in (5.0, 2.5, 1.25):
        assert not lock.may_send(0.0) and not lock.may_send(0.99 * patience_s)
        assert lock.may_send(0.02 * patience_s)
    assert 'no solution for 1.000000000 s on aided/odometry in 5 s; expected a' in flight.said
    assert 'increase guidance.latency_s; the last one is used' in flight.said
    # A pause does not count as waiting.
    assert not lock.may_send(0.0)
    flight.fed.clock.now_s += 100.0
    flight.generator._on_pause(SimpleNamespace(data=False), SimpleNamespace())
    assert not lock.may_send(0.0)
