"""IMUs that take streamed truth samples and return IMU samples."""

from functools import partial
import math
import warnings

import numpy as np

from ins_sim.core.numerics.compilation import plain_only
from ins_sim.core.numerics.instants import seconds
from ins_sim.core.streams.before_truth import BeforeTruth, LINE_S
from ins_sim.core.streams.faults import (check_finite, check_periods, MOST_PERIODS,
                                         StreamFault)
from ins_sim.core.streams.truth_buffer import FORCE_B, FORCE_M, RATE, TruthBuffer
from ..sensor import Sensor
from .ideal import MotionImu, Triads
from .increments import NODES
from .readings import components, joined, samples_of
from .turning import check_turning, NODE_S
from .with_errors import ImuWithErrors, with_errors

BLOCK = 256


def make_imu(settings, motion=None):
    """
    Return the IMU that ImuSensorSettings describe; every kind has push(...) and reset().

    Parameters
    ----------
    settings : ImuSensorSettings
    motion : the motion to evaluate if ``source`` is motion; not used if it is stream

    Raises
    ------
    ValueError
        If the motion turns too fast for the rate of the IMU, or if it is guided and ``source`` is
        motion.
    """
    if settings.source == 'stream':
        imu = StreamImu(settings)
    elif settings.motion.kind == 'guided':
        raise ValueError('source is motion with motion.kind guided; expected stream: a guided '
                         'motion is not known in advance')
    else:
        check_turning(settings, motion, 0.0, min(NODE_S, motion.end_s))
        imu = PacedImu(settings, motion)
    errors = with_errors(settings)
    return imu if errors is None else ImuWithErrors(imu, errors)


def stream_samples(truth, frame):
    """Return t_ns, q_mb, omega_ib_b, f_ib_b of each instant of a Truth record; frame: MapFrame."""
    return zip(truth.t_ns.tolist(), frame.attitude(truth).tolist(), truth.omega_ib_b.tolist(),
               truth.f_ib_b.tolist())


