"""Truth and solutions published by hand, for the tests of nodes that subscribe to them."""

from dataclasses import replace
import time

from ins_sim.settings.catalogue import build
from ins_sim.settings.velocity_meter import VelocityMeterSettings
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.settings.motion import MotionGeneratorSettings
from ins_sim.messages import topics
from ins_sim.messages.cdr import LAYOUTS
from ins_sim.messages.convert import truth_blocks
from support.live import Chain, GUARD_S, Listener
import numpy as np

DT = 10_000_000
SECOND = 1_000_000_000
ACK = replace(topics.ACK, frames=('',))
ODOMETRY_RUNS = ((0, 3), (3, 7), (43, 46), (46, 49))


class Stream:
    """A node under test, its messages on some topics, and the truth of a motion at 100 Hz."""

    def __init__(self, domain, folder, heard, motion=None, published=(topics.TRUTH_ODOMETRY,)):
        from ins_sim.ros.transport.qos import make_publisher
        self.chain = Chain(domain, folder)
        # The reader of the answers is created last: a node that has discovered it knows all
        # readers.
        self.listener = Listener(domain, (*heard, ACK))
        self.heard, self.raw = self.listener.heard, self.listener.raw
        self.seen = self.listener.diagnostics()
        self._out = {t: (t.writer() if t.type_name in LAYOUTS else None,
                         make_publisher(self.listener.node, t, 10000).publish) for t in published}
        self.settings = build(MotionGeneratorSettings, motion or {})
        self.frame = MapFrame(self.settings.datum, True)
        self._motion = make_motion(self.settings.motion, self.settings.datum, self.settings.earth)

    def truth(self, stamps_ns):
        """Return the Truth record at stamps."""
        return self._motion.at(np.asarray(stamps_ns, dtype=np.int64))

    def blocks(self, stamps_ns):
        """Return {Topic: values} of the truth at stamps, and of an IMU that senses it."""
        truth = self.truth(stamps_ns)
        return {**truth_blocks(self.frame, truth), topics.IMU_RAW: np.concatenate(
            [truth.omega_ib_b, truth.f_ib_b], axis=1)}

    def odometry(self, stamps_ns):
        """Return [(t_ns, r_m, q_mb, v_b, rate)] as nodes read them from truth/odometry."""
        reader = topics.TRUTH_ODOMETRY.reader(ODOMETRY_RUNS)
        rows = self.blocks(stamps_ns)[topics.TRUTH_ODOMETRY]
        return [reader.read(data) for data in topics.TRUTH_ODOMETRY.writer().pack_block(
            stamps_ns, rows)]

    def send(self, stamps_ns, topic=topics.TRUTH_ODOMETRY, values=None, poison=None):
        """
        Publish values, by default the truth, at stamps; poison: row whose last value becomes NaN.
        """
        writer, publish = self._out[topic]
        values = self.blocks(stamps_ns)[topic] if values is None else values
        if poison is not None:
            values[poison, -1] = np.nan
        for data in writer.pack_block(stamps_ns, values):
            publish(data)
            time.sleep(1e-4)

    def send_bytes(self, topic, data):
        """Publish one message."""
        self._out[topic][1](data)

    def begin(self, process, first=0):
        """
        Send the first sample until it is acknowledged, which shows that discovery is complete.
        """
        end = time.monotonic() + GUARD_S
        while not self.heard[ACK.name]:
            assert time.monotonic() < end and process.poll() is None, self.chain.text(process)
            for topic in self._out:
                if topic in (*topics.TRUTH, topics.IMU_RAW):
                    self.send(np.array([first * DT]), topic)
            time.sleep(0.1)
            self.listener.poll()
        time.sleep(0.3)

    def wait_ack(self, t_ns, timeout_s=GUARD_S):
        """Wait until a stamp is acknowledged."""
        self.listener.poll_until(lambda: t_ns in self.heard[ACK.name], timeout_s)

    def wait_counts(self, counts):
        """Wait until each Topic has the given number of stamps; they do not arrive together."""
        self.listener.poll_until(lambda: all(
            len(self.heard[topic.name]) >= count for topic, count in counts.items()))

    def wait_diagnosis(self, part, timeout_s=GUARD_S):
        """Wait until a message on /diagnostics contains this text."""
        self.listener.spin_until(lambda: any(part in message for _, _, message in self.seen),
                                 timeout_s)

    def close(self):
        """
        End all nodes on Ctrl-C, check that none printed a traceback, and return their exit codes.
        """
        codes = self.chain.end()
        self.listener.close()
        for process in self.chain.processes.values():
            assert 'Traceback' not in self.chain.text(process), self.chain.text(process)
        return codes


def offline_fixes(stream, stamps_ns, values, with_ins=True):
    """
    Return the VelocityFixes computed offline from the same odometry, the truth serving as the INS.
    """
    meter, fixes = VelocityMeter(build(VelocityMeterSettings, values)), []
    for t_ns, r_m, q_mb, v_b, _ in stream.odometry(stamps_ns):
        fixes += meter.push_truth(t_ns, v_b, stream.frame.geodetic_one(r_m, q_mb, v_b)[2])
        if with_ins:
            fixes += meter.push_ins(t_ns, v_b)
    return fixes
