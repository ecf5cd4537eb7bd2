"""Node recorder: write topics into a bag as soon as they appear."""

import time

from rclpy.exceptions import NameValidationException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from rclpy.validate_topic_name import validate_topic_name

from ins_sim.bags import bag_writer
from ins_sim.bags import qos as bag_qos
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.definitions import message_definition
from ins_sim.messages import topics
from ins_sim.messages.cdr import SECOND
from ins_sim.settings.recorder import RecorderSettings
from ..process.diagnostics import Monitor
from ..process.parameters import declare_settings
from ..process.runtime import EXIT_FAULT
from ..recording.bag_recorder import BagRecorder
from ..recording.definitions import installed_definition
from ..transport import qos

SCAN_S = 0.2
# Known topics are checked for new publishers this often, s; asking costs 0.1 ms per topic.
WATCH_S = 2.0
SERVE_S = 0.02
NAP_S = 0.002
ABSENT_S = 2.0
# When all topics are recorded: the first lock-step sample is acknowledged only after no new topic
# has appeared for this time, s.
SETTLE_S = 1.0
# Topics of this package are subscribed to before they have a publisher, so that their first
# messages are not missed.
OURS = (topics.RUN, *topics.DATA, *topics.BESIDE, topics.CLOCK_TOPIC, *topics.AIDING,
        *topics.GUIDANCE)


