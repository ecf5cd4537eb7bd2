"""The node strapdown without truth, fed with messages of a real or synthetic IMU, without DDS."""

from collections import defaultdict

import numpy as np
from support.hostile.fed_nodes import FedNodes
from support.nodes.live_imu import LIVE

from ins_sim.messages import topics
from ins_sim.messages.cdr import Writer
from ins_sim.messages.transforms import TransformWriter

IMU, FIX = topics.IMU_RAW.name, topics.GNSS_FIX.name


class RealImuGraph(FedNodes):
    """Node strapdown; parameters in addition to LIVE; ``heard`` is {topic: {stamp_ns: bytes}}."""

    def __init__(self, **parameters):
        super().__init__({'strapdown': {**LIVE, **parameters}})

    def __enter__(self):
        super().__enter__()
        self.node = self.nodes['strapdown']
        self.heard = defaultdict(dict)
        self.bus.listen = lambda name, data: self.heard[name].update(
            {self.bus.newest_ns[name]: data})
        return self

    @property
    def said(self):
        """All log messages of the node as one text."""
        return '\n'.join(self.logs['strapdown'].kept)

    def call(self, service):
        """Call ~/align or ~/reset; return success and message."""
        from std_srvs.srv import Trigger
        found = {'align': self.node._on_align, 'reset': self.node._on_reset}[service](
            Trigger.Request(), Trigger.Response())
        return found.success, found.message

    def send(self, messages):
        """Send (topic, bytes), and let the node process each message."""
        for name, data in messages:
            self.bus.put(name, data)
            self.bus.drive()
        for _ in range(1000):
            if not self.node.stage.waiting:
                break
            self.clock.pass_by(0.01)

    def transforms(self, parent, child, q):
        """Send a transform on /tf_static."""
        data = TransformWriter((parent, child)).pack(0, (0.0, 0.0, 0.0, *q))
        self.send([(topics.TF_STATIC.name, data)])


def messages_of(imu, fixes=(), frame='base_link'):
    """Return (topic, bytes) of a RecordedImu and PlaceFixes in the order of their stamps."""
    pack = Writer(topics.IMU, frame, constants={3: 1.0, 4: -1.0}).pack
    pack_fix = Writer(topics.FIX, 'gps', runs=((0, 3),)).pack
    rows = [(t_ns, IMU, pack(t_ns, (0.0, 0.0, 0.0, 1.0), tuple(w), tuple(f)))
            for t_ns, w, f in zip(imu.t_ns.tolist(), imu.omega.tolist(), imu.f.tolist())]
    rows += [(f.t_ns, FIX, pack_fix(f.t_ns, (*np.degrees(f[1:3]).tolist(), f.height)))
             for f in fixes]
    return [row[1:] for row in sorted(rows, key=lambda row: row[0])]
