"""The drift caused by delayed channels, by linear theory (docs/theory/prediction.md)."""

from dataclasses import replace
import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.rates import rate_of_n
from ins_sim.core.numerics import elementary
from ins_sim.core.sensors.tuned_gyro.instrument import make_pair
from .fourier import fourier_coefficients

SUBSAMPLES = 8
STEP_S = 0.1
PER_PERIOD = 4096
# Number of instants evaluated together.
BLOCK = 8192


def _nanoseconds(t_s):
    return np.round(t_s * 1e9).astype(np.int64)


def _columns(vectors):
    return tuple(np.moveaxis(vectors, -1, 0))


def _to_n(truth, vectors_b):
    return np.stack(quaternion.rotate(_columns(truth.q_nb), _columns(vectors_b)), axis=-1)


def drift_density(truth, omega_in_n, late):
    """
    Return R (w x D) and R D (n, 3): integrand and boundary term of the attitude error.

    late (n, 3): the rotations D that the channels x, y, z have not read yet, rad. To first order
    in the delays T they are T w, with w the rate of b in i. The error of the reading is -D', so
    that the attitude error grows by nu = -R D' = -d/dt(R D) + R (w_nb x D), because R turns at the
    rate of b relative to n. Bogdanov and Fomichev (2018) use w for w_nb, neglecting the rotation
    of the Earth (docs/theory/prediction.md).
    """
    omega_in_b = np.stack(quaternion.rotate_back(_columns(truth.q_nb), _columns(omega_in_n)), -1)
    density = np.stack(quaternion.cross(_columns(truth.omega_ib_b - omega_in_b), _columns(late)),
                       -1)
    return _to_n(truth, density), _to_n(truth, late)


def mean_drift(motion, turns, earth_rotation, start_s, span_s):
    """
    Return the mean drift (3,), east, north, up, rad/s.

    The mean is over one period if the motion is periodic (the trapezium rule is then spectrally
    accurate), otherwise over the span.

    turns: function of a Truth that returns D of ``drift_density``; start_s, span_s: motion time
    and length of the span, s.
    """
    length = motion.period_s or span_s
    count = PER_PERIOD if motion.period_s else max(PER_PERIOD, round(span_s / 0.0125))
    total = np.zeros(3)
    for first in range(0, count, BLOCK):
        k = np.arange(first, min(first + BLOCK, count))
        truth = motion.at(_nanoseconds(start_s + length * k / count))
        omega_in = rate_of_n(truth.lat, truth.height, truth.v_n, earth_rotation)
        density, _ = drift_density(truth, omega_in, turns(truth))
        total = np.add.reduce(np.concatenate([total[None], density]), axis=0)
    return total / count


class LateAttitudeError:
    """
    Attitude error beta due to delayed channels: boundary term and integral of ``drift_density``.

    turns: see ``mean_drift``; step_s: interval between the instants, s.
    """

    def __init__(self, turns, step_s):
        self._turns, self._step_s = turns, step_s
        self._first = self._integral = None

    def advance(self, truth, omega_in):
        """
        Return beta (n, 3), rad.

        truth (n,), omega_in (n, 3): their first instant is the last one of the previous block.
        """
        density, late = drift_density(truth, omega_in, self._turns(truth))
        if self._first is None:
            self._first, self._integral = late[0], np.zeros((1, 3))
        running = np.cumsum(np.concatenate([
            self._integral, 0.5 * self._step_s * (density[1:] + density[:-1])]), axis=0)
        self._integral = running[-1:]
        return self._first - late + running


class NoPrediction(ValueError):
    """The linear theory does not apply to the settings."""


def exact_pair(gyro, step_s):
    """Return the GyroPair of settings.Gyro, exact method; NoPrediction if it is unstable."""
    try:
        return make_pair(replace(gyro, dtg=replace(gyro.dtg, method='exact',
                                                   on_unstable='refuse')), step_s)
    except ValueError as error:
        raise NoPrediction(f'no prediction: {error}') from None


