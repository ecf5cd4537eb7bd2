"""Select the topics and the time span of a bag to play. This module does not import ROS."""

from dataclasses import dataclass
from itertools import chain

from ins_sim.bags.bag_reader import open_bag
from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND, STAMP_END_NS
from .run_clock import is_stamped

CLOCK = topics.CLOCK_TOPIC.name
# Topics with absolute names in ROS, which do not move into the namespace of the player.
ABSOLUTE = {CLOCK, '/rosout', '/parameter_events', '/diagnostics', '/tf', '/tf_static'}
# Topics whose stamps can be the samples of lock-step; the first one in the bag is used.
DRIVERS = (topics.IMU_RAW, topics.TRUTH_IMU, topics.TRUTH_ODOMETRY)


@dataclass(frozen=True)
class Options:
    """
    Options of playing a bag (``ins_sim play``).

    Attributes
    ----------
    topics : names of the topics, or None for all
    rate : bag time per wall time; 0 for as fast as lock-step allows
    start_s, duration_s : part of the bag that is played, s; duration None for up to the end
    loop : whether to play the part again and again
    wait_s : time to wait at most for a reader of every topic, s
    clock_hz : rate of /clock, Hz, or None
    required, window, timeout_s : lock-step, see the parameters pacing.*
    """

    topics: tuple | None = None
    rate: float | None = None
    start_s: float = 0.0
    duration_s: float | None = None
    loop: bool = False
    wait_s: float = 1.0
    clock_hz: float | None = None
    required: tuple = ()
    window: int = 200
    timeout_s: float = 30.0

    def __post_init__(self):
        """Raise ValueError for an option outside its range."""
        if self.rate is None:
            object.__setattr__(self, 'rate', 0.0 if self.required else 1.0)
        if not 0.0 <= self.rate <= 1e6 or (self.rate == 0.0 and not self.required):
            raise ValueError(f'--rate is {self.rate:g}; expected more than 0, up to 1e6, or 0 '
                             'with --lock-step')
        for name, value, low, high in (
                ('start', self.start_s, 0.0, 1e10), ('duration', self.duration_s, 0.0, 1e10),
                ('wait', self.wait_s, 0.0, 1e5), ('clock', self.clock_hz, 1e-3, 1e4),
                ('window', self.window, 1, 2000), ('timeout', self.timeout_s, 0.1, 1e5)):
            if value is not None and not low <= value <= high:
                raise ValueError(f'--{name} is {value:g}; expected {low:g} to {high:g}')


class Playing:
    """
    The part of a bag that is played.

    Raises ValueError and OSError like ``open_bag``, and ValueError if there is nothing to play.

    Attributes
    ----------
    channels : {topic name: channel of the bag}
    runs : names of the topics that announce a run
    left_out : names of topics that the player itself publishes or reads
    first_ns : log time at which the part begins, ns
    driver : name of the topic whose messages are the samples of lock-step, or None
    """

    def __init__(self, path, options):
        self.bag = open_bag(path)
        # The announcement of a run is always played first: the nodes need its epoch.
        runs = [n for n in self.bag.topics if n.endswith('/' + topics.RUN.name)]
        chosen = [self.bag.topic(n).name for n in options.topics or self.bag.topics]
        names = [*runs, *(n for n in chosen if n not in runs)]
        self.left_out = [n for n in names if (n == CLOCK and options.clock_hz is not None) or (
            options.required and n.endswith('/' + topics.ACK.name))]
        spans = self.bag.spans()
        self.runs = [n for n in runs if spans[n].count]
        self.channels = {n: self.bag.topics[n] for n in names if n not in self.left_out}
        self.counts = {n: spans[n].count for n in self.channels}
        heard = [spans[n] for n in self.channels if spans[n].count and n not in runs]
        if not heard:
            raise ValueError(f'{path} has no message on {", ".join(self.channels) or "a topic"}; '
                             'expected at least one message')
        begin, end = min(s.first_ns for s in heard), max(s.last_ns for s in heard)
        self.first_ns = begin + round(options.start_s * SECOND)
        if self.first_ns > end:
            raise ValueError(f'--start is {options.start_s:g} s; expected at most '
                             f'{(end - begin) / SECOND:g} s, the length of {path}')
        self._last_ns = end if options.duration_s is None else \
            self.first_ns + round(options.duration_s * SECOND)
        if options.clock_hz is not None:
            self._check_clock(self.first_ns, min(end, self._last_ns))
        self.driver = self._find_driver() if options.required else None

    def _check_clock(self, *log_ns):
        """Raise ValueError for a log time that is outside the range of a /clock message."""
        for t_ns in log_ns:
            if not -STAMP_END_NS <= t_ns < STAMP_END_NS:
                raise ValueError(f'a message of {self.bag.path} was logged at {t_ns // SECOND} s; '
                                 f'expected less than {STAMP_END_NS // SECOND} s, the end of the '
                                 f'stamps of {CLOCK}: omit --clock')

    def _find_driver(self):
        present = [n for n, count in self.counts.items()
                   if count and is_stamped(self.channels[n].type_name)]
        for topic in DRIVERS:
            for name in present:
                if name.endswith('/' + topic.name):
                    return name
        if not present:
            raise ValueError(f'{self.bag.path} has no topic with stamps; expected one for '
                             '--lock-step')
        return max(present, key=self.counts.get)

    def announcements(self):
        """Return [(topic, data)] with the first message of each topic that announces a run."""
        return [(name, next(iter(self.bag.messages([name])))[2]) for name in self.runs]

    def messages(self):
        """Yield (topic, log_ns, data) in the order of the log times."""
        for message in self.bag.messages(list(self.channels)):
            if message[1] > self._last_ns:
                return
            if message[1] >= self.first_ns:
                yield message

    def close(self):
        """Close the bag."""
        self.bag.close()


class PlaybackStart:
    """
    The first sample of lock-step, which is repeated until the consumers have acknowledged it.

    It consists of the first message of the driving topic, with stamp s_0, and for every other
    stamped topic of the last message with a stamp up to s_0 that comes before the second message
    of the driving topic.

    Attributes
    ----------
    stamp_ns : s_0, ns
    early : messages with older stamps, played before the first sample
    repeated : messages of the first sample
    held : messages without a stamp or with a later one, played after the acknowledgement
    rest : iterator over all following messages
    """

    LONGEST = 10000

    def __init__(self, playing, stamp_of):
        taken, rest, drivers = [], iter(playing.messages()), 0
        following = []
        for message in rest:
            drivers += message[0] == playing.driver
            if drivers == 2 or len(taken) == self.LONGEST:
                following = [message]
                break
            taken.append(message)
        stamps = [stamp_of(m[2]) if is_stamped(playing.channels[m[0]].type_name) else None
                  for m in taken]
        first_ns = next((s for m, s in zip(taken, stamps) if m[0] == playing.driver), None)
        if first_ns is None:
            raise ValueError(f'{playing.driver} has no message among the first {len(taken)}; '
                             'expected one for --lock-step: try another --start')
        latest = {m[0]: k for k, (m, s) in enumerate(zip(taken, stamps))
                  if s is not None and s <= first_ns}
        self.stamp_ns = first_ns
        self.repeated = [taken[k] for k in sorted(latest.values())]
        self.early, self.held = [], []
        for k, (message, stamp) in enumerate(zip(taken, stamps)):
            if latest.get(message[0]) == k:
                continue
            old = stamp is not None and stamp <= first_ns
            (self.early if old else self.held).append(message)
        self.rest = chain(following, rest)
