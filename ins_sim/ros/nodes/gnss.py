"""Node gnss: simulate the fixes of a GNSS receiver from the streamed truth."""

from std_srvs.srv import SetBool

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.messages import topics
from ins_sim.messages.gnss_fixes import GnssWriter
from ins_sim.messages.placements import gnss_mounting
from ins_sim.messages.plausible import PlausibleReader
from ins_sim.settings.gnss import GnssSettings
from ..transport import qos
from ..transport.arriving import Arriving
from ..transport.broadcaster import Broadcaster
from .stage import StageNode


class GnssNode(StageNode):
    """GNSS receiver: truth/odometry in; gnss/fix and, for valid fixes, gnss/velocity out."""

    NAME = 'gnss'
    SETTINGS = GnssSettings
    DRIVER = topics.TRUTH_ODOMETRY

    def make_stage(self):
        """Return the simulated receiver."""
        settings = self.settings
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        self._receiver = Gnss(settings)
        return Arriving(self._receiver)

    def make_broadcaster(self):
        """Return the Broadcaster of the lever arm of the antenna."""
        return Broadcaster(self, self.settings, fixed={'': gnss_mounting(self.settings)})

    def begin_announced(self):
        """Convert motion time to stamps with the announced epoch."""
        self._writer.epoch_ns = self.epoch_ns

    def make_outputs(self):
        """Make publishers, reader and writer, and the service that forces an outage."""
        self._reader = PlausibleReader(topics.TRUTH_ODOMETRY,
                                       ((0, 3), (3, 7), (43, 46), (46, 49)))
        self._writer = GnssWriter(0, self.names)
        self._fix, self._velocity = (qos.make_publisher(self, topic, self.depth) for topic in (
            topics.GNSS_FIX, topics.GNSS_VELOCITY))
        self._fixes = self._outages = 0
        self.monitor.add(self._describe)
        self.create_service(SetBool, '~/outage', self._on_outage)

    def on_message(self, data):
        """Process one truth message, and publish the fixes that are available at its instant."""
        sample = self.read(self._reader, data)
        if sample is None:
            return
        t_ns, r_m, q_mb, v_b, rate = sample
        truth = (*self._frame.geodetic_one(r_m, q_mb, v_b), rate)
        for fix in self.push(self.stage.advance, (t_ns, self._receiver.push, truth)):
            self._fix.publish(self._writer.fix(fix))
            if fix.valid:
                self._velocity.publish(self._writer.velocity(fix))
            self._fixes += fix.valid
            self._outages += not fix.valid
            self.monitor.sent += 1
        self.seen(t_ns)

    def change(self, settings):
        """Apply new outages and jumps from the next fix on."""
        self._receiver.change(settings)

    def effective_ns(self, name):
        """Return the motion time of the next fix, ns."""
        return self._receiver.next_ns

    def _describe(self):
        """Return '' (this never reports a fault) and the values for /diagnostics."""
        return '', (('fixes', self._fixes), ('outages', self._outages),
                    ('outage forced', self._receiver.forced))

    def _on_outage(self, request, response):
        self._receiver.force_outage(request.data)
        response.success = True
        response.message = ('no fixes from now on' if request.data else
                            'fixes again, except during gnss.outages')
        self.get_logger().info(response.message)
        return response
