"""Faulty streams: a node reports the fault in its log and /diagnostics, and starts anew."""

import time

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.messages import topics
from ins_sim.messages.convert import truth_blocks
from support.live import Chain, Listener
import numpy as np
import pytest
from support import studies

pytest.importorskip('rclpy')
pytestmark = pytest.mark.live

PARAMETERS = {'rate_hz': 100.0, 'motion.kind': 'two_axis'}
DT = 10_000_000


class Source:
    """The nodes of a chain without generator, and truth at any stamps."""

    def __init__(self, domain, folder, parameters=None):
        self.chain = Chain(domain, folder)
        self.listener = Listener(domain, (topics.IMU_RAW, topics.INS_ODOMETRY))
        self.diagnostics = self.listener.diagnostics()
        from ins_sim.ros.transport.qos import make_publisher
        self._out = [(t, t.writer(), make_publisher(self.listener.node, t, 2000).publish)
                     for t in (topics.TRUTH_ODOMETRY, topics.TRUTH_IMU)]
        settings = studies.settings(PARAMETERS).motion_generator
        self._motion = make_motion(settings.motion, settings.datum, settings.earth)
        self._frame = MapFrame(settings.datum, True)
        parameters = {**PARAMETERS, **(parameters or {})}
        self.imu = self.chain.start('imu_sensor', parameters)
        self.strapdown = self.chain.start('strapdown', parameters)

    def send(self, stamps_ns, poison=None):
        """Publish the truth at stamps; poison: index of a sample with a NaN."""
        stamps_ns = np.asarray(stamps_ns, dtype=np.int64)
        blocks = truth_blocks(self._frame, self._motion.at(stamps_ns))
        for topic, writer, publish in self._out:
            values = blocks[topic].copy()
            if poison is not None:
                values[poison, -1] = np.nan
            for data in writer.pack_block(stamps_ns, values):
                publish(data)
                time.sleep(1e-4)

    def begin(self):
        """Send sample 0 until it is acknowledged, then a second of truth."""
        heard = self.listener.heard['ins/odometry']
        end = time.monotonic() + 60.0
        while not heard:
            assert time.monotonic() < end, self.chain.text(self.strapdown)
            self.send([0])
            time.sleep(0.1)
            self.listener.poll()
        self.send(np.arange(1, 101) * DT)
        self.wait_solution(100 * DT)

    def wait_solution(self, t_ns):
        """Wait until the solution with this stamp is received."""
        self.listener.poll_until(lambda: t_ns in self.listener.heard['ins/odometry'], 30.0)

    def wait_diagnosis(self, node, part):
        """Wait until /diagnostics contains this text about a node."""
        try:
            self.listener.spin_until(lambda: any(
                node in name and part in message for name, _, message in self.diagnostics))
        except AssertionError:
            raise AssertionError(f'{node}: {part!r} not in {self.diagnostics}') from None

    def close(self):
        """End all processes."""
        self.chain.end()
        self.listener.close()


@pytest.fixture
def source(ros_domain, tmp_path):
    source = Source(ros_domain, tmp_path)
    yield source
    source.close()


def test_nan_is_dropped_and_reported(source):
    """Truth with NaN is dropped and reported; solutions continue and are finite."""
    source.begin()
    source.send(np.arange(101, 201) * DT, poison=50)
    source.chain.wait_text(source.imu, 'nan')
    source.wait_diagnosis('imu_sensor', '')
    source.wait_solution(200 * DT)
    values = source.listener.heard['ins/odometry'].values()
    assert np.isfinite(np.array(list(values))).all()


def test_a_jump_back_is_reported_and_starts_anew(source):
    """Truth that jumps back by 1 s is reported by both nodes, and solutions start anew."""
    source.begin()
    source.listener.heard['ins/odometry'].clear()
    source.send(np.arange(0, 51) * DT)
    source.chain.wait_text(source.imu, 'truth jumps back from 1.000000000 s to 0.000000000 s')
    source.chain.wait_text(source.strapdown, 'jumps back')
    source.wait_diagnosis('strapdown', 'jumps back')
    source.wait_solution(50 * DT)


def test_a_gap_is_reported_and_never_integrated_over(source):
    """A gap from 1 s to 3 s is reported, and no solution lies within it."""
    source.begin()
    source.send(np.arange(300, 351) * DT)
    source.chain.wait_text(source.imu, 'gap from 1.000000000 s to 3.000000000 s')
    source.wait_solution(350 * DT)
    heard = source.listener.heard['ins/odometry']
    assert not [t for t in heard if 100 * DT < t < 300 * DT]


def test_truth_that_stops_is_reported(source):
    """If the truth stops, the log and /diagnostics name the missing topic."""
    source.begin()
    source.chain.wait_text(source.imu, 'no message on truth/imu')
    source.wait_diagnosis('imu_sensor', 'no message on truth/imu')
    source.chain.wait_text(source.strapdown, 'no message on imu/data_raw')


def test_imu_without_truth_is_reported(source):
    """Without truth/odometry the strapdown reports it, and continues when it returns."""
    source.begin()
    silent, source._out[0] = source._out[0], (*source._out[0][:2], lambda data: None)
    source.send(np.arange(101, 201) * DT)
    source.chain.wait_text(source.strapdown, 'no message on truth/odometry')
    source.wait_diagnosis('strapdown', 'truth')
    source._out[0] = silent
    source.send(np.arange(201, 301) * DT)
    source.wait_solution(300 * DT)


def test_imu_at_another_rate_is_reported(ros_domain, tmp_path):
    """An IMU at twice the rate of the strapdown is reported with the expected step."""
    source = Source(ros_domain, tmp_path)
    other = source.chain.start('strapdown', {**PARAMETERS, 'rate_hz': 50.0},
                               ['-r', 'ins/odometry:=elsewhere', '-r', '__node:=other'])
    try:
        source.begin()
        # Readings are published whenever this strapdown starts to receive.
        sample, end = 101, time.monotonic() + 60.0
        while 'imu comes at another rate' not in source.chain.text(other):
            assert time.monotonic() < end, source.chain.text(other)
            source.send(np.arange(sample, sample + 10) * DT)
            sample += 10
            time.sleep(0.05)
        source.wait_diagnosis('other', 'expected steps of 0.02 s')
    finally:
        source.close()


def test_on_fault_stop_ends_with_code_3(ros_domain, tmp_path):
    """With on_fault stop a jump back ends the node with exit code 3."""
    source = Source(ros_domain, tmp_path, {'on_fault': 'stop'})
    try:
        source.begin()
        source.send([0])
        assert source.imu.wait(20.0) == 3
        text = source.chain.text(source.imu)
        assert 'jumps back' in text and 'Traceback' not in text
    finally:
        source.close()