class RecorderNode(Node):
    """Writes topics of any type and quality of service into a bag."""

    NAME = 'recorder'

    def __init__(self, stop=None, **kwargs):
        super().__init__(self.NAME, **kwargs)
        self.settings = declare_settings(self, RecorderSettings)
        record, storage = self.settings.record, self.settings.storage
        self._named = self._resolved(record.topics)
        self._bag = bag_writer.BagWriter(
            storage.path, storage.format, storage.compression, storage.replace,
            round(storage.split_mb * 1e6) or None, round(storage.split_s * SECOND) or None)
        self.monitor = Monitor(self)
        self.recorder = BagRecorder(self, self._bag, record.log_time, record.depth,
                                    self.monitor.fault)
        self.monitor.add(self._describe)
        self._lost, self._refused, self._weak, self._gids = 0, set(), set(), {}
        self._started = self._appeared = self._watched = time.monotonic()
        self._told_absent = False
        self.recorder.settled = not record.all_topics
        ours = {self.resolve_topic_name(topic.name): topic for topic in OURS}
        for name in self._named:
            if name in ours:
                self.recorder.add(ours[name])

    def _resolved(self, names):
        try:
            return dict.fromkeys(self.resolve_topic_name(name) for name in names
                                 if validate_topic_name(name))
        except NameValidationException as error:
            raise ValueError(f'record.topics: {" ".join(str(error).split())}') from None

    def run(self, executor, stop):
        """Record until stop is set or the disk is full; then complete the bag."""
        self.get_logger().info(f'recording into {self._bag.path}')
        served = scanned = 0.0
        try:
            while not stop:
                taken = self.recorder.poll()
                self.monitor.received += taken
                now = time.monotonic()
                if now - scanned > SCAN_S:
                    self._scan()
                    scanned = now
                if now - served > SERVE_S:
                    executor.spin_once(timeout_sec=0.0)
                    served = now
                elif not taken:
                    time.sleep(NAP_S)
            self.recorder.finish()
            self._bag.close()
        except OSError as error:
            # The writer has closed its file as it is, without the messages that were waiting.
            self.get_logger().fatal(str(error))
            stop.code = EXIT_FAULT
            self._say_what_is_in_it(_kept(self._bag.folder))
        else:
            self._say_what_is_in_it(self.recorder.counts)

    def _scan(self):
        """Subscribe to topics that have appeared."""
        recorder = self.recorder
        here = {name for name, _ in self.get_topic_names_and_types()}
        wanted = [n for n in self._named if n in here]
        if self.settings.record.all_topics:
            wanted += sorted(n for n in here - set(self._named) if not _hidden(n))
        now = time.monotonic()
        watch = now - self._watched > WATCH_S
        if watch:
            self._watched = now
        for name in wanted:
            if name in self._refused or (name in self._gids and not watch):
                continue
            infos = self.get_publishers_info_by_topic(name)
            if not infos:
                continue
            gids = self._gids.setdefault(name, set())
            gids.update(bytes(info.endpoint_gid) for info in infos)
            if name not in recorder.tracks:
                self._begin(name, infos)
            else:
                self._watch(recorder.tracks[name], infos)
            if name in recorder.tracks:
                recorder.tracks[name].gaps.publishers = len(gids)
        if self.settings.record.all_topics:
            recorder.settled = now - self._appeared > SETTLE_S
        absent = [n for n in self._named if n not in self._gids and n not in self._refused]
        if absent and not self._told_absent and now - self._started > ABSENT_S:
            self._told_absent = True
            self.get_logger().warning(f'waiting for {", ".join(absent)}: no publisher yet')

    def _begin(self, name, infos):
        type_name = infos[0].topic_type
        try:
            definition, type_hash = None, ''
            try:
                message_definition(type_name)
            except ValueError:
                definition = installed_definition(type_name)
                type_hash = str(infos[0].topic_type_hash)
            profile = qos.keep_last(self.settings.record.depth, *qos.offered_profile(infos))
            self.recorder.add(topics.Topic(name, type_name), profile, _as_yaml(infos), definition,
                              type_hash)
        except (ValueError, ImportError, AttributeError) as error:
            self._refused.add(name)
            self.get_logger().error(f'{name} is not recorded: {error}')
            return
        self._appeared = time.monotonic()
        self.get_logger().info(f'recording {name} ({type_name})')

    def _watch(self, track, infos):
        """Check that publishers that joined later are compatible with the subscription."""
        others = {info.topic_type for info in infos} - {track.type_name}
        reliability, durability = qos.offered_profile(infos)
        mine = track.queue.subscription.qos_profile
        weaker = (reliability == ReliabilityPolicy.BEST_EFFORT
                  and mine.reliability == ReliabilityPolicy.RELIABLE) or (
            durability == DurabilityPolicy.VOLATILE
            and mine.durability == DurabilityPolicy.TRANSIENT_LOCAL)
        if others == {info.topic_type for info in infos}:
            why = f'its type is {", ".join(sorted(others))}; expected {track.type_name}'
        elif weaker and not track.count:
            self.recorder.subscribe_anew(track, qos.keep_last(
                self.settings.record.depth, reliability, durability))
            return
        elif others or weaker:
            why = ('a later publisher has another type' if others else
                   'a later publisher offers a weaker quality of service') + ' and is not recorded'
        else:
            return
        if track.name not in self._weak:
            self._weak.add(track.name)
            self.monitor.fault(f'{track.name}: {why}')

    def _describe(self):
        """Return a fault, or '', and the values for /diagnostics."""
        tracks = self.recorder.tracks.values()
        lost = sum(track.gaps.lost + track.unwritten for track in tracks)
        wrong = ''
        if lost > self._lost:
            names = ', '.join(track.name for track in tracks if track.gaps.lost)
            wrong = f'{lost - self._lost} messages lost, of {names}'
        self._lost = lost
        return wrong, (('recorded', sum(track.count for track in tracks)), ('lost', lost),
                       ('repeated', sum(track.repeated for track in tracks)),
                       *((track.name, track.count) for track in tracks))

    def _say_what_is_in_it(self, written):
        log = self.get_logger().info
        for track in self.recorder.tracks.values():
            gaps = track.gaps
            lost = f'{gaps.lost + track.unwritten} lost' if gaps.known else 'losses unknown'
            if track.unwritten:
                lost += f' ({track.unwritten} of them still queued at the end)'
            if gaps.known and gaps.publishers > 1:
                lost += f' (of {gaps.publishers} publishers)'
            more = f', {track.repeated} repeated' if track.repeated else ''
            if gaps.before:
                more += f', {gaps.before} sent before the recorder had subscribed'
            missing, step_ns = track.holes.count()
            if missing and track.name != self.resolve_topic_name(topics.ACK.name):
                more += (f', {missing} missing of {missing + track.count} at '
                         f'{SECOND / step_ns:.6g} Hz by the stamps')
            log(f'{track.name} ({track.type_name}): {written.get(track.name, 0)} recorded, '
                f'{lost}{more}')
        log(f'{self._bag.folder}: {sum(written.values())} messages on {len(self.recorder.tracks)} '
            'topics')


def _kept(folder):
    """Return {topic: messages} of a bag that could not be completed."""
    try:
        with open_bag(folder) as bag:
            return {name: span.count for name, span in bag.spans().items()}
    except (ValueError, OSError):
        # There was not even room for the header of the file.
        return {}


def _hidden(name):
    return any(part.startswith('_') for part in name.split('/'))


def _as_yaml(infos):
    """Return the offered QoS profiles in the YAML format of the bag."""
    kinds = dict.fromkeys((info.qos_profile.durability.name.lower(),
                           info.qos_profile.reliability.name.lower()) for info in infos)
    return '\n'.join(bag_qos.profile_yaml(*kind) for kind in kinds)
