"""Matching of two live streams, IMU and truth, by their stamps."""

from collections import deque

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.numerics.instants import period_ns, seconds
from .faults import check_finite, check_interval, check_unit, StreamFault
from .restarts import LastStamps, RestartDetector

# Number of truth samples kept for later readings: 100 s at 100 Hz.
TRUTH_LENGTH = 10_000


class MatchedStreams:
    """
    Base class of navigators that take live IMU readings and truth with the same stamps.

    A subclass has begin(), which forgets the solution, ``navigates``, and advance(t_ns, omega, f,
    truth) -> outputs, where truth is (lat, lon, height, v_n, q_nb).

    The push methods return a list of outputs and raise StreamFault. The first IMU sample may be
    repeated; its result is then returned again. The result does not depend on which stream is
    ahead. If one stream jumps back, samples of the other from before the jump are not matched.

    Parameters
    ----------
    settings : settings with datum, earth and rate_hz
    truth_length : number of truth samples that are kept until the IMU sample arrives

    Attributes
    ----------
    processed_ns : motion time of the last IMU sample that was used, or None
    faults : faults, such as a gap, of samples that had to wait behind others; the push methods
        could not raise them. The owner removes them
    """

    def __init__(self, settings, truth_length=TRUTH_LENGTH):
        self._settings = settings
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        self._dt_ns = period_ns(settings.rate_hz)
        self._truth = deque(maxlen=truth_length)
        self._joined_ns = None
        self.faults = []
        self._forget_streams()
        self.reset()

    def reset(self):
        """Forget the solution: the next IMU sample starts a new one. Stored truth is kept."""
        self._imu, self._gaps = deque(), {}
        self._last_ns = None
        self._start_anew()

    def rejoin(self):
        """Forget everything, as if both streams began now, because one of them stays silent."""
        self._forget_streams()
        self._truth.clear()
        self.reset()

    def _forget_streams(self):
        # For the detector the IMU is the first stream and the truth the second.
        self._runs, self._truth_ns = RestartDetector(), None
        self._imu_stamps, self._truth_stamps = LastStamps(), LastStamps()
        self._truth_step_ns = None

    @property
    def parted(self):
        """Return whether one stream has jumped back and the other has not followed."""
        return not self._runs.same_run

    def _start_anew(self):
        self.begin()
        self.processed_ns = self._repeat = None
        self._steps = 0

    @property
    def waiting(self):
        """Return whether an IMU sample is queued that cannot be used yet."""
        return bool(self._imu)

    def held(self, t_ns):
        """Return whether an IMU sample must wait for something besides its truth."""
        return False

    def go_on(self):
        """Wait only for the truth from now on, because too many samples wait; return outputs."""
        return []

    def push_imu(self, t_ns, omega, f):
        """
        Process an IMU sample and return the outputs that become possible.

        Parameters
        ----------
        t_ns : motion time, ns
        omega : mean angular rate, rad/s
        f : mean specific force, m/s^2
        """
        check_finite('imu', t_ns, omega, f)
        if self._repeat is not None and t_ns == self._repeat[0]:
            return self._repeat[1]
        if self._last_ns is not None and not (t_ns == self._last_ns and self._steps <= 1):
            self._check_interval(t_ns)
            self._repeat = None
        elif t_ns == self._last_ns:
            return []
        self._last_ns = t_ns
        if self._imu_stamps.take(t_ns):
            self._runs.first_returns()
        if len(self._imu) >= self._truth.maxlen:
            raise StreamFault(f'{len(self._imu)} imu readings wait for their truth or fixes, from '
                              f'{seconds(self._imu[0][0])} on; expected fewer than topics.depth',
                              restart=True)
        self._imu.append((t_ns, omega, f))
        return self.match()

    def _check_interval(self, t_ns):
        try:
            check_interval('imu', t_ns, self._last_ns, self._dt_ns)
        except StreamFault as fault:
            if t_ns < self._last_ns and not self._imu_stamps.was_ahead(t_ns):
                self._runs.first_jumps(t_ns, self._truth_ns)
                if self._runs.first_is_ahead:
                    self._truth.clear()
            if not self._imu or t_ns <= self._last_ns:
                raise
            self._gaps[t_ns] = fault

    def push_truth(self, t_ns, r_m, q_mb, v_b):
        """
        Process the truth of stamp t_ns (motion time).

        A repeated stamp is ignored. A stamp that jumps back begins a new run; the fault is
        reported for the IMU, which jumps back too.

        Parameters
        ----------
        t_ns : motion time, ns
        r_m, q_mb : pose in the map frame; position in m
        v_b : velocity in body axes, m/s
        """
        check_finite('truth', t_ns, r_m, q_mb, v_b)
        check_unit('truth', t_ns, q_mb)
        if t_ns == self._truth_ns:
            return []
        if self._truth_ns is not None and t_ns - self._truth_ns != self._truth_step_ns:
            self._follow_truth(t_ns)
        self._truth_ns = t_ns
        if self._truth_stamps.take(t_ns):
            self._runs.second_returns()
        if self._runs.first_is_ahead:
            return []
        if not self._truth:
            self._joined_ns = t_ns
        outputs = []
        if len(self._truth) == self._truth.maxlen and self._imu:
            # The oldest truth sample is about to be dropped, and a reading may need it.
            outputs = self.go_on()
        self._truth.append((t_ns, r_m, q_mb, v_b))
        return outputs + self.match()

    def _follow_truth(self, t_ns):
        step_ns, truth = t_ns - self._truth_ns, self._truth
        if step_ns > 0:
            self._truth_step_ns = min(step_ns, self._truth_step_ns or step_ns)
        elif self._truth_stamps.was_ahead(t_ns):
            while truth and truth[-1][0] > t_ns:
                truth.pop()
        else:
            truth.clear()
            self._runs.second_jumps(t_ns, self._last_ns)

    def match(self):
        """Use the samples that have their counterpart; return the outputs."""
        outputs = []
        imu, truth = self._imu, self._truth
        while imu and truth and self._runs.same_run:
            t_ns, omega, f = imu[0]
            while len(truth) > 1 and truth[0][0] < t_ns:
                truth.popleft()
            if truth[0][0] < t_ns:
                break
            if t_ns in self._gaps:
                self._end(self._gaps.pop(t_ns))
            if truth[0][0] > t_ns:
                imu.popleft()
                # Otherwise the streams began at different times: skip what came before.
                if self.navigates or truth[0][0] != self._joined_ns:
                    self._end(StreamFault(self._why_alone(t_ns, truth[0][0]), restart=True))
                continue
            if self.held(t_ns):
                break
            imu.popleft()
            outputs.extend(self._use(t_ns, omega, f, self._frame.geodetic_one(*truth[0][1:])))
        return outputs

    def _why_alone(self, t_ns, truth_ns):
        nearest = (f'imu at {seconds(t_ns)} has no truth of the same stamp, the nearest is '
                   f'{seconds(truth_ns)}')
        step_ns = self._truth_step_ns
        if step_ns and (truth_ns - t_ns) % step_ns == 0:
            return (f'{nearest}; that truth sample was lost, probably because a node cannot keep '
                    'up and a queue overflowed: expected a lower rate_hz or real_time_factor, or '
                    'more topics.depth')
        return (f'{nearest}; expected a truth rate that is a multiple of the IMU rate, both from '
                'the same start: rate_hz must be consistent in all nodes (imu_time: nominal for '
                'stamps with jitter or latency)')

    def _end(self, fault):
        self.faults.append(fault)
        self._start_anew()

    def _use(self, t_ns, omega, f, truth):
        self.processed_ns = t_ns
        output = self.advance(t_ns, omega, f, truth)
        if output and self._steps == 0 and t_ns == self._last_ns:
            self._repeat = (t_ns, output)
        self._steps += bool(output)
        return output
