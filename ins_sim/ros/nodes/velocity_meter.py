"""Node velocity_meter: simulate the correlation velocity meter from the streamed truth."""

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.messages import topics, velocity_record
from ins_sim.messages.placements import meter_mounting
from ins_sim.messages.plausible import PlausibleReader
from ins_sim.settings.velocity_meter import VelocityMeterSettings
from ..transport import qos
from ..transport.arriving import Arriving
from ..transport.backlog import HandQueue
from ..transport.broadcaster import Broadcaster
from ..transport.patience import MISSING_S, Patience
from .stage import StageNode


class VelocityMeterNode(StageNode):
    """
    Velocity meter: truth/odometry in; velocity_meter/record and, for valid fits, .../velocity out.

    With attack_angle ``ins`` it also reads ins/odometry, and each measurement window waits for
    the INS solution at its end.
    """

    NAME = 'velocity_meter'
    SETTINGS = VelocityMeterSettings
    DRIVER = topics.TRUTH_ODOMETRY

    def make_stage(self):
        """Return the simulated velocity meter."""
        settings = self.settings
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        self._meter = VelocityMeter(settings)
        return Arriving(self._meter)

    def make_broadcaster(self):
        """Return the Broadcaster of the mounting of the antennas."""
        return Broadcaster(self, self.settings, fixed={'': meter_mounting(self.settings)})

    def make_outputs(self):
        """Make publishers, readers and the queue of the INS."""
        self._reader = PlausibleReader(topics.TRUTH_ODOMETRY, ((0, 3), (3, 7), (43, 46)))
        self._record, self._velocity = (qos.make_publisher(self, topic, self.depth) for topic in (
            topics.METER_RECORD, topics.METER_VELOCITY))
        self._pack = topics.METER_VELOCITY.named(self.names).writer().pack
        self._windows = self._invalid = 0
        self._reason = ''
        self.monitor.add(self._describe)
        self._newest_ns, self._dt_ns = None, period_ns(self.settings.rate_hz)
        self._absent = False
        self._ins = None
        if self.settings.attack_angle == 'ins':
            self._ins_reader = PlausibleReader(topics.INS_ODOMETRY, ((43, 46),))
            self._ins = HandQueue(self, topics.INS_ODOMETRY, self.depth)
        self._patience = Patience(self, lambda: self._meter.waits_for_ns is not None,
                                  lambda: (self._windows, self._meter.ins_reached_ns),
                                  self._take_ins, self._miss_ins, self._settle)

    def hand_queues(self):
        """Return the queue of the INS, if it is read."""
        return {} if self._ins is None else {topics.INS_ODOMETRY.name: self._ins}

    def start_anew(self):
        """Discard all received data, including INS solutions."""
        self._newest_ns = None
        self.stage.reset()
        self._meter.rejoin()

    def on_message(self, data):
        """Process one truth message and the INS solutions that have arrived."""
        sample = self.read(self._reader, data)
        if sample is None:
            return
        t_ns, r_m, q_mb, v_b = sample
        height = self._frame.geodetic_one(r_m, q_mb, v_b)[2]
        self._publish(self.push(self.stage.advance, (t_ns, self._meter.push_truth, v_b, height)))
        self._newest_ns = t_ns
        self._take_ins()
        if self._absent:
            self._publish(self.stage.add(self._meter.give_up_ins()))
        self._patience.wait()

    def _take_ins(self):
        for data in () if self._ins is None else self.taken_of(self._ins):
            self._absent = False
            sample = self.read(self._ins_reader, data)
            if sample is not None:
                self._publish(self.stage.add(self.push(self._meter.push_ins, sample)))

    def _miss_ins(self):
        self._absent = True
        if self._meter.parted:
            self.fault(f'the stamps of one of {self.DRIVER.name} and {topics.INS_ODOMETRY.name} '
                       'have jumped back, and those of the other have not followed within '
                       f'{MISSING_S:g} s; expected both topics from one run: from now on they are '
                       'treated as belonging to one run')
        else:
            self.fault(f'no message on {topics.INS_ODOMETRY.name} in {MISSING_S:g} s; expected '
                       'the solution up to the end of every window (with attack_angle: none the '
                       'velocity meter needs no INS)')
        self._publish(self.stage.add(self._meter.give_up_ins()))

    def _settle(self):
        end_ns = self._meter.waits_for_ns
        if end_ns is not None:
            self.seen_so_far(end_ns - self._dt_ns)
        elif self._newest_ns is not None:
            self.seen(self._newest_ns)

    def _publish(self, fixes):
        for fix in fixes:
            self._record.publish(velocity_record.pack_fix(fix, self.epoch_ns,
                                                          self.names))
            self._windows += 1
            if fix.valid:
                t_ns, *runs = velocity_record.velocity_one(fix)
                self._velocity.publish(self._pack(t_ns + self.epoch_ns, *runs))
            else:
                self._invalid += 1
                self._reason = fix.status
            self.monitor.sent += 1

    def change(self, settings):
        """Apply new drop-outs from the next window that ends."""
        self._meter.change(settings)

    def effective_ns(self, name):
        """Return the motion time at which the next window ends, ns."""
        return self._meter.next_end_ns

    def _describe(self):
        """Return '' (this never reports a fault) and the values for /diagnostics."""
        return '', (('windows', self._windows), ('invalid fits', self._invalid),
                    ('last reason', self._reason))
