"""Operation of the node strapdown without truth: navigate on the samples of a real IMU."""

from dataclasses import replace
import math

import numpy as np

from ins_sim.core.standalone.fixes import PlaceFix
from ins_sim.core.standalone.mounted import LiveMounting
from ins_sim.core.standalone.navigator import StandaloneNavigator
from ins_sim.io import positions
from ins_sim.io.csv_names import UNITS
from ins_sim.io.magnetic_field import declination_source
from ins_sim.messages import topics
from ins_sim.messages.cdr import Reader
from ins_sim.messages.transforms import read_rotations
from ..transport import qos
from ..transport.backlog import HandQueue

STATIC_DEPTH = 100
# Magnetic fields above this are refused, T.
MOST_FIELD_T = 0.1


class StandaloneDrive:
    """
    Inputs and navigator of a StrapdownNode that runs without truth.

    Attributes
    ----------
    driver : Topic of the IMU
    stage : StandaloneNavigator
    """

    def __init__(self, node):
        self._node, settings = node, node.settings
        inputs, self._begun = settings.inputs, 0
        self.driver = replace(topics.IMU_RAW, name=inputs.imu)
        self._hears_transforms = _is_there(topics.TF_STATIC)
        self.stage = StandaloneNavigator(
            settings, LiveMounting(settings.mounting, node.names['base_link'],
                                   self._hears_transforms), declination_source(settings.initial))
        self._rate, self._force = (
            1.0 if unit == 'auto' else UNITS[kind][unit]
            for kind, unit in (('rate', settings.units.rate), ('force', settings.units.force)))
        if settings.vertical.channel == 'truth':
            self.stage.infos.append(
                f'vertical.channel is truth, but with initial.source {settings.initial.source} '
                f'there is no truth: the channel is damped towards vertical.reference, '
                f'{settings.vertical.reference} (vertical.channel: free leaves it undamped)')

    def make_queues(self):
        """Make the queues of GNSS fixes, pressure, magnetic field and static transforms."""
        node, inputs = self._node, self._node.settings.inputs
        self._fix_topic = replace(topics.GNSS_FIX, name=inputs.fix)
        self._readers = {
            self._fix_topic: (Reader(topics.FIX, ((0, 3), (3, 12))), self._on_fix),
            replace(topics.IMU_PRESSURE, name=inputs.pressure): (
                Reader(topics.PRESSURE, ((0, 1),)), self._on_pressure),
            replace(topics.IMU_MAG, name=inputs.magnetic_field): (
                Reader(topics.MAGNETIC, ((0, 3),)), self._on_field)}
        self.queues = {topic.name: HandQueue(node, topic, node.depth) for topic in self._readers}
        self._static = None
        if self._hears_transforms:
            self._static = HandQueue(node, topics.TF_STATIC, STATIC_DEPTH, qos.keep_last(
                STATIC_DEPTH, qos.ReliabilityPolicy.RELIABLE, qos.LATCHING))
        self._texts, self._measured = Reader(topics.IMU), Reader(topics.IMU, ((16, 17), (28, 29)))
        self._looked = False
        node.monitor.add(lambda: ('', (('state', self.stage.state),)))

    def take(self):
        """Process the messages of the other topics, and navigate on the waiting IMU samples."""
        node, outputs = self._node, []
        if self._static is not None:
            for data in node.taken_of(self._static):
                try:
                    self.stage.push_transforms({(parent.lstrip('/'), child.lstrip('/')): q
                                                for parent, child, q in read_rotations(data)})
                except ValueError as error:
                    node.monitor.fault(f'{topics.TF_STATIC.name}: {error}')
        for topic, (reader, give) in self._readers.items():
            for data in node.taken_of(self.queues[topic.name]):
                try:
                    outputs += give(data, *reader.read(data)) or ()
                except ValueError as error:
                    node.monitor.fault(f'{topic.name}: {error}; the message was dropped')
        self.publish(outputs + self.stage.drain())

    def _on_fix(self, data, t_ns, place, covariance):
        status, _, kind = self._readers[self._fix_topic][0].numbers(data)
        lat, lon, height = (np.array([value]) for value in place)
        good, dropped = positions.usable(lat, lon, height, np.array([status]))
        if not good[0]:
            self._node.monitor.fault(positions.sentence(self._fix_topic.name, 'fixes', 1, dropped))
            return []
        variance = max(covariance[0], covariance[4])
        sigma = math.sqrt(variance) if kind and 0.0 < variance < topics.UNMEASURED else None
        return self.stage.push_fix(PlaceFix(t_ns, *positions.track(lat, lon, height)[0].tolist(),
                                            sigma))

    def _on_pressure(self, data, t_ns, pressure):
        if not 1.0 < pressure[0] < 2e5:
            raise ValueError(f'the pressure is {pressure[0]:g} Pa; expected 1 to 2e5 Pa')
        self.stage.push_pressure(t_ns, pressure[0])

    def _on_field(self, data, t_ns, field):
        # Written as "not <" so that NaN is refused too.
        if not math.hypot(*field) < MOST_FIELD_T:
            raise ValueError(f'the field is {field} T; expected less than {MOST_FIELD_T:g} T')
        self.stage.push_field(t_ns, field)

    def on_message(self, data, sample):
        """Pass an IMU sample (t_ns, angular rate, specific force) to the stage."""
        stage = self.stage
        if not self._looked:
            self._looked = True
            self._look(data)
        t_ns, omega, f = sample
        self.take()
        self.publish(stage.push_imu(t_ns, tuple(self._rate * w for w in omega),
                                    tuple(self._force * a for a in f), data))

    def _look(self, data):
        """Store the frame of the first message; report quantities marked absent (REP-145)."""
        self.stage.samples.frame_id = self._texts.strings(data)[0]
        _, rate, force = self._measured.read(data)
        missing = [name for name, (first,) in (('angular_velocity', rate),
                                               ('linear_acceleration', force)) if first == -1.0]
        if missing:
            self._node.monitor.fault(f'{self.driver.name} has a covariance of -1, which means no '
                                     f'{" and no ".join(missing)} (REP-145); expected both')

    def publish(self, outputs):
        """Publish solutions, and log the notes, warnings and faults of the stage."""
        node, stage, log = self._node, self.stage, self._node.get_logger()
        while stage.infos:
            log.info(stage.infos.pop(0))
        while stage.warnings:
            node.monitor.fault(stage.warnings.pop(0))
        while stage.faults:
            node.fault(stage.faults.pop(0))
        for solved in outputs:
            if stage.begun != self._begun:
                self._begun = stage.begun
                if stage.located:
                    node.broadcaster.send_fixed(solved.t_ns)
            node.frame, node.reading = stage.run.frame, solved.tag
            node.publish_one(solved.t_ns, solved.rate, solved.state, (), solved.known)
            node.monitor.sent += 1

    def describe_reset(self):
        """Return the answer to ~/reset."""
        source = self._node.settings.initial.source
        return f'started anew from initial.source {source}; expected ' + {
            'alignment': 'a vehicle at rest', 'fix': 'fixes',
            'given': 'the vehicle in the state of initial.*'}[source]


def _is_there(topic):
    """Return whether the message type of a Topic can be imported."""
    try:
        qos.message_class(topic)
    except ImportError:
        return False
    return True
