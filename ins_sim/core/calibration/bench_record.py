"""A record of gyros under a known motion, and the rates that perfect gyros would have read."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.motion import Motion
from ins_sim.core.sensors.imu.increments import NODES, rotation_increment, WEIGHTS
from ins_sim.core.timeseries.histories import ImuSamples

# Smallest number of readings: ten for each block of ``channel_sums``.
FEWEST = 640


@dataclass(frozen=True, eq=False)
class BenchRecord:
    """
    Readings of a gyro triad under a known motion.

    Attributes
    ----------
    name : its name in messages
    imu : ImuSamples; t_ns are motion times, omega mean rates over the interval before them, rad/s
    dt_ns : sampling period, ns
    motion : Motion
    datum, earth : settings of the position of the bench
    output : rotation_vector or integrated, the kind of a reading (ImuSensorSettings.output)
    white : density of the white noise by axis (angle random walk), rad/sqrt(s); 0 if not known
    """

    name: str
    imu: ImuSamples
    dt_ns: int
    motion: Motion
    datum: object
    earth: object
    output: str = 'rotation_vector'
    white: tuple = (0.0, 0.0, 0.0)


def usable(record):
    """
    Return a BenchRecord without unusable readings, and notes, sentences about what was left out.

    The first reading is left out, because it may be the rate at an instant, and so are readings
    outside a recorded motion. Raises ValueError if fewer than FEWEST readings are left.
    """
    imu, notes = record.imu, []
    finite = np.isfinite(imu.omega).all(axis=1)
    if not finite.all():
        notes.append(f'{record.name}: {np.count_nonzero(~finite)} of {len(imu)} readings are not '
                     'finite and are left out')
    imu = imu[finite][1:]
    if record.motion.end_s < np.inf:
        inside = (imu.t_ns >= record.dt_ns) & (imu.t_ns <= round(record.motion.end_s * 1e9))
        if not inside.all():
            notes.append(f'{record.name}: {np.count_nonzero(~inside)} of {len(imu)} readings are '
                         'outside the known motion, or within 3 s of its ends, and are left out')
            imu = imu[inside]
    if len(imu) < FEWEST:
        said = f' ({"; ".join(notes)})' if notes else ''
        raise ValueError(f'{record.name}: the record is too short: {len(imu)} readings{said}; '
                         f'expected at least {FEWEST}')
    steps = np.diff(imu.t_ns)
    gaps = steps > 1.5 * record.dt_ns
    if gaps.any():
        lost = np.count_nonzero(gaps), float((steps[gaps] - record.dt_ns).max()) * 1e-9
        notes.append(f'{record.name}: {lost[0]} gaps, the longest of {lost[1]:.6g} s: each '
                     'reading is compared with the motion at its own stamp, so that only the '
                     'missing readings are lost')
    return BenchRecord(record.name, imu, record.dt_ns, record.motion, record.datum, record.earth,
                       record.output, record.white), notes


class TrueRates:
    """The rates that perfect gyros would read under the motion of a BenchRecord."""

    def __init__(self, record):
        self._motion, self._dt_ns = record.motion, record.dt_ns
        self._integrated = record.output == 'integrated'
        self._frame = MapFrame(record.datum, record.earth.rotation)
        dt_s = record.dt_ns * 1e-9
        self._per_dt = 1.0 / dt_s
        self._dq_earth = quaternion.exponential(tuple(w * dt_s for w in self._frame.omega_ie_m))

    def at(self, t_ns):
        """
        Return the mean rates (n, 3), rad/s, over the intervals that end at t_ns (n,) int64.

        For the output ``rotation_vector`` this is the rotation vector of the interval divided by
        its length, for ``integrated`` the mean of the rate (three Gauss nodes).
        """
        if self._integrated:
            rates = [self._motion.at(t_ns + round(self._dt_ns * (node - 1.0))).omega_ib_b
                     for node in NODES]
            return WEIGHTS[0] * rates[0] + WEIGHTS[1] * rates[1] + WEIGHTS[2] * rates[2]
        turn = rotation_increment(self._attitude(t_ns - self._dt_ns), self._attitude(t_ns),
                                  self._dq_earth)
        return np.stack(turn, axis=-1) * self._per_dt

    def _attitude(self, t_ns):
        lat, lon, q_nb = self._motion.attitude_at(t_ns)
        return quaternion.multiply(self._frame.q_mn(lat, lon), np.ascontiguousarray(q_nb.T))
