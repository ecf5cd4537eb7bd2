"""
The strapdown system: start from truth, step on IMU samples, compare with truth.

``Strapdown`` takes matched samples; ``Navigator`` matches two streams by their stamps.
"""

from collections import deque
import math

from . import attitude, earth, strapdown
from .errors import ErrorMeter
from .faults import check_finite, check_interval, check_unit, seconds, StreamFault
from .instants import period_ns
from .map_frame import MapFrame
from .orientation import Orientation

CHANNELS = {'truth': strapdown.FROM_TRUTH, 'free': strapdown.FREE, 'damped': strapdown.DAMPED}


class Strapdown:
    """
    The navigator of one IMU.

    settings: StrapdownSettings.  The first sample after ``initial.after_s`` starts it at the
    truth plus the initial errors; its increments serve only as the sample before.
    """

    def __init__(self, settings):
        self._settings = settings
        self._spin = earth.ROTATION_RATE if settings.earth.rotation else 0.0
        self._integrated = settings.input == 'integrated'
        self._channel = CHANNELS[settings.vertical.channel]
        self._damping = strapdown.damping(settings.vertical.time_constant_s)
        self._after_ns = round(settings.initial.after_s * 1e9)
        self._place = self._orientation = None
        self._first_ns = None

    @property
    def state(self):
        """Return (q_ib, lat, lon, height, v), or None before the start."""
        return None if self._place is None else (self._orientation.q, *self._place)

    def step(self, t_ns, omega, f, truth):
        """
        Take the reading that ends at t_ns and the truth then; return whether it navigates.

        omega, f: tuples, rad/s and m/s^2; truth: (lat, lon, height, v_n, q_nb).
        """
        if self._place is None:
            if self._first_ns is None:
                self._first_ns = t_ns
            if t_ns < self._first_ns + self._after_ns:
                return False
            self._start(t_ns, truth)
            dt = 1.0 / self._settings.rate_hz
            self._last = (t_ns, tuple(w * dt for w in omega), tuple(a * dt for a in f))
            return True
        last_ns, alpha_last, nu_last = self._last
        dt = (t_ns - last_ns) * 1e-9
        alpha = (omega[0] * dt, omega[1] * dt, omega[2] * dt)
        nu = (f[0] * dt, f[1] * dt, f[2] * dt)
        if self._integrated:
            phi, u = strapdown.two_sample_increments(alpha, nu, alpha_last, nu_last)
        else:
            phi, u = alpha, nu
        reference = ()
        if self._channel == strapdown.FROM_TRUTH:
            reference = (truth[2], truth[3][2])
        elif self._channel == strapdown.DAMPED:
            reference = (truth[2], *self._damping, self._wander)
        turned = self._spin * (0.5 * ((last_ns - self._start_ns) + (t_ns - self._start_ns)) * 1e-9)
        *place, self._wander = strapdown.step(self._orientation.q, *self._place, u, dt, self._spin,
                                              turned, self._channel, reference)
        self._place = tuple(place)
        self._orientation.advance(phi, dt)
        self._last = (t_ns, alpha, nu)
        return True

    def _start(self, t_ns, truth):
        lat, lon, height, v, q_nb = truth
        initial = self._settings.initial
        error = attitude.exponential(tuple(map(math.radians, initial.attitude_error_deg)))
        q_ib = strapdown.inertial_attitude(lat, lon, attitude.multiply(error, q_nb))
        lat, lon, off_height = earth.displaced(lat, lon, height, initial.position_error_m)
        v = tuple(a + b for a, b in zip(v, initial.velocity_error_m_s))
        if self._channel != strapdown.FROM_TRUTH:
            height = off_height
        else:
            v = (*v[:2], truth[3][2])
        self._orientation = Orientation(self._settings.orientation, q_ib)
        self._place = (lat, lon, height, v)
        self._start_ns = t_ns
        self._wander = 0.0
        self._meter = ErrorMeter(self._spin)

    def solution(self, t_ns):
        """Return lat, lon, height, v_n, q_nb at the last step."""
        lat, lon, height, v = self._place
        inertial_lon = lon + self._spin * ((t_ns - self._start_ns) * 1e-9)
        q_in = strapdown.level_frame(lat, inertial_lon)
        q_nb = attitude.multiply(attitude.conjugate(q_in), self._orientation.q)
        return lat, lon, height, v, q_nb

    def errors(self, t_ns, truth):
        """Return attitude, velocity, position errors and drift; once a step, in order."""
        return self._meter.measure((t_ns - self._start_ns) * 1e-9, self.state, truth)


