"""
The ideal IMU whose channels are delayed (Bogdanov and Fomichev 2018).

See docs/theory/late_gyro.md. Axes m are those of the map frame (`core.earth.frames.MapFrame`), b
those of the body.
"""

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.numerics.compilation import run
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.timeseries.histories import ImuSamples
from .increments import (force_arrays, force_rows, mean_force, NODES, rotation_arrays,
                         rotation_increment, rotation_rows, turned_arrays, turned_rows,
                         velocity_increment, WEIGHTS)
from .readings import joined


class Triads:
    """
    The channels of both triads: their distinct delays, and the arithmetic of one step.

    Attributes
    ----------
    gyro_delays, accel_delays : the distinct delays of each triad in rising order, ns; the inputs
        of a step are given in this order
    attitude_delays : the distinct delays of both triads together, ns
    """

    def __init__(self, settings):
        self.dt_ns = period_ns(settings.rate_hz)
        self.integrated = settings.output == 'integrated'
        gyro, accel = settings.gyro.delay_us.in_ns(), settings.accelerometer.delay_us.in_ns()
        self.gyro_delays, self.accel_delays = tuple(sorted(set(gyro))), tuple(sorted(set(accel)))
        # Both triads need attitudes; each distinct delay is evaluated once.
        self.attitude_delays = tuple(sorted(set(gyro) | set(accel)))
        self._gyro = tuple(self.gyro_delays.index(d) for d in gyro)
        self._accel = tuple(self.accel_delays.index(d) for d in accel)
        self._gyro_at = tuple(self.attitude_delays.index(d) for d in self.gyro_delays)
        self._accel_at = tuple(self.attitude_delays.index(d) for d in self.accel_delays)
        dt = self.dt_ns * 1e-9
        self.pair, self.rate_nodes = None, NODES
        if settings.gyro.model == 'dtg':
            from ..tuned_gyro.instrument import PairInstrument
            self.pair = PairInstrument(settings)
            self.rate_nodes = self.pair.nodes
        self.begin()
        self._per_dt = 1.0 / dt
        self.frame = MapFrame(settings.datum, settings.earth.rotation)
        turn = self.frame.omega_ie_m
        self._dq_earth = quaternion.exponential(tuple(w * dt for w in turn))
        self._node_rotations = tuple(quaternion.exponential(tuple(w * dt * s for w in turn))
                                     for s in NODES)

    def begin(self):
        """Start a run: rotors of tuned gyros, if any, settle at the start of the next step."""
        self._settled = False

    def rotated(self, q_start, q_end, forces_m):
        """
        Return omega (rad/s), f (m/s^2) and None for one step of the output ``rotation_vector``.

        Parameters
        ----------
        q_start, q_end : q_mb at the start and end of the step, one for each attitude delay
        forces_m : specific force in m at the three Gauss nodes, one set for each accelerometer
            delay, m/s^2
        """
        phi = [rotation_increment(q_start[k], q_end[k], self._dq_earth) for k in self._gyro_at]
        u = [velocity_increment(q_start[k], f, self._node_rotations)
             for k, f in zip(self._accel_at, forces_m)]
        (g0, g1, g2), (a0, a1, a2), n = self._gyro, self._accel, self._per_dt
        return ((phi[g0][0] * n, phi[g1][1] * n, phi[g2][2] * n),
                (u[a0][0], u[a1][1], u[a2][2]), None)

    def rotated_block(self, t_ns, q_before, q_mb, forces_m):
        """
        Return the ImuSamples of n consecutive steps of the output ``rotation_vector``.

        Parameters
        ----------
        t_ns : (n,) ends of the steps, ns
        q_before : q_mb at the end of the step before, four floats for each attitude delay
        q_mb : (n, 4) q_mb at the ends of the steps, one array for each attitude delay
        forces_m : specific force in m for each accelerometer delay and Gauss node, m/s^2: arrays,
            or floats where it is constant
        """
        count = len(t_ns)
        phi, u = [], []
        for k in self._gyro_at:
            phi.append(np.empty((count, 3)))
            run(rotation_rows, count, (tuple(q_before[k]), q_mb[k], self._dq_earth), phi[-1],
                rotation_arrays)
        for k, nodes in zip(self._accel_at, forces_m):
            mean = np.empty((count, 3))
            for axis, component in enumerate(mean_force(nodes, self._node_rotations)):
                mean[:, axis] = component
            u.append(np.empty((count, 3)))
            run(force_rows, count, (tuple(q_before[k]), q_mb[k], mean), u[-1], force_arrays)
        omega = _picked(phi, self._gyro)
        omega *= self._per_dt
        return ImuSamples(t_ns, omega, _picked(u, self._accel))

    def instant(self, t_ns, omega, f):
        """
        Return omega, f and parity (or None) of the first sample, which has no interval before it.

        Parameters
        ----------
        t_ns : motion time, ns
        omega, f : angular rate (rad/s) and specific force (m/s^2) at that instant
        """
        if self.pair is None:
            return omega, f, None
        rate, parity = self.pair.first(t_ns, omega, f)
        return rate, f, parity

    def integrals(self, t_ns, rates, forces_b):
        """
        Return omega, f and parity (or None) of the step of output ``integrated`` ending at t_ns.

        Parameters
        ----------
        t_ns : end of the step, ns
        rates : body rate at ``rate_nodes``, one set for each gyro delay, rad/s
        forces_b : specific force in b at the Gauss nodes, one set for each accelerometer delay,
            m/s^2
        """
        force = self._pick_means(forces_b, self._accel)
        if self.pair is None:
            return self._pick_means(rates, self._gyro), force, None
        late = self._late(rates)
        self._settle(late[0])
        omega, parity = self.pair.step(t_ns, late, force)
        return omega, force, parity

    def integrals_block(self, t_ns, rates, forces_b, first_ns=None):
        """
        Return the ImuSamples of n consecutive steps of the output ``integrated``.

        Parameters
        ----------
        t_ns : (n,) ends of the steps, ns
        rates, forces_b : as in ``integrals``, with arrays (3, n) for vectors
        first_ns : end of the first step of the run: the rotors settle again after this step

        Raises
        ------
        StreamFault
            Its attribute ``readings`` holds the samples before the fault.
        """
        if self.pair is None:
            omega, f, _ = self.integrals(t_ns, rates, forces_b)
            return ImuSamples(t_ns, np.stack(omega, axis=-1), np.stack(f, axis=-1))
        force = np.stack(self._pick_means(forces_b, self._accel), axis=-1)
        late = np.array(self._late(rates)).transpose(2, 0, 1)
        first = np.flatnonzero(t_ns == first_ns) + 1
        parts = []
        for piece in np.split(np.arange(len(t_ns)), first):
            if len(piece):
                at = slice(piece[0], piece[-1] + 1)
                self._settle(late[piece[0], 0].tolist())
                omega, parity, fault = self.pair.advance(t_ns[at], late[at], force[at])
                end = piece[0] + len(omega)
                parts.append(ImuSamples(t_ns[piece[0]:end], omega, force[piece[0]:end], parity))
                if fault is not None:
                    fault.readings = joined(parts)
                    raise fault
                if len(first) and piece[-1] + 1 == first[0]:
                    self.begin()
        return joined(parts)

    def _late(self, rates):
        """Return the rates at the nodes, each axis with its own delay: the input of the rotors."""
        x, y, z = self._gyro
        return [(a[0], b[1], c[2]) for a, b, c in zip(rates[x], rates[y], rates[z])]

    def _settle(self, w):
        if not self._settled:
            self.pair.settle(w)
            self._settled = True

    @staticmethod
    def _pick_means(nodes, picks):
        w1, w2, w3 = WEIGHTS
        return tuple(w1 * nodes[k][0][i] + w2 * nodes[k][1][i] + w3 * nodes[k][2][i]
                     for i, k in enumerate(picks))


