"""
GNSS: position and velocity of the antenna at whole periods of motion time, with their errors.

The errors of a fix are a function of the seed and of its index (motion time divided by the
period), so they do not depend on which fixes were computed before.
"""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.rates import rate_on_earth
from ins_sim.core.numerics.instants import period_ns, seconds
from ins_sim.core.streams.faults import check_finite, check_interval, check_unit, StreamFault
from ins_sim.core.timeseries.fixes import GnssFix, no_gnss_fix, OUTAGE
from .sensor import Sensor

# Smallest reported sigma, m and m/s: a navigator divides by the variance of a fix.
LEAST_SIGMA = 1e-3


class Gnss(Sensor):
    """
    The GNSS receiver of GnssSettings: accepts streamed truth samples and returns fixes.

    Raises ValueError if the period of the fixes is not a multiple of the truth period, because
    a fix needs a truth sample at its instant.
    """

    def __init__(self, settings):
        self._settings = settings
        self._dt_ns = period_ns(settings.rate_hz)
        self.period_ns = period_ns(settings.gnss.rate_hz)
        if self.period_ns % self._dt_ns:
            raise ValueError(f'gnss.rate_hz is {settings.gnss.rate_hz:g} Hz, a period of '
                             f'{self.period_ns * 1e-9:.9g} s; expected a multiple of the period '
                             f'of rate_hz, {self._dt_ns * 1e-9:.9g} s: a fix needs a sample of '
                             'the truth')
        self.latency_ns = round(1e6 * settings.gnss.latency_ms)
        self._spin = ellipsoid.rotation_rate(settings.earth.rotation)
        self.change(settings)
        errors, reported = settings.errors, settings.reported
        self._position_sigma = tuple(
            max(LEAST_SIGMA, math.sqrt(noise * noise + drift * drift)) if given < 0.0 else given
            for noise, drift, given in zip(errors.position_noise_m, errors.position_drift_m,
                                           reported.position_sigma_m))
        self._velocity_sigma = tuple(
            max(LEAST_SIGMA, noise) if given < 0.0 else given for noise, given in zip(
                errors.velocity_noise_m_s, reported.velocity_sigma_m_s))
        self._errors = None
        self.forced = False
        self.reset()

    def reset(self):
        """Forget the stream; the next sample is the first."""
        self._last_ns = None
        self._alone = False

    def change(self, settings):
        """Use the outages and the position jump of these GnssSettings from the next fix on."""
        self._outages = _spans(settings.outages.start_s, settings.outages.end_s)
        jump = settings.jump
        self._jumps = _spans((jump.start_s,), (jump.end_s,)) if any(jump.offset_m) else ()
        self._jump_m = jump.offset_m

    @property
    def next_ns(self):
        """Motion time of the next fix, None before the first sample."""
        if self._last_ns is None:
            return None
        return (self._last_ns // self.period_ns + 1) * self.period_ns

    def force_outage(self, forced):
        """Mark every fix invalid (outage) from now on, or return to the scheduled outages."""
        self.forced = forced

    def push(self, t_ns, truth):
        """
        Process one truth sample and return a list with the fix at its instant, or an empty list.

        The first sample may be repeated; its result is then returned again.

        Parameters
        ----------
        t_ns : motion time, ns
        truth : latitude (rad), longitude (rad), height (m), v_n (east, north, up, m/s), q_nb and
            the angular rate of the body relative to the Earth in body axes (rad/s)

        Raises
        ------
        StreamFault
            On NaN, repeated or backwards stamps, gaps, and a step over the instant of a fix.
        """
        lat, lon, height, v_n, q_nb, rate = truth
        check_finite('truth', t_ns, (lat, lon, height), v_n, q_nb, rate)
        check_unit('truth', t_ns, q_nb)
        last_ns = self._last_ns
        first = last_ns is None or (self._alone and t_ns == last_ns)
        if not first:
            # Truth samples at less than the expected interval are accepted.
            if not 0 < t_ns - last_ns <= self._dt_ns:
                check_interval('truth', t_ns, last_ns, self._dt_ns)
            due_ns = t_ns // self.period_ns * self.period_ns
            if last_ns < due_ns < t_ns:
                raise StreamFault(f'truth steps from {seconds(last_ns)} to {seconds(t_ns)} over '
                                  f'{seconds(due_ns)}; expected a sample there, the instant of '
                                  'a fix', restart=True)
        self._last_ns, self._alone = t_ns, first
        return [] if t_ns % self.period_ns else [self.fix(t_ns, truth)]

    def advance(self, truth):
        """
        Return the fixes of a Truth record, or of a part of one; same bits as single pushes.

        Raises ValueError for NaN and if a fix has no truth sample at its instant.
        """
        index, rest = np.divmod(truth.t_ns, self.period_ns)
        over = np.flatnonzero((np.diff(index) > 0) & ((rest[1:] > 0) | (np.diff(index) > 1)))
        if len(over):
            raise ValueError(f'truth steps from {seconds(truth.t_ns[over[0]])} to '
                             f'{seconds(truth.t_ns[over[0] + 1])} over the instant of a fix; '
                             'expected a sample there')
        found = []
        for t_ns, sample in self.samples(truth[np.flatnonzero(rest == 0)]):
            lat, lon, height, v_n, q_nb, rate = sample
            check_finite('truth', t_ns, (lat, lon, height), v_n, q_nb, rate)
            found.append(self.fix(t_ns, sample))
        return found

    def samples(self, truth):
        """Yield the arguments of push for each instant of a Truth record."""
        for t_ns, lat, lon, height, v_n, q_nb, omega in zip(
                truth.t_ns.tolist(), truth.lat.tolist(), truth.lon.tolist(),
                truth.height.tolist(), truth.v_n.tolist(), truth.q_nb.tolist(),
                truth.omega_ib_b.tolist()):
            rate = rate_on_earth(lat, q_nb, omega, self._spin)
            yield t_ns, (lat, lon, height, v_n, q_nb, rate)

    def fix(self, t_ns, truth):
        """
        Return the fix at t_ns, which must be a multiple of the period; truth as in ``push``.

        For a lever arm l the antenna is at C l from the origin of the body axes and moves with
        C (omega x l) relative to it. Velocity and errors are resolved in the navigation axes at
        that origin.
        """
        arrival_ns = t_ns + self.latency_ns
        if self.forced or _inside(t_ns, self._outages):
            return no_gnss_fix(t_ns, OUTAGE, arrival_ns)
        lat, lon, height, v_n, q_nb, rate = truth
        if self._errors is None:
            self._errors = _Errors(self._settings, self.period_ns)
        off, slip = self._errors.at(t_ns // self.period_ns)
        if _inside(t_ns, self._jumps):
            off = _sum(off, self._jump_m)
        lever = self._settings.lever_arm_m
        off = _sum(off, quaternion.rotate(q_nb, lever))
        v_n = _sum(_sum(v_n, quaternion.rotate(q_nb, quaternion.cross(rate, lever))), slip)
        lat, lon, height = ellipsoid.moved(lat, lon, height, off)
        return GnssFix(t_ns, lat, math.remainder(lon, 2.0 * math.pi), height, v_n,
                       self._position_sigma, self._velocity_sigma, arrival_ns=arrival_ns)


class _Errors:
    """Errors of position (m) and velocity (m/s) by the index of the fix."""

    def __init__(self, settings, dt_ns):
        # Imported with the first fix, so that a node does not load NumPy's generators at start.
        from ins_sim.core.numerics.noise import BLOCK, indexed_noise
        from ins_sim.core.numerics.processes import Processes
        errors, seed, run = settings.errors, settings.seed, settings.run
        self._sigmas = errors.position_noise_m, errors.velocity_noise_m_s
        self._streams = [indexed_noise(seed, run, f'gnss.{name}', 3)
                         for name in ('position', 'velocity')]
        self._block, self._drifts_of = BLOCK, None
        self._processes = None
        if any(errors.position_drift_m):
            self._processes = Processes(seed, run, 'gnss.position_drift', errors.position_drift_m,
                                        (errors.position_drift_time_s,) * 3, dt_ns * 1e-9)

    def at(self, index):
        """Return the errors of position (m) and velocity (m/s) as (east, north, up) tuples."""
        position, velocity = ([s * n for s, n in zip(sigma, stream.normal(index))]
                              for sigma, stream in zip(self._sigmas, self._streams))
        if self._processes is not None:
            block, row = divmod(index, self._block)
            if block != self._drifts_of:
                self._drifts, self._drifts_of = self._processes.block(block).tolist(), block
            position = _sum(position, self._drifts[row])
        return position, velocity


def _sum(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _inside(t_ns, spans):
    return any(start <= t_ns < end for start, end in spans)


def _spans(starts, ends):
    """Return pairs (start, end) in ns."""
    return tuple((round(1e9 * start), round(1e9 * end)) for start, end in zip(starts, ends))