class PairAttitudeError:
    """
    Attitude error beta due to two tuned gyros: the integral of R (reading - rate).

    The rotors are simulated with the rates of the motion; the mean rate of a step is found by
    Simpson's rule.

    Parameters
    ----------
    motion : Motion of the run
    gyro : settings.Gyro
    tau : (3,) delays, s
    start_s : motion time of the first instant, s
    step_s : interval between the instants, s
    held_ns : motion time before which the channels see the rate of that instant, or None

    """

    def __init__(self, motion, gyro, tau, start_s, step_s, held_ns=None):
        self._motion, self._tau, self._held_ns = motion, tau, held_ns
        self._start_s, self._step_s = start_s, step_s
        self._pair, self._integral = exact_pair(gyro, step_s), None

    def advance(self, first, count):
        """Return beta (count + 1, 3), rad, from index ``first`` on; call in order from 0."""
        halves = self._start_s + 0.5 * self._step_s * np.arange(2 * first,
                                                                2 * (first + count) + 1)
        late = np.stack([self._motion.at(self._seen(_nanoseconds(halves - d))).omega_ib_b[:, i]
                         for i, d in enumerate(self._tau)], axis=-1)
        if self._integral is None:
            self._pair.settle(late[0])
            self._integral = np.zeros((1, 3))
        reading, _ = self._pair.advance(np.stack((late[:-1:2], late[1::2], late[2::2]), axis=1))
        truth = self._motion.at(_nanoseconds(halves))
        w = truth.omega_ib_b
        growth = _to_n(truth[1::2], reading - (w[:-1:2] + 4.0 * w[1::2] + w[2::2]) / 6.0)
        running = np.cumsum(np.concatenate([self._integral, self._step_s * growth]), axis=0)
        self._integral = running[-1:]
        return running

    def _seen(self, t_ns):
        return t_ns if self._held_ns is None else np.maximum(t_ns, self._held_ns)


def channel_drift(motion, responses, start_s=0.0, count=PER_PERIOD):
    """
    Return the mean drift (3,), rad/s, of a periodic motion measured through linear channels.

    <nu> = sum_i sum_k Re(r_ik conj[sum_j (H_ij(k w0) - 1_ij) w_jk]), with r_i column i of R
    (docs/theory/prediction.md).

    responses: three functions that return the complex frequency response H_i at an array of
    angular frequencies, rad/s; or one function that returns the response (n, 3, 3) of coupled
    channels (``sensors.tuned_gyro.pair``).  Raises ValueError for a motion without a period.
    """
    if motion.period_s is None:
        raise ValueError('the drift through channels is computed from a Fourier series of the '
                         'motion; expected a periodic motion')
    t = start_s + motion.period_s * np.arange(count) / count
    truth = motion.at(_nanoseconds(t))
    w_re, w_im, harmonics = fourier_coefficients(truth.omega_ib_b)
    omega = 2.0 * np.pi / motion.period_s * harmonics
    h = (responses(omega) if callable(responses)
         else np.stack([channel(omega) for channel in responses], axis=-1)[:, None, :] * np.eye(3))
    # Use real products only: processors differ in how they round complex products.
    h_re, h_im = h.real - np.eye(3), h.imag
    error_re = _row_sums(h_re * w_re[:, None, :] - h_im * w_im[:, None, :])
    error_im = _row_sums(h_re * w_im[:, None, :] + h_im * w_re[:, None, :])
    drift = np.zeros(3)
    for i in range(3):
        unit = np.zeros((count, 3))
        unit[:, i] = 1.0
        r_re, r_im, _ = fourier_coefficients(_to_n(truth, unit))
        drift += np.add.reduce(r_re * error_re[:, i, None] + r_im * error_im[:, i, None], axis=0)
    return drift


def _row_sums(rows):
    """Return the sums of the three numbers in each row (..., 3)."""
    return rows[..., 0] + rows[..., 1] + rows[..., 2]


def delay_response(tau):
    """Return the frequency response exp(-j w tau) of a delay tau, s."""
    return lambda omega: delayed(np.ones(np.shape(omega), dtype=complex), omega * tau)


def delayed(response, phase):
    """Return the product of a complex response and exp(-j phase)."""
    s, c = elementary.sincos(phase)
    late = np.empty(response.shape, dtype=complex)
    late.real = response.real * c + response.imag * s
    late.imag = response.imag * c - response.real * s
    return late


def two_axis_resonances(motion, tau):
    """
    Return the resonances of motion 2 as (name, rate of psi, drift (3,)); empty for other motions.

    The resonance psi' = 2 gamma' is equation (19) of Bogdanov and Fomichev (2018), who do not
    mention the resonance psi' = -2 gamma' (docs/theory/prediction.md). tau (3,): delays of x,
    y, z, s; their tau1 is the delay of y, their tau3 that of z.
    """
    if motion.kind != 'two_axis':
        return []
    theta, psi, gamma = (math.radians(a) for a in (motion.theta_deg, motion.psi_deg,
                                                   motion.gamma_deg))
    found = []
    for sign, name in ((1.0, "psi' = 2 gamma'"), (-1.0, "psi' = -2 gamma'")):
        rate = sign * 2.0 * motion.two_axis.gamma_rate_rad_s
        phase = psi - sign * 2.0 * gamma
        s, c = elementary.sincos(theta)
        size = sign * 0.125 * rate * rate * (tau[1] - tau[2]) * c * (1.0 - sign * s)
        north, east = elementary.sincos(phase)
        found.append((name, rate, size * np.array((east, north, 0.0))))
    return found
