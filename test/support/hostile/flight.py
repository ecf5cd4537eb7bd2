"""
A flight of all nodes while hostile messages arrive, and the conditions that must always hold.

The truth is sent by this class, or, if the motion is guided, by the motion generator, which is
steered by the aided solution.
"""

from collections import Counter
from types import SimpleNamespace

from ins_sim.core.timeseries.bounds import LATEST_NS
from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND
from ins_sim.messages.run_announcement import RunAnnouncement
from ins_sim.ros.lock_step.truth_source import TruthSource
from ins_sim.settings.catalogue import build
from ins_sim.settings.motion import MotionGeneratorSettings

from .fed_nodes import FedNodes, held_bytes
from .messages import HostileMessages

RATE_HZ, DT_S = 100.0, 0.01
COMMON = {'rate_hz': RATE_HZ, 'topics.depth': 500}
FLIGHT = {**COMMON, 'time.epoch': 'fixed', 'time.epoch_s': 0, 'motion.kind': 'racetrack',
          'pacing.lock_step': True, 'pacing.window': 200}
WINDOWS = {'window.cycles': 50, 'limits.height_max_m': 2e4}
NODES = {
    'motion_generator': FLIGHT,
    'imu_sensor': {**COMMON, 'gyro.errors.bias_deg_h': [1.0, 1.0, 1.0]},
    'strapdown': COMMON,
    'velocity_meter': {**COMMON, **WINDOWS},
    'gnss': COMMON,
    'aided_navigator': {**COMMON, 'window.cycles': 50, 'gnss_model.use': True},
}
_INTEGRATED = {'input': 'integrated'}
# Settings of a variant that differ from the common ones, by node.
VARIANTS = (
    {},
    {'imu_sensor': {'source': 'motion', 'motion.kind': 'racetrack', 'gyro.delay_us.x': 1000.0}},
    {'imu_sensor': {'gyro.delay_us.x': 2500.0, 'accelerometer.delay_us.z': -30000.0, 'output':
                    'integrated'}, 'strapdown': _INTEGRATED, 'aided_navigator': _INTEGRATED},
    {'imu_sensor': {'gyro.model': 'dtg', 'output': 'integrated'}, 'strapdown': _INTEGRATED,
     'aided_navigator': _INTEGRATED},
    {'imu_sensor': {'sampling.jitter_us': 500.0, 'sampling.latency_us': 1000.0},
     'strapdown': {'imu_time': 'nominal', 'imu_latency_us': 1000.0, 'vertical.channel': 'damped'}},
    {'imu_sensor': {'gyro.errors.angle_random_walk_deg_sqrt_h': [0.1] * 3,
                    'gyro.errors.rate_random_walk_deg_h_sqrt_h': [1.0] * 3},
     'velocity_meter': {'mode': 'signal'}},
    {'strapdown': {'vertical.channel': 'free'}, 'velocity_meter': {'attack_angle': 'none'},
     'gnss': {'errors.position_drift_m': [1.0] * 3, 'gnss.latency_ms': 100.0, 'lever_arm_m':
              [1.0, 2.0, 3.0]}, 'aided_navigator': {'gnss.latency_ms': 100.0}},
    *({'aided_navigator': {'filter': name, 'gnss_model.use': False}}
      for name in ('free', 'conventional', 'paper', 'paper_corrected', 'window_kf')),
    {'motion_generator': {'motion.kind': 'guided', 'pacing.lock_step': False, 'duration_s': 0.0}},
)
# Variant with stamps for which the aided navigator finds no truth, and variant with guidance.
JITTERED, STEERED = 4, len(VARIANTS) - 1
ATTACKED = (topics.TRUTH_IMU, topics.TRUTH_ODOMETRY, topics.IMU_RAW, topics.INS_ODOMETRY,
            topics.METER_RECORD, topics.GNSS_FIX, topics.GNSS_VELOCITY, topics.ACK)
# Topics that must be recent at the end of a calm stretch, each with its greatest age, s.
ALIVE = ((topics.IMU_RAW, 0.05), (topics.INS_ODOMETRY, 0.05), (topics.AIDED_ODOMETRY, 0.3),
         (topics.METER_RECORD, 1.1), (topics.METER_VELOCITY, 1.1), (topics.GNSS_FIX, 1.1))
# Good samples after which all nodes work again: twice the patience of 5 s, and some windows.
CALM = 1500
# Limits on what one message may cause, over all nodes: messages sent, and bytes held.
MOST_SENT = 20_000
MOST_BYTES = 20_000_000
# Limits on log lines of a node: per second, in addition at the first occurrence of faults, length.
LINES_PER_SECOND, LINES_AT_ONCE, LONGEST_LINE = 4, 60, 700


class Finding(AssertionError):
    """A condition that does not hold; the text states which."""


