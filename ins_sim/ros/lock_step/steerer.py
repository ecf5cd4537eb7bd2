"""Steer a guided motion in a live run by the navigation solution on a topic."""

from collections import deque
import math
import time

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.guidance.steering import (margin_sentence, NO_COMMAND, NO_SOLUTION, Steering,
                                            SteeringCommand)
from ins_sim.core.numerics.instants import seconds
from ins_sim.messages import topics
from ins_sim.messages.plausible import PlausibleReader
from ..process.net import described
from ..transport.patience import MISSING_S

# The flown history is discarded once per this number of control periods.
FORGET = 4096
# Tolerance of the norm of a quaternion.
UNIT = 1e-3
# The period of the solutions is the shortest of this number of intervals between them.
INTERVALS = 8
LATE = 'late'


class Steerer:
    """
    Steers the guided motion of a TruthSource by the Odometry messages of a queue.

    A command is computed when the sample after it is about to be sent. In lock-step it waits for
    the solution of the instant that the autopilot uses (or, if solutions come less often than
    commands, for the last one before it), so that the flight equals that of the offline run. In
    real time the newest solution is used, even if it is late.

    Parameters
    ----------
    settings : MotionGeneratorSettings
    source : TruthSource
    queue : HandQueue
        Queue of the topic named by guidance.topic.
    publish : callable
        Called with the bytes of every command.
    fault : callable
        Called with a sentence about each fault.

    Attributes
    ----------
    steering : Steering
    heard : bool
        Whether a solution has arrived in this run.
    """

    def __init__(self, settings, source, queue, publish, fault):
        self._motion, self._first_ns = source.guided, source.first_ns
        self._name = settings.guidance.topic
        self._latency_ns, self._timeout_ns = settings.guidance.in_ns()
        self._source, self._queue, self._fault = source, queue, fault
        self._depth, self._epoch_ns = settings.topics.depth, source.epoch_ns
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        names = settings.frames.names()
        own = topics.INS_ODOMETRY if f'/{self._name}'.endswith(f'/{topics.INS_ODOMETRY.name}') \
            else topics.AIDED_ODOMETRY
        topic = topics.Topic(self._name, topics.ODOMETRY, own.named(names).frames)
        self._frames = topic.frames
        self._reader, self._text = PlausibleReader(topic, ((0, 3), (3, 7), (43, 46))), \
            topic.reader()
        self._pack, self._publish = topics.GUIDANCE_COMMAND.named(
            names).writer().pack, publish
        self.steering = Steering(settings.guidance, self._motion.route.legs, self._motion.turns)
        self._margin = margin_sentence(settings.guidance, settings.motion.guided)
        self.restart()

    def restart(self):
        """Begin a run: discard the flown history and the received solutions."""
        self._source.restart()
        self.steering.reset()
        if self._margin:
            self.steering.notes.append(self._margin)
        for _ in range(self._depth):
            if self._queue.take() is None:
                break
        self._newest_ns, self._misses, self.late = None, 0, 0
        self._intervals, self._late_ns = deque(maxlen=INTERVALS), None
        self._command = SteeringCommand(self._first_ns, 0.0, 0.0, 0.0, NO_SOLUTION)
        self._began_s, self._told = None, set()
        self.wait_anew()

    def wait_anew(self):
        """Measure the wait for a solution from now on."""
        self._since = None

    @property
    def heard(self):
        """Return whether a solution has arrived in this run."""
        return self._newest_ns is not None

    def reach(self, sent, allowed, waits):
        """
        Compute the command that the next sample needs, and return how many samples may be sent.

        Parameters
        ----------
        sent : number of samples sent
        allowed : number of samples that the pace allows
        waits : whether to wait for the solution of the instant, as in lock-step
        """
        self._take()
        if sent < allowed and sent >= self._source.known and self._ready(waits):
            self._steer()
        return min(allowed, max(sent, self._source.known))

    def _take(self):
        for _ in range(self._depth):
            if (data := self._queue.take()) is None:
                return
            try:
                self._hear(data)
            except ValueError as error:
                self._fault(str(error))
            except Exception as error:
                # A message of another package must never end the node.
                self._fault(described(error))

    def _hear(self, data):
        stamp_ns, *pose = self._reader.read(data)
        t_ns = stamp_ns - self._epoch_ns
        frames = self._text.strings(data)
        if frames != self._frames:
            raise ValueError(f'{self._name} has the frames {frames[0]!r} and {frames[1]!r}; '
                             f'expected {self._frames[0]!r} and {self._frames[1]!r}; the message '
                             'is not used for steering')
        newest_ns, length = self._newest_ns, math.hypot(*pose[1])
        if abs(length - 1.0) > UNIT:
            raise ValueError(f'{self._name} at {seconds(stamp_ns)} has an orientation of length '
                             f'{length:.6g}; expected a quaternion of length 1; the message is '
                             'not used for steering')
        if t_ns > self._motion.known_ns + self._motion.period_ns:
            raise ValueError(f'{self._name} has the stamp {seconds(stamp_ns)}, but the truth has '
                             f'only reached {seconds(self._motion.known_ns + self._epoch_ns)}; '
                             'expected a solution of this run that is not ahead of the truth; '
                             'the message was dropped')
        if newest_ns is not None and t_ns <= newest_ns:
            if t_ns < newest_ns:
                raise ValueError(f'{self._name} jumps back from '
                                 f'{seconds(newest_ns + self._epoch_ns)} to {seconds(stamp_ns)}; '
                                 'expected rising stamps of one publisher; the message was '
                                 'dropped')
            # In lock-step sample 0 is sent again until it is acknowledged, so its solution may
            # come again.
            return
        if newest_ns is not None:
            self._intervals.append(t_ns - newest_ns)
        self.steering.take(t_ns, self._frame.geodetic_one(*pose))
        self._newest_ns = t_ns

    def _ready(self, waits):
        """Return whether the next command can be computed."""
        wanted_ns = max(self._motion.known_ns - self._latency_ns, self._first_ns)
        # The newest solution is the one wanted if the following one would be too late.
        if self.heard and self._newest_ns + min(self._intervals, default=1) > wanted_ns:
            self._misses, self._since, self._late_ns = 0, None, None
            return True
        now = time.monotonic()
        if not waits:
            self._look_for_silence(now)
            self._look_for_lateness(wanted_ns)
            self.late += 1
            return True
        if self._since is None:
            self._since = now
        # A solution may have been lost, or its node may have ended: halve the wait each time.
        if now - self._since < MISSING_S / 2 ** self._misses:
            return False
        goes_on = 'the last one is used' if self.heard else 'the vehicle flies straight'
        self._fault(f'no solution for {seconds(wanted_ns + self._epoch_ns)} on {self._name} in '
                    f'{MISSING_S / 2 ** self._misses:.3g} s; expected a solution for every '
                    'control instant: is the node that publishes guidance.topic running? If '
                    f'samples are lost, increase guidance.latency_s; {goes_on}')
        self._misses, self._since = min(self._misses + 1, 60), None
        self.late += 1
        return True

    def _look_for_silence(self, now):
        """Report, once, that no solution has arrived yet."""
        if self._began_s is None:
            self._began_s = now
        if not self.heard and NO_SOLUTION not in self._told and now - self._began_s > MISSING_S:
            self._told.add(NO_SOLUTION)
            self._fault(f'no message on {self._name} in {MISSING_S:g} s; expected solutions on '
                        'guidance.topic; the vehicle flies straight until one arrives')

    def _look_for_lateness(self, wanted_ns):
        """Report, once, that solutions have been late for longer than the autopilot's timeout."""
        if not self.heard or LATE in self._told:
            return
        if self._late_ns is None:
            self._late_ns = wanted_ns
        behind_ns = wanted_ns - self._newest_ns
        if wanted_ns - self._late_ns > self._timeout_ns >= behind_ns:
            self._told.add(LATE)
            self._fault(f'solutions on {self._name} have been late for '
                        f'{self._timeout_ns * 1e-9:g} s, now by {behind_ns * 1e-9:.3g} s; '
                        'expected a solution for every control instant, late by at most '
                        'guidance.latency_s; the last one is used')

    def _steer(self):
        """Compute the command of the next control period, apply it and publish it."""
        t_ns, steering = self._motion.known_ns, self.steering
        try:
            command = steering.command(t_ns)
        except Exception as error:
            # The autopilot may be code of the user.
            self._fault(f'the autopilot raised {type(error).__name__} ({error}) at '
                        f'{seconds(t_ns)}; expected a command; the vehicle flies straight')
            steering.give_up(NO_COMMAND)
            command = SteeringCommand(t_ns, 0.0, 0.0, 0.0, NO_COMMAND)
        self._command = command
        self._motion.command(t_ns, command.beta)
        if t_ns // self._motion.period_ns % FORGET == 0:
            self._motion.forget(t_ns)
        self._publish(self._pack(t_ns + self._epoch_ns, command[1:4]))
        for sentence in steering.notes:
            self._fault(sentence)
        steering.notes.clear()

    def engage(self, on):
        """Engage the autopilot or disengage it; return the text of the response."""
        if not on:
            self.steering.disengage()
            return 'disengaged: the vehicle flies straight'
        t_ns = self._motion.known_ns
        self.steering.engage(t_ns)
        return 'engaged' + (', from the end of the turn on' if self.steering.in_turn(t_ns) else '')

    def describe(self):
        """Return '' (this never reports a fault) and the values for /diagnostics."""
        command = self._command
        return '', (('autopilot', command.why or 'steers'),
                    ('commanded sideslip rad', f'{command.beta:.6g}'),
                    ('estimated offset m', f'{command.z:.6g}'),
                    ('late solutions', self.late),
                    *((f'control instants: {why}', n) for why, n in self.steering.counts.items()))
