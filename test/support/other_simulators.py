"""Odometry of another simulator on motions of ins_sim, and the output of TruthAdapter for it."""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.navigation.errors import position_error
from ins_sim.core.sensors.imu.ideal import MotionImu
from ins_sim.core.sensors.imu.readings import samples_of
from ins_sim.core.sensors.imu.stream import StreamImu
from ins_sim.core.simulation.inertial import navigate_blocks
from ins_sim.core.streams.adapter.stage import TruthAdapter
from ins_sim.core.timeseries.histories import Truth
from ins_sim.settings.catalogue import build
from ins_sim.settings.truth_adapter import TruthAdapterSettings
from support.studies import settings

PLACE = {'datum.latitude_deg': 55.0, 'datum.longitude_deg': 37.0}
MOTIONS = {
    'motion_1': {'motion.kind': 'rocking', 'motion.psi_deg': 45.0, 'motion.theta_deg': 0.0},
    'motion_2': {'motion.kind': 'two_axis'},
    **{kind: {'motion.kind': kind} for kind in ('sinusoids', 'cruise', 'racetrack', 'aggressive')}}


class OtherSimulator:
    """
    A motion as the odometry of another simulator.

    name: key of MOTIONS; rate_hz, length_s: rate and duration of the samples. r (n, 3), q (n, 4),
    v and w (n, 3) at t_ns (n,) are exact until a method adds errors.
    """

    def __init__(self, name, rate_hz, length_s, seed=0):
        self.settings = settings({**PLACE, **MOTIONS[name]}, vertical__channel='free')
        generator = self.settings.motion_generator
        self.motion = make_motion(generator.motion, generator.datum, generator.earth)
        self._frame = MapFrame(generator.datum, True)
        self.t_ns = np.arange(round(length_s * rate_hz) + 1) * round(1e9 / rate_hz)
        self._random = np.random.default_rng(seed)
        self.r, self.q, self.v, self.w = self._odometry(self.t_ns)

    def _odometry(self, t_ns):
        truth = self.motion.at(t_ns)
        r, q, v = self._frame.pose(truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)
        turn = quaternion.rotate_back(q.T, self._frame.omega_ie_m)
        return r, q, v, truth.omega_ib_b - np.stack(turn, axis=-1)

    def _normal(self, sigma, shape=None):
        return sigma * self._random.standard_normal(self.r.shape if shape is None else shape)

    def without_twist(self):
        """Set the twist to zero."""
        self.v, self.w = np.zeros_like(self.v), np.zeros_like(self.w)
        return self

    def averaged_twist(self, steps=10, step_ns=1_000_000):
        """Set the twist as gz-sim computes it: the mean of the last steps of the simulation."""
        v = w = 0.0
        for k in range(steps):
            r0, q0, _, _ = self._odometry(self.t_ns - (k + 1) * step_ns)
            r1, q1, _, _ = self._odometry(self.t_ns - k * step_ns)
            turn = quaternion.logarithm(quaternion.multiply(quaternion.conjugate(q0.T), q1.T))
            v = v + np.stack(quaternion.rotate_back(q1.T, tuple((r1 - r0).T)), axis=-1)
            w = w + np.stack(turn, axis=-1)
        self.v, self.w = (x / (1e-9 * steps * step_ns) for x in (v, w))
        return self

    def parent_twist(self):
        """Set the twist in the axes of the parent frame."""
        self.v, self.w = (np.stack(quaternion.rotate(self.q.T, tuple(x.T)), axis=-1)
                          for x in (self.v, self.w))
        return self

    def noisy(self, metres=0.0, degrees=0.0, metres_s=0.0, degrees_s=0.0):
        """Add white noise to each axis of position, attitude, velocity and rate."""
        turn = tuple(self._normal(0.5 * np.radians(degrees)).T)
        q = quaternion.multiply(self.q.T, (*turn, np.ones(len(self.q))))
        self.q = np.stack(q, axis=-1) / np.sqrt(sum(x * x for x in q))[:, None]
        self.r = self.r + self._normal(metres)
        self.v = self.v + self._normal(metres_s)
        self.w = self.w + self._normal(np.radians(degrees_s))
        return self

    def off_stamps(self, sigma_s):
        """Add a random error to each stamp."""
        off_ns = np.rint(1e9 * self._normal(sigma_s, self.t_ns.shape)).astype(np.int64)
        self.t_ns = self.t_ns + off_ns - off_ns[0]
        return self

    def in_floats(self):
        """Round all values to 32 bits."""
        self.r, self.q, self.v, self.w = (x.astype(np.float32).astype(float)
                                          for x in (self.r, self.q, self.v, self.w))
        return self

    def samples(self):
        """Yield the arguments of TruthAdapter.push for each sample."""
        return zip(self.t_ns.tolist(), *(map(tuple, x.tolist())
                                         for x in (self.r, self.q, self.v, self.w)))

    def adapted(self, **values):
        """Return a TruthAdapter after all samples, and the list of its AdaptedTruth."""
        adapter = TruthAdapter(build(TruthAdapterSettings, {**PLACE, **{
            key.replace('__', '.'): value for key, value in values.items()}}))
        return adapter, [truth for sample in self.samples() for truth in adapter.push(*sample)]


class AdaptedRun:
    """
    Readings of an IMU at 100 Hz on adapted truth, compared with those on the closed form.

    f, w: rms of the difference vector; the first reading covers no interval and is left out.
    """

    def __init__(self, simulator, truths):
        self._simulator, s = simulator, simulator.settings
        columns = [np.array(column) for column in zip(*truths)]
        self.truth = Truth(columns[0], *columns[5:8], np.stack(quaternion.rotate(
            columns[8].T, tuple(columns[3].T)), axis=-1), *columns[8:])
        self.r_m = columns[1]
        imu = StreamImu(s.imu_sensor)
        self.imu = samples_of([reading for t in truths for reading in imu.push(
            t.t_ns, t.q_mb, t.omega_ib_b, t.f_ib_b)])
        exact = MotionImu(s.imu_sensor, simulator.motion, int(self.imu.t_ns[0])).advance(
            len(self.imu.t_ns))
        self.f, self.w = (float(np.sqrt(np.mean(np.sum((a - b)[1:] ** 2, axis=1)))) for a, b in (
            (self.imu.f, exact.f), (self.imu.omega, exact.omega)))

    def at(self, t_ns):
        """Return the adapted truth at instants, like a motion."""
        return self.truth[np.searchsorted(self.truth.t_ns, t_ns)]

    def closures(self):
        """
        Return the greatest distance of the strapdown from the adapted and from the exact truth, m.
        """
        most, settings = [0.0, 0.0], self._simulator.settings.strapdown
        for truth, states, _ in navigate_blocks(settings, self, [self.imu]):
            for k, true in enumerate((truth, self._simulator.motion.at(truth.t_ns))):
                far = np.array(position_error(states.lat, states.lon, states.height, true.lat,
                                              true.lon, true.height))
                most[k] = max(most[k], float(np.sqrt(np.sum(far * far, axis=0)).max()))
        return tuple(most)

    def farthest(self):
        """Return the greatest distance of the adapted from the exact path, m."""
        frame, true = self._simulator._frame, self._simulator.motion.at(self.truth.t_ns)
        r = frame.pose(true.lat, true.lon, true.height, true.v_n, true.q_nb)[0]
        return float(np.sqrt(np.sum((self.r_m - r) ** 2, axis=1)).max())