class HostileFlight:
    """
    All nodes in flight; ``attack(count)`` sends hostile messages, ``calm()`` only good ones.

    variant: index into VARIANTS; more: {node: parameters} of further nodes. tried: number of
    messages by kind and topic; rescued: unexpected exceptions caught by the nodes, by message.
    """

    def __init__(self, seed, more=None, variant=0):
        settings = VARIANTS[variant % len(VARIANTS)]
        self.fed = FedNodes({**{node: {**parameters, **settings.get(node, {})}
                                for node, parameters in NODES.items()}, **(more or {})})
        self._alive = [(topic, late_s) for topic, late_s in ALIVE
                       if variant % len(VARIANTS) != JITTERED or topic != topics.AIDED_ODOMETRY]
        self._steered = variant % len(VARIANTS) == STEERED
        if self._steered:
            self._alive.append((topics.GUIDANCE_COMMAND, 0.05))
        self.hostile = HostileMessages(seed, (*ATTACKED, topics.AIDED_ODOMETRY) if self._steered
                                       else ATTACKED)
        self.tried, self.rescued, self._k = Counter(), Counter(), 0
        self._source = TruthSource(build(MotionGeneratorSettings, FLIGHT))
        self.most_sent = self.most_bytes = 0

    # Announcement of the run that the nodes receive at the start, or None.
    announced = RunAnnouncement(0, 0, RATE_HZ, LATEST_NS)

    def __enter__(self):
        self.fed.__enter__()
        self.fed.bus.listen = self._heard
        for node in self.fed.nodes.values():
            self._watch(node)
        if self.announced is not None:
            self.announce(self.announced)
        return self

    def __exit__(self, *exception):
        self.fed.__exit__(*exception)

    def _watch(self, node):
        fault = node.monitor.fault

        def counted(sentence, fatal=False):
            if 'please report it' in sentence:
                self.rescued[sentence.partition(';')[0]] += 1
            fault(sentence, fatal)

        node.monitor.fault = counted

    def _heard(self, name, data):
        if name in self.hostile.names:
            self.hostile.heard(name, data)

    def announce(self, run, *names):
        """Deliver the announcement of a run to all nodes that read it, or to the named ones."""
        for name in names or self.fed.nodes:
            if hasattr(self.fed.nodes[name], '_announced'):
                self.fed.nodes[name]._announced.take(run.pack())

    def good(self, count):
        """Send good samples of the truth."""
        bus = self.fed.bus
        for _ in range(count):
            if self._steered:
                self._generate()
            else:
                messages = dict(zip((topic.name for topic in topics.TRUTH),
                                    self._source.messages(self._k)))
                for topic in (topics.TRUTH_ODOMETRY, topics.TRUTH_IMU):
                    self.hostile.heard(topic.name, messages[topic.name])
                    bus.put(topic.name, messages[topic.name])
                self._k += 1
            self.fed.clock.pass_by(DT_S)
            self._drive()

    def _generate(self):
        """Let the generator send the next sample, which is due."""
        generator = self.fed.nodes['motion_generator']
        # Half a period late, so that rounding of the clock does not matter.
        generator._pace.anchor(self._k + 0.5)
        generator._advance(None)
        self._k += 1
        if generator._next != self._k:
            raise Finding(f'the generator has sent {generator._next} samples; expected {self._k}')

    def start_anew(self):
        """Reset the run: the next good sample is the first one."""
        self._k = 0
        if self._steered:
            self.fed.nodes['motion_generator']._on_reset(None, SimpleNamespace())

    def _drive(self):
        before = sum(self.fed.bus.sent.values())
        self.fed.bus.drive()
        if not self._steered:
            self.fed.nodes['motion_generator']._take_acks()
        recorder = self.fed.nodes.get('recorder')
        if recorder is not None:
            recorder.recorder.poll()
        sent = sum(self.fed.bus.sent.values()) - before
        self.most_sent = max(self.most_sent, sent)
        if sent > MOST_SENT:
            raise Finding(f'one message leads to {sent} of the nodes; expected {MOST_SENT}')

    def attack(self, count):
        """Send hostile messages in bursts between good samples, and check all conditions."""
        choose = self.hostile.random
        left = count
        while left > 0:
            self.good(choose.randint(1, 6))
            if choose.random() < 0.002:
                self.start_anew()
            for _ in range(choose.randint(1, 12)):
                message = self.hostile.message()
                if message is None:
                    continue
                kind, name, data = message
                self.tried[kind, name] += 1
                left -= 1
                self.spoilt = message
                self.fed.bus.put(name, data)
                if choose.random() < 0.8:
                    self._drive()
        self._check()

    def _check(self):
        bus = self.fed.bus
        if bus.wrong:
            raise Finding(f'{bus.wrong[0][0]} holds {bus.wrong[0][1]}; expected finite numbers')
        for name, node in self.fed.nodes.items():
            size = held_bytes(node)
            self.most_bytes = max(self.most_bytes, size)
            if size > MOST_BYTES:
                raise Finding(f'{name} holds {size} bytes; expected at most {MOST_BYTES}')
            if node.__dict__.get('stop'):
                raise Finding(f'{name} has ended')
        for name, log in self.fed.logs.items():
            most = LINES_AT_ONCE + LINES_PER_SECOND * (self.fed.clock.now_s - self.fed.began_s)
            if log.lines > most or log.longest > LONGEST_LINE:
                raise Finding(f'{name} has said {log.lines} lines of up to {log.longest} '
                              f'characters; expected {most:.0f} of {LONGEST_LINE}')

    def calm(self, samples=CALM):
        """Send only good samples; at their end every node must deliver recent output."""
        self.good(samples)
        self._check()
        now_ns = self._source.stamp_ns(self._k - 1)
        for topic, late_s in self._alive:
            late_ns = now_ns - self.fed.bus.newest_ns.get(topic.name, -1)
            # Latency and jitter may give stamps slightly later than the present sample.
            if not -SECOND // 100 <= late_ns <= round(late_s * SECOND):
                raise Finding(f'{topic.name} is {late_ns / SECOND:.3f} s late after {samples} '
                              f'good samples; expected {late_s:g} s')