class Navigator:
    """
    A Strapdown on two live streams, IMU and truth, matched by stamp.

    processed_ns is the motion time of the last IMU sample that was used, or None.

    Both push methods return a list of (t_ns, solution, errors) and raise StreamFault; the first
    IMU sample may be repeated and is answered again.
    """

    def __init__(self, settings):
        self._settings = settings
        self._frame = MapFrame(settings.datum, settings.earth.rotation)
        self._dt_ns = period_ns(settings.rate_hz)
        self._truth = deque(maxlen=settings.topics.depth)
        self._joined_ns = None
        self.reset()

    def reset(self):
        """Forget the solution; the next IMU sample starts anew.  Truth is no state: it stays."""
        self._strapdown = Strapdown(self._settings)
        self._imu = deque()
        self._last_ns = self.processed_ns = None
        self._repeat = None
        self._steps = 0

    @property
    def waiting_for_truth(self):
        """Return whether an IMU sample is queued whose truth has not come."""
        return bool(self._imu)

    def push_imu(self, t_ns, omega, f):
        """Take the IMU sample of stamp t_ns (motion time)."""
        check_finite('imu', t_ns, omega, f)
        if self._repeat is not None and t_ns == self._repeat[0]:
            return self._repeat[1]
        if self._last_ns is not None and t_ns < self._last_ns and self._truth \
                and self._truth[0][0] > t_ns:
            # the truth that is known belongs to the time before the jump
            self._truth.clear()
        if self._last_ns is not None and not (t_ns == self._last_ns and self._steps <= 1):
            check_interval('imu', t_ns, self._last_ns, self._dt_ns, 0.2)
            self._repeat = None
        elif t_ns == self._last_ns:
            return []
        self._last_ns = t_ns
        self._imu.append((t_ns, omega, f))
        return self._match()

    def push_truth(self, t_ns, r_m, q_mb, v_b):
        """
        Take the truth of stamp t_ns (motion time).

        A repeated stamp is passed over; a stamp that jumps back begins a new history, and it is
        the IMU, which jumps back too, that is reported.
        """
        check_finite('truth', t_ns, r_m, q_mb, v_b)
        check_unit('truth', t_ns, q_mb)
        if self._truth and t_ns <= self._truth[-1][0]:
            if t_ns == self._truth[-1][0]:
                return []
            self._truth.clear()
        if not self._truth:
            self._joined_ns = t_ns
        self._truth.append((t_ns, r_m, q_mb, v_b))
        return self._match()

    def _match(self):
        outputs = []
        imu, truth = self._imu, self._truth
        while imu and truth:
            t_ns, omega, f = imu[0]
            while len(truth) > 1 and truth[0][0] < t_ns:
                truth.popleft()
            if truth[0][0] < t_ns:
                break
            if truth[0][0] > t_ns:
                imu.popleft()
                if self._strapdown.state is None and truth[0][0] == self._joined_ns:
                    # the streams were joined at different times: pass over what came before
                    continue
                raise StreamFault(
                    f'imu at {seconds(t_ns)} has no truth of the same stamp, the nearest is '
                    f'{seconds(truth[0][0])}; expected a truth rate that is a multiple of the '
                    'IMU rate, both from the same start (imu_time: nominal for stamps with jitter '
                    'or latency)', restart=True)
            imu.popleft()
            output = self._advance(t_ns, omega, f, self._frame.geodetic_one(*truth[0][1:]))
            outputs.extend(output)
        return outputs

    def _advance(self, t_ns, omega, f, truth):
        self.processed_ns = t_ns
        if not self._strapdown.step(t_ns, omega, f, truth):
            return []
        output = [(t_ns, self._strapdown.solution(t_ns), self._strapdown.errors(t_ns, truth))]
        if self._steps == 0:
            self._repeat = (t_ns, output)
        self._steps += 1
        return output