class StreamImu(Sensor):
    """
    The IMU that knows the motion only from streamed truth samples.

    Its samples are at t_first + j dt. Sample 0 has no interval before it and holds the rate and
    the specific force of the first instant. A sample is returned as soon as the truth covers it,
    so negative delays postpone it.
    """

    def __init__(self, settings):
        self._frozen = settings.history == 'frozen'
        self._triads = Triads(settings)
        self.pair = self._triads.pair
        self.reset()
        dt_ns, delays = self._triads.dt_ns, self._triads.attitude_delays
        self._node_ns = [round(dt_ns * (s - 1.0)) for s in NODES]
        self._rate_node_ns = [round(dt_ns * (s - 1.0)) for s in self._triads.rate_nodes]
        self._lead_ns = max(0, -min(delays))
        longest_s = 1e-9 * max(delays)
        if longest_s > LINE_S and not self._frozen:
            warnings.warn(f'a channel is delayed by {longest_s * 1e3:.6g} ms, but a stream is '
                          f'continued backwards by {LINE_S * 1e3:g} ms only and is constant '
                          f'before that; the first {longest_s - LINE_S:.6g} s of readings are '
                          'therefore wrong. Set source to motion: it knows the motion before '
                          'the start',
                          stacklevel=2)

    def reset(self):
        """Forget everything; the next sample is the first."""
        triads = self._triads
        triads.begin()
        wanted = (RATE, FORCE_B) if triads.integrated else (FORCE_M,)
        delays = triads.attitude_delays
        reach_ns = max(0, max(delays)) + 2 * triads.dt_ns + max(0, -min(delays))
        before = partial(BeforeTruth, frozen=self._frozen, delay_ns=max(0, max(delays)))
        self._buffer = TruthBuffer(triads.frame, reach_ns, before, wanted, triads.dt_ns,
                                   None if triads.integrated else triads.dt_ns)
        self._next_ns = None
        self._q_start = None

    @property
    def next_made_ns(self):
        """Motion time of the next reading to be computed, ns; None before the first."""
        return self._next_ns

    def push(self, t_ns, q_mb, omega_ib_b, f_ib_b):
        """
        Process one truth sample and return the readings that it completes.

        The first sample may be repeated; its result is then returned again.

        Parameters
        ----------
        t_ns : motion time, ns
        q_mb : attitude relative to the map frame
        omega_ib_b : angular rate of the body in inertial space, rad/s
        f_ib_b : specific force, m/s^2

        Returns
        -------
        list of (t_ns, omega, f, parity or None)

        Raises
        ------
        StreamFault
            As ``TruthBuffer.push`` does.
        """
        buffer = self._buffer
        if not (buffer.count_is_one and t_ns == buffer.newest_ns):
            buffer.push(t_ns, q_mb, omega_ib_b, f_ib_b)
        if buffer.count_is_one:
            self._next_ns = t_ns + self._triads.dt_ns
            return [(t_ns, *self._triads.instant(t_ns, omega_ib_b, f_ib_b))]
        readings = []
        while self._next_ns + self._lead_ns <= t_ns:
            readings.append((self._next_ns, *self._read(self._next_ns)))
            self._next_ns += self._triads.dt_ns
        return readings

    def samples(self, truth):
        """Return the arguments of push for each instant of a Truth record."""
        return stream_samples(truth, self._triads.frame)

    def advance(self, truth):
        """
        Return the ImuSamples of a Truth record or of a part of one; same bits as single pushes.

        Raises StreamFault as ``push`` does. Its ``readings`` are the samples before the fault, its
        ``index`` the truth sample that caused it.
        """
        q_mb = components(self._triads.frame.attitude(truth))
        sample = (truth.t_ns, q_mb, components(truth.omega_ib_b), components(truth.f_ib_b))
        done, parts = 0, []
        while done < len(truth.t_ns):
            rest = (sample[0][done:], *(tuple(x[done:] for x in v) for v in sample[1:]))
            count, block = self._buffer.push_block(*rest)
            try:
                if count:
                    parts.append(self._read_block(block, rest[0][:count]))
                else:
                    one = ([float(x[0]) for x in vector] for vector in rest[1:])
                    parts.append(samples_of(self.push(int(rest[0][0]), *one)))
            except StreamFault as fault:
                fault.readings = joined([*parts, fault.readings])
                fault.index += done
                raise
            done += count or 1
        return joined(parts)

    def _read_block(self, block, stamps):
        """Return the samples that new truth (a TruthBlock with these stamps) completes."""
        triads, dt_ns = self._triads, self._triads.dt_ns
        count = max(0, (int(stamps[-1]) - self._lead_ns - self._next_ns) // dt_ns + 1)
        if not count:
            return samples_of([])
        t_ns = self._next_ns + dt_ns * np.arange(count, dtype=np.int64)
        self._next_ns += dt_ns * count
        newest = np.searchsorted(stamps, t_ns + self._lead_ns)

        def nodes(delays, field, offsets):
            return [[block.cubic(t_ns + (o - d), newest, field) for o in offsets] for d in delays]

        if triads.integrated:
            try:
                return triads.integrals_block(
                    t_ns, nodes(triads.gyro_delays, RATE, self._rate_node_ns),
                    nodes(triads.accel_delays, FORCE_B, self._node_ns))
            except StreamFault as fault:
                fault.index = int(newest[len(fault.readings)])
                raise
        if self._q_start is None:
            self._q_start = [block.attitude(t_ns[:1] - dt_ns - d, newest[:1])[0].tolist()
                             for d in triads.attitude_delays]
        ends = [block.attitude(t_ns - d, newest) for d in triads.attitude_delays]
        forces = nodes(triads.accel_delays, FORCE_M, self._node_ns)
        samples = triads.rotated_block(t_ns, self._q_start, ends, forces)
        self._q_start = [tuple(q[-1].tolist()) for q in ends]
        return samples

    def _read(self, t_ns):
        triads, buffer = self._triads, self._buffer
        if triads.integrated:
            rates = self._nodes(t_ns, triads.gyro_delays, RATE, self._rate_node_ns)
            return triads.integrals(t_ns, rates, self._nodes(t_ns, triads.accel_delays, FORCE_B,
                                                             self._node_ns))
        if self._q_start is None:
            self._q_start = [buffer.attitude(t_ns - triads.dt_ns - d)
                             for d in triads.attitude_delays]
        q_end = [buffer.attitude(t_ns - d) for d in triads.attitude_delays]
        forces = self._nodes(t_ns, triads.accel_delays, FORCE_M, self._node_ns)
        reading = triads.rotated(self._q_start, q_end, forces)
        self._q_start = q_end
        return reading

    def _nodes(self, t_ns, delays, field, offsets):
        cubic = self._buffer.cubic
        return [[cubic(t_ns + o - d, field) for o in offsets] for d in delays]


class PacedImu(Sensor):
    """
    The IMU that evaluates the motion which its own parameters describe.

    It uses only the stamps of the stream, which tell it how far to go.
    """

    def __init__(self, settings, motion):
        self._settings = settings
        self._motion = motion
        self._triads = Triads(settings)
        self.pair = self._triads.pair
        self.reset()

    def reset(self):
        """Forget everything; the next stamp is the first instant."""
        self._imu = None
        self._ready = []

    @property
    def next_made_ns(self):
        """Motion time of the next reading to compute, ns, up to a block ahead; None at first."""
        return None if self._imu is None else self._imu.next_ns

    def push(self, t_ns, q_mb, omega_ib_b, f_ib_b):
        """Return the readings up to the stamp t_ns, in the form of StreamImu.push."""
        check_finite('truth', t_ns, q_mb, omega_ib_b, f_ib_b)
        if self._imu is None:
            self._imu = MotionImu(self._settings, self._motion, t_ns, self._triads)
            self._first = []
            self._first_ns = self._last_ns = t_ns
        if t_ns < self._last_ns:
            raise StreamFault(f'truth jumps back from {seconds(self._last_ns)} to '
                              f'{seconds(t_ns)}; expected rising stamps', restart=True)
        if t_ns == self._last_ns and self._first:
            return self._first if t_ns == self._first_ns else []
        check_periods(t_ns, self._last_ns, 0, MOST_PERIODS * self._triads.dt_ns)
        self._last_ns = t_ns
        readings = []
        while (self._ready or self._compute()) and self._ready[-1][0] <= t_ns:
            readings.append(self._ready.pop())
        if not self._first:
            self._first = readings
        return readings

    def samples(self, truth):
        """Return the arguments of push for each instant of a Truth record."""
        return stream_samples(truth, self._triads.frame)

    def advance(self, truth):
        """
        Return the ImuSamples of a Truth record or of a part of one; same bits as single pushes.

        Raises StreamFault as ``push`` does, with ``readings`` and ``index``.
        """
        readings = []
        for index, sample in enumerate(self.samples(truth)):
            try:
                readings += self.push(*sample)
            except StreamFault as fault:
                fault.readings, fault.index = samples_of(readings), index
                raise
        return samples_of(readings)

    def _compute(self):
        """Compute the next block, up to the end of the motion; return False if at the end."""
        imu, end_s = self._imu, self._motion.end_s
        left = BLOCK
        if end_s != math.inf:
            left = min(BLOCK, (round(end_s * 1e9) - imu.next_ns) // imu.dt_ns + 1)
        if left <= 0:
            return False
        with plain_only():
            block = imu.advance(left)
        parity = [None] * left if block.parity is None else block.parity.tolist()
        self._ready = list(zip(block.t_ns.tolist(), map(tuple, block.omega.tolist()),
                               map(tuple, block.f.tolist()), parity))[::-1]
        return True
