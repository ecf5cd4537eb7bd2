"""The rotation that a delayed gyro channel has not read yet: rate integrated over the delay."""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.rates import rate_of_n

# For longer delays the rotation is integrated. Up to this delay it is the delay times the rate;
# this neglects half the delay times the change of the rate, 3e-4 of the rotation at 10 Hz.
LONG_NS = 10_000
# Gauss-Legendre quadrature with five points on [0, 1]; exact to rounding if the delay is a
# fraction of the period of the fastest motion.
NODES, WEIGHTS = (0.5 * x for x in np.polynomial.legendre.leggauss(5))
NODES = NODES + 0.5


class LateTurns:
    """
    The rotations D of three channels: components of the rate of b, integrated from t - tau to t.

    Parameters
    ----------
    motion : Motion
    tau_ns : delays of the channels x, y, z, ns
    first_ns : motion time of the first reading
    past : rate, rad/s, that the channels see before the first reading; None for that of the
        motion

    """

    def __init__(self, motion, tau_ns, first_ns, past=None):
        self._motion, self._tau_ns, self._first_ns = motion, tau_ns, first_ns
        self._tau = np.array(tau_ns) * 1e-9
        self.long = is_long(tau_ns)
        self._past = past if max(tau_ns) > 0 else None

    def at(self, truth):
        """Return D (n, 3), rad, at the instants of a Truth."""
        if self.long:
            return np.stack([self._integral(truth.t_ns, axis) for axis in range(3)], axis=-1)
        turns = truth.omega_ib_b * self._tau
        if self._past is not None:
            # All later instants are farther from the first reading than a short delay.
            first = np.flatnonzero(truth.t_ns == self._first_ns)
            late = np.flatnonzero(self._tau > 0.0)
            turns[np.ix_(first, late)] = (self._tau * self._past)[late]
        return turns

    def _integral(self, t_ns, axis):
        tau_ns, total = self._tau_ns[axis], np.zeros(len(t_ns))
        if not tau_ns:
            return total
        start_ns = t_ns - tau_ns
        if self._past is not None and tau_ns > 0:
            begin_ns = np.minimum(np.maximum(start_ns, self._first_ns), t_ns)
            total += (begin_ns - start_ns) * 1e-9 * self._past[axis]
            start_ns = begin_ns
        span_ns = t_ns - start_ns
        for node, weight in zip(NODES, WEIGHTS):
            at_ns = start_ns + np.round(span_ns * node).astype(np.int64)
            total += span_ns * 1e-9 * weight * self._motion.at(at_ns).omega_ib_b[:, axis]
        return total


def late_turns(settings, motion):
    """Return the LateTurns of the gyros of SimulationSettings."""
    sensor, past = settings.imu_sensor, None
    first_ns = round(1e9 * settings.motion_generator.start_s)
    # A body at rest rotates with the Earth. With integrated output, the rate itself was constant
    # before the first reading.
    if sensor.history == 'frozen':
        past = (motion.at(np.array([first_ns], dtype=np.int64)).omega_ib_b[0]
                if sensor.output == 'integrated' else
                frozen_rate(motion, first_ns, settings.motion_generator.earth.rotation))
    return LateTurns(motion, sensor.gyro.delay_us.in_ns(), first_ns, past)


def is_long(tau_ns):
    """Return whether delays, ns, are too long for the first-order formula."""
    return max(map(abs, tau_ns)) > LONG_NS


def late_force(motion, t_ns, tau_ns, held_ns):
    """
    Return the readings of delayed accelerometers minus the specific force, (n, 3) m/s^2, in b.

    tau_ns: delays of x, y, z; held_ns: motion time before which the force of that instant is
    seen, or None.
    """
    force = motion.at(t_ns).f_ib_b
    late = []
    for axis, tau in enumerate(tau_ns):
        seen_ns = t_ns - tau if held_ns is None else np.maximum(t_ns - tau, held_ns)
        late.append(motion.at(seen_ns).f_ib_b[:, axis])
    return np.stack(late, axis=-1) - force


def frozen_rate(motion, first_ns, earth_rotation):
    """Return the rate (3,), rad/s, of a body at rest on the Earth, attitude as at first_ns."""
    truth = motion.at(np.array([first_ns], dtype=np.int64))
    still = rate_of_n(truth.lat, truth.height, np.zeros((1, 3)), earth_rotation)
    return np.stack(quaternion.rotate_back(tuple(truth.q_nb.T), tuple(still.T)), axis=-1)[0]