def _picked(rows, picks):
    """Return (n, 3) with axis i taken from rows[picks[i]]; the rows may be overwritten."""
    found = rows[picks[0]]
    for axis, k in enumerate(picks):
        if k != picks[0]:
            found[:, axis] = rows[k][:, axis]
    return found


class MotionImu:
    """
    The IMU on a motion that can be evaluated at any time (closed form or recording).

    Parameters
    ----------
    settings : ImuSensorSettings
    motion : Motion
    first_ns : motion time of sample 0, ns
    triads : Triads of the same settings, to reuse instead of building new ones
    """

    def __init__(self, settings, motion, first_ns, triads=None):
        self._triads = Triads(settings) if triads is None else triads
        self._triads.begin()
        self._motion = motion
        self._first_ns = first_ns
        self._frozen = settings.history == 'frozen'
        self._q_start = None
        self.next_ns = first_ns
        self.dt_ns = self._triads.dt_ns

    def advance(self, count):
        """Return the next count samples as ImuSamples; the bits do not depend on the counts."""
        triads = self._triads
        t_ns = self.next_ns + triads.dt_ns * np.arange(count, dtype=np.int64)
        self.next_ns += triads.dt_ns * count
        if triads.integrated:
            return self._integrated(t_ns)
        if self._q_start is None:
            before = t_ns[:1] - triads.dt_ns
            self._q_start = [self._attitudes(before - d)[0].tolist()
                             for d in triads.attitude_delays]
        ends = [self._attitudes(t_ns - d) for d in triads.attitude_delays]
        forces = [[self._forces_m(t_ns + (o - d)) for o in self._offsets(NODES)]
                  for d in triads.accel_delays]
        samples = triads.rotated_block(t_ns, self._q_start, ends, forces)
        self._q_start = [q[-1].tolist() for q in ends]
        return samples

    def _integrated(self, t_ns):
        triads, known = self._triads, {}
        edges = np.concatenate([t_ns[:1] - triads.dt_ns, t_ns])

        def truth(stamps, offset_ns):
            key = len(stamps), offset_ns
            if key not in known:
                known[key] = self._motion.at(self._instants(stamps + offset_ns))
            return known[key]

        def rate(offset_ns, delay_ns):
            # Each step begins where the one before it ends, so both edges share one evaluation.
            if offset_ns == -triads.dt_ns:
                return truth(edges, -delay_ns).omega_ib_b[:-1].T
            if offset_ns == 0:
                return truth(edges, -delay_ns).omega_ib_b[1:].T
            return truth(t_ns, offset_ns - delay_ns).omega_ib_b.T

        def force(offset_ns):
            if (len(t_ns), offset_ns) in known:
                return truth(t_ns, offset_ns).f_ib_b.T
            return np.array(self._motion.body_force_at(self._instants(t_ns + offset_ns)))

        rates = [[rate(o, d) for o in self._offsets(triads.rate_nodes)]
                 for d in triads.gyro_delays]
        forces = [[force(o - d) for o in self._offsets(NODES)] for d in triads.accel_delays]
        # The run begins at first_ns, as on a stream, where no earlier motion is known.
        return triads.integrals_block(t_ns, rates, forces, self._first_ns)

    def _instants(self, t_ns):
        return np.maximum(t_ns, self._first_ns) if self._frozen else t_ns

    def _attitudes(self, t_ns):
        lat, lon, q_nb = self._motion.attitude_at(self._instants(t_ns))
        q_mn, q_mb = self._triads.frame.q_mn(lat, lon), np.empty((len(t_ns), 4))
        if isinstance(lat, float):
            run(turned_rows, len(t_ns), (q_mn, q_nb), q_mb, turned_arrays)
        else:
            turned_arrays(q_mn, q_nb, q_mb)
        return q_mb

    def _forces_m(self, t_ns):
        lat, lon, f_n = self._motion.force_at(self._instants(t_ns))
        return quaternion.rotate(self._triads.frame.q_mn(lat, lon), f_n)

    def _offsets(self, nodes):
        """Return the times of nodes in [0, 1], relative to the end of a step, ns."""
        dt_ns = self._triads.dt_ns
        return [round(dt_ns * (s - 1.0)) for s in nodes]
