"""Live steering: solutions of a topic in, commands to the guided motion and to a topic out."""

import time

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.guidance.steering import margin_sentence, NO_SOLUTION, Steering, SteeringCommand
from ins_sim.core.numerics.instants import seconds
from ins_sim.messages import topics
from ins_sim.messages.plausible import PlausibleReader
from ..process.net import described
from ..transport.patience import MISSING_S

# Control periods between two times at which what was flown is forgotten.
FORGET = 4096


class Steerer:
    """
    Steers the guided motion of a TruthSource by the Odometry that a queue gives.

    A command is given when the sample behind it is to be sent.  In lock-step it waits for the
    solution of the instant that the autopilot uses, so that the flight is that of the offline run;
    in real time the newest solution serves, and the one before where it is late.

    Parameters
    ----------
    settings : MotionGeneratorSettings
    source : TruthSource
    queue : HandQueue
        Of the topic guidance.topic.
    publish : callable
        Called with the bytes of every command.
    fault : callable
        Called with a sentence of what was met.

    Attributes
    ----------
    steering : Steering
    heard : bool
        Whether a solution has come in this run.
    """

    def __init__(self, settings, source, queue, publish, fault):
        self._motion, self._first_ns = source.guided, source.first_ns
        self._name, self._latency_ns = settings.guidance.topic, settings.guidance.in_ns()[0]
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
        """Begin a run: forget what was flown, and what has come."""
        self._source.restart()
        self.steering.reset()
        if self._margin:
            self.steering.notes.append(self._margin)
        for _ in range(self._depth):
            if self._queue.take() is None:
                break
        self._newest_ns, self._misses, self.late = None, 0, 0
        self._command = SteeringCommand(self._first_ns, 0.0, 0.0, 0.0, NO_SOLUTION)
        self._began_s, self._told = None, False
        self.wait_anew()

    def wait_anew(self):
        """Count from now on how long a solution has not come."""
        self._since = None

    @property
    def heard(self):
        """Return whether a solution of this run has come."""
        return self._newest_ns is not None

    def reach(self, sent, allowed, waits):
        """
        Return how many samples may be sent, and give the command that the next one needs.

        sent: number of samples sent; allowed: how many may have been sent as for the rest; waits:
        whether to wait for the solution of the instant, as in lock-step.
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
                # what reads the messages of strangers has a last net, as nodes have
                self._fault(described(error))

    def _hear(self, data):
        stamp_ns, *pose = self._reader.read(data)
        t_ns = stamp_ns - self._epoch_ns
        frames = self._text.strings(data)
        if frames != self._frames:
            raise ValueError(f'{self._name} has the frames {frames[0]!r} and {frames[1]!r}; '
                             f'expected {self._frames[0]!r} and {self._frames[1]!r}: the vehicle '
                             'is not steered by it')
        newest_ns = self._newest_ns
        if t_ns > self._motion.known_ns + self._motion.period_ns:
            raise ValueError(f'{self._name} has the stamp {seconds(stamp_ns)}, when the truth is '
                             f'at {seconds(self._motion.known_ns + self._epoch_ns)}; expected a '
                             'solution of this run that is not ahead of the truth; the message '
                             'was dropped')
        if newest_ns is not None and t_ns <= newest_ns:
            if t_ns < newest_ns:
                raise ValueError(f'{self._name} jumps back from '
                                 f'{seconds(newest_ns + self._epoch_ns)} to {seconds(stamp_ns)}; '
                                 'expected rising stamps of one publisher; the message was '
                                 'dropped')
            # sample 0 is answered again
            return
        self.steering.take(t_ns, self._frame.geodetic_one(*pose))
        self._newest_ns = t_ns

    def _ready(self, waits):
        """Return whether to give the command at the instant up to which the motion is known."""
        wanted_ns = max(self._motion.known_ns - self._latency_ns, self._first_ns)
        if self.heard and self._newest_ns >= wanted_ns:
            self._misses, self._since = 0, None
            return True
        now = time.monotonic()
        if not waits:
            self._look_for_silence(now)
            self.late += 1
            return True
        if self._since is None:
            self._since = now
        # A sample may have been lost; who has ended is waited for less and less.
        if now - self._since < MISSING_S / 2 ** self._misses:
            return False
        self._fault(f'no solution of {seconds(wanted_ns + self._epoch_ns)} on {self._name} in '
                    f'{MISSING_S / 2 ** self._misses:.3g} s; expected that of every control '
                    'instant (behind a channel of negative delay, and where samples are lost, '
                    'guidance.latency_s must be larger): steering by the last one')
        self._misses, self._since = min(self._misses + 1, 60), None
        self.late += 1
        return True

    def _look_for_silence(self, now):
        """Say, once, that nothing has come yet."""
        if self._began_s is None:
            self._began_s = now
        if not self.heard and not self._told and now - self._began_s > MISSING_S:
            self._told = True
            self._fault(f'no message on {self._name} in {MISSING_S:g} s; expected a solution to '
                        'steer by (guidance.topic): the vehicle flies straight until one comes')

    def _steer(self):
        """Command the next control period, and publish what was commanded."""
        t_ns, steering = self._motion.known_ns, self.steering
        try:
            command = steering.command(t_ns)
        except Exception as error:
            # an autopilot of the user
            self._fault(f'the autopilot raises {type(error).__name__} ({error}) at '
                        f'{seconds(t_ns)}; expected a command: the vehicle flies straight')
            command = SteeringCommand(t_ns, 0.0, 0.0, 0.0, 'no command')
        self._command = command
        self._motion.command(t_ns, command.beta)
        if t_ns // self._motion.period_ns % FORGET == 0:
            self._motion.forget(t_ns)
        self._publish(self._pack(t_ns + self._epoch_ns, command[1:4]))
        for sentence in steering.notes:
            self._fault(sentence)
        steering.notes.clear()

    def engage(self, on):
        """Engage the autopilot or disengage it; return what became of it, in a few words."""
        if not on:
            self.steering.disengage()
            return 'disengaged: it flies straight'
        t_ns = self._motion.known_ns
        self.steering.engage(t_ns)
        return 'engaged' + (', from the end of the turn on' if self.steering.in_turn(t_ns) else '')

    def describe(self):
        """Return nothing that is wrong, and the values for /diagnostics."""
        command = self._command
        return '', (('autopilot', command.why or 'steers'),
                    ('commanded sideslip rad', f'{command.beta:.6g}'),
                    ('estimated offset m', f'{command.z:.6g}'),
                    ('late solutions', self.late),
                    *((f'control instants: {why}', n) for why, n in self.steering.counts.items()))
