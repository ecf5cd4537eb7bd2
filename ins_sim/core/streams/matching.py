"""Two live streams, IMU and truth, matched by their stamps."""

from collections import deque

from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.numerics.instants import period_ns, seconds
from .faults import check_finite, check_interval, check_unit, StreamFault
from .restarts import LastStamps, RestartDetector

# Samples of truth that are kept for the readings to come: 100 s at 100 Hz.
TRUTH_LENGTH = 10_000


class MatchedStreams:
    """
    What a navigator does with live readings of the IMU and the truth of the same stamps.

    A subclass has begin(), which forgets the solution, ``navigates``, and advance(t_ns, omega, f,
    truth) -> outputs, truth being (lat, lon, height, v_n, q_nb).  settings: with datum, earth
    and rate_hz; truth_length: of how many samples the truth is kept that waits for the IMU.

    processed_ns is the motion time of the last IMU sample that was used, or None.

    The push methods return a list of outputs and raise StreamFault; the first IMU sample may be
    repeated and is answered again.  Nothing depends on which stream is ahead.  A gap behind
    samples that still wait is no fault of the push, for its turn comes after theirs: ``faults``
    collects these, and the owner empties it.  When one stream jumps back the samples that the
    other brings of the time before are not matched.
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
        """Forget the solution; the next IMU sample starts anew.  Truth is no state: it stays."""
        self._imu, self._gaps = deque(), {}
        self._last_ns = None
        self._start_anew()

    def rejoin(self):
        """Start anew as if both streams began now: one of them has not brought what it should."""
        self._forget_streams()
        self._truth.clear()
        self.reset()

    def _forget_streams(self):
        # the IMU is the first of the two
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
        """Return whether an IMU sample that has its truth must wait for something else."""
        return False

    def go_on(self):
        """Wait no longer for anything but the truth: too many samples wait; return outputs."""
        return []

    def push_imu(self, t_ns, omega, f):
        """Take the IMU sample of stamp t_ns (motion time)."""
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
            raise StreamFault(f'{len(self._imu)} readings of the imu wait for what belongs to '
                              f'them, from {seconds(self._imu[0][0])} on; expected less than '
                              'topics.depth', restart=True)
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
        Take the truth of stamp t_ns (motion time).

        A repeated stamp is passed over; a stamp that jumps back begins a new history, and it is
        the IMU, which jumps back too, that is reported.
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
            # the oldest truth is about to be lost, and a reading may need it
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
        """Use what can be used; return the outputs."""
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
                # else the streams were joined at different times: pass over what came before
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
            return (f'{nearest}; that sample of the truth was lost, as where a node cannot keep '
                    'up and a queue runs over: expected a lower rate_hz or real_time_factor, or '
                    'more topics.depth')
        return (f'{nearest}; expected a truth rate that is a multiple of the IMU rate, both from '
                'the same start: rate_hz must go together in all nodes (imu_time: nominal for '
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
