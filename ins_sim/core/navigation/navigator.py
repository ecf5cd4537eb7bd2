"""The inertial navigator of a simulated IMU: starts from the truth and is compared with it."""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import compilation
from ins_sim.core.timeseries.histories import NavErrors, NavStates
from . import whole_run
from .errors import ErrorMeter
from .increments import fixed_rate_increments, integrals
from .strapdown import Strapdown
from .vertical_channel import DAMPED, damping, FREE, FROM_TRUTH, NO_DAMPING

CHANNELS = {'truth': FROM_TRUTH, 'free': FREE, 'damped': DAMPED}


class InertialNavigator:
    """
    The strapdown of one IMU, unaided except for its vertical channel.

    The first sample after ``initial.after_s`` starts the strapdown at the truth plus the initial
    errors; its increments serve only as the previous sample of the next step.

    settings: StrapdownSettings.  covariance: a FreeCovariance propagated together with the
    strapdown, or None.
    """

    def __init__(self, settings, covariance=None):
        self._settings, self._covariance = settings, covariance
        self._spin = ellipsoid.rotation_rate(settings.earth.rotation)
        self._gravity = ellipsoid.GRAVITY_TERMS[settings.earth.gravity]
        self._integrated = settings.input == 'integrated'
        self._channel = CHANNELS[settings.vertical.channel]
        self._after_ns = round(settings.initial.after_s * 1e9)
        self._strapdown = self._first_ns = None

    @property
    def navigates(self):
        """Return whether there is a solution."""
        return self._strapdown is not None

    @property
    def solution(self):
        """Return lat, lon, height, v_n, q_nb at the last sample."""
        return self._strapdown.solution

    @property
    def carry(self):
        """Return the state of ``whole_run.solve``: orientation, PLACE, integrals and instant."""
        ins = self._strapdown
        return ins.orientation, ins.place, self._last, ins.t_ns

    def step(self, t_ns, omega, f, truth):
        """
        Process the reading whose interval ends at t_ns.

        Parameters
        ----------
        t_ns : instant
        omega, f : tuples of three, rad/s and m/s^2
        truth : (lat, lon, height, v_n, q_nb) at t_ns

        Returns
        -------
        the errors of ``ErrorMeter`` (attitude, velocity, position, drift), or None before there is
        a solution

        """
        ins = self._strapdown
        if ins is None:
            if self._waits(t_ns):
                return None
            self._start(t_ns, omega, f, truth)
            ins = self._strapdown
        else:
            now = integrals(omega, f, (t_ns - ins.t_ns) * 1e-9)
            phi, u = fixed_rate_increments(self._integrated, now, self._last)
            self._last = now
            ins.advance(t_ns, phi, u, truth[2], truth[3][2])
            if self._covariance is not None:
                self._covariance.take(t_ns, omega, f, self)
        return self._meter.measure(ins.elapsed_s, (ins.q_ib, ins.lat, ins.lon, ins.height, ins.v),
                                   truth)

    def advance(self, t_ns, omega, f, truth):
        """
        Process samples without a gap; return NavStates and NavErrors of those with a solution.

        t_ns (n,); omega, f (n, 3), rad/s and m/s^2; truth: the Truth at t_ns.  The results have
        the same bits as those of ``step``.
        """
        first = 0
        while self._strapdown is None and first < len(t_ns) and self._waits(int(t_ns[first])):
            first += 1
        t_ns, omega, f, truth = t_ns[first:], omega[first:], f[first:], truth[first:]
        solved = np.empty((len(t_ns), whole_run.SOLVED))
        begun = 0
        if self._strapdown is None and len(t_ns):
            self._start(int(t_ns[0]), tuple(omega[0].tolist()), tuple(f[0].tolist()),
                        truth.one(0))
            ins, begun = self._strapdown, 1
            solved[0] = ins.lat, ins.lon, ins.height, *ins.v, *ins.q_ib
        if len(t_ns) > begun:
            self._solve(t_ns[begun:], omega[begun:], f[begun:], truth[begun:], solved[begun:])
        states, errors = self._judged(t_ns, solved, truth)
        if self._covariance is not None:
            self._covariance.take_block(t_ns[begun:], omega[begun:], f[begun:], states[begun:])
        return states, errors

    def _solve(self, t_ns, omega, f, truth, solved):
        ins = self._strapdown
        inputs = (self.carry, ins.spin, ins.start_ns, ins.channel, ins.damping, self._gravity,
                  self._integrated, t_ns, omega, f, truth.height,
                  np.ascontiguousarray(truth.v_n[:, 2]))
        carry = compilation.run(whole_run.solve, len(t_ns), inputs, solved)
        orientation, place, self._last, last_ns = carry
        ins.resume(last_ns, orientation, place)

    def _judged(self, t_ns, solved, truth):
        spin, ins = self._spin, self._strapdown
        judged, slopes = np.empty((len(t_ns), whole_run.JUDGED)), np.empty((len(t_ns), 3))
        if len(t_ns):
            t_s = (t_ns - ins.start_ns) * 1e-9
            compilation.run(whole_run.judge, len(t_ns),
                            (spin, t_s, solved, truth.lat, truth.lon, truth.height, truth.v_n,
                             truth.q_nb), judged, whole_run.judge_arrays)
            self._meter.carry = compilation.run(
                whole_run.drifts, len(t_ns),
                (self._meter.carry, spin, t_s, truth.lat, truth.lon, judged), slopes)
        return (NavStates(t_ns, solved[:, 0], solved[:, 1], solved[:, 2], solved[:, 3:6],
                          judged[:, 0:4]),
                NavErrors(t_ns, judged[:, 4:7], judged[:, 7:10], judged[:, 10:13], slopes))

    def _waits(self, t_ns):
        """Return whether t_ns is before the start."""
        if self._first_ns is None:
            self._first_ns = t_ns
        return t_ns < self._first_ns + self._after_ns

    def _start(self, t_ns, omega, f, truth):
        lat, lon, height, v, q_nb = truth
        initial, vertical = self._settings.initial, self._settings.vertical
        constants = NO_DAMPING
        if self._channel == DAMPED:
            constants = damping(vertical.time_constant_s)
        error = quaternion.exponential(tuple(map(math.radians, initial.attitude_error_deg)))
        ins = Strapdown(t_ns, (lat, lon, height, v, quaternion.multiply(error, q_nb)), self._spin,
                        self._channel, constants, self._settings.orientation, self._gravity)
        # The given attitude error is that of the inertial attitude, which does not depend on the
        # position.
        lat, lon, off_height = ellipsoid.moved(lat, lon, height, initial.position_error_m)
        v_e, v_n, v_u = (a + b for a, b in zip(v, initial.velocity_error_m_s))
        if self._channel == FROM_TRUTH:
            off_height, v_u = height, v[2]
        ins.move(lat, lon, off_height, (v_e, v_n, v_u))
        self._strapdown, self._meter = ins, ErrorMeter(self._spin)
        self._last = integrals(omega, f, 1.0 / self._settings.rate_hz)
        if self._covariance is not None:
            self._covariance.begin(t_ns, ins.solution)
