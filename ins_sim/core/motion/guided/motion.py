"""
Flight along a route with a lateral offset that is steered by sideslip commands.

The track of ``route`` gives the legs, the turns and the wind; the vehicle is z metres to the right
of it. The nose differs from the direction of the air velocity by the sideslip: without wind, and
with the course chi of the track, the heading is chi + atan(v_z/V) - beta. The bank is that of the
track; on a leg the vehicle is steered without bank.
"""

import math

from ins_sim.core.attitude import angles, quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.numerics import elementary, taylor
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.numerics.units import STANDARD_GRAVITY
from ins_sim.core.timeseries.histories import SteeredStates, Truth
import numpy as np
from ..route.motion import RouteMotion
from ..truth import in_body, translation, truth_from_pose
from .steered import SteeredHistory

# ``one`` evaluates the track in advance, at AHEAD instants one control period apart. It keeps the
# results for up to PHASES different phases of the period.
AHEAD, PHASES = 256, 64
# Up to this number of instants, evaluating them one by one is faster.
FEW = 2


class GuidedMotion(RouteMotion):
    """
    The flight described by settings.FlownRouteSettings and settings.GuidedSettings.

    The motion is known up to the end of the last commanded control period: ``known_ns`` of motion
    time, or ``end_s`` in s. It depends on the commands only, not on how they are computed.
    ``begin`` restarts it; ``command`` adds one control period. Before the first command the flight
    is straight.

    arrival_s: when the track reaches the last turning point; route and turns: see RouteMotion.
    Raises ValueError, with one sentence, for a flight that cannot be flown.
    """

    end_name = 'up to which the guided motion has been steered'

    def __init__(self, settings, guided, earth_settings):
        if settings.weave_deg:
            raise ValueError(f'motion.route.weave_deg is {settings.weave_deg:g} deg with '
                             'motion.kind guided; expected 0: the vehicle is steered')
        super().__init__(settings, earth_settings)
        self.arrival_s = self.end_s
        self._steered = SteeredHistory(
            guided.side_force_m_s2_rad, guided.lag_s, period_ns(guided.control_rate_hz),
            (guided.offset_m, guided.offset_rate_m_s))
        self._force, self._lag_s = guided.side_force_m_s2_rad, guided.lag_s
        self.period_ns = self._steered.period_ns
        half = elementary.sincos(-0.5 * self._attack)
        self._nose_up = (0.0, half[0], 0.0, half[1])
        # For each phase of the control period: the number of the first period evaluated, and the
        # results of ``_flow_at`` from that period on.
        self._ahead = {}
        self.begin(0)

    @property
    def known_ns(self):
        """Return the motion time up to which the motion is known."""
        return self._steered.known_ns

    def check_end(self, end_s):
        """Raise ValueError if a run up to end_s, s, has not been flown."""
        if end_s > self.end_s and not self._steered.is_steered:
            raise ValueError('motion.kind is guided; expected another kind: a guided motion '
                             'depends on the navigation and can be flown only by simulate, '
                             'monte-carlo and the live nodes')
        super().check_end(end_s)

    def length_s(self, start_s, duration_s):
        """
        Return the length in s of a run that begins at start_s; duration_s 0: up to the arrival.

        Raises ValueError if the run would last beyond the arrival.
        """
        if start_s + duration_s > self.arrival_s or start_s >= self.arrival_s:
            raise ValueError(f'start_s + duration_s is {start_s + duration_s:g} s; expected at '
                             f'most {self.arrival_s:g} s, the arrival at the last turning point')
        return duration_s or self.arrival_s - start_s

    def begin(self, t_ns):
        """Forget all commands; the first one will be given at motion time t_ns."""
        self._steered.begin(t_ns)
        self.end_s = t_ns / 1e9

    def command(self, t_ns, beta_c):
        """
        Add the control period that begins at t_ns.

        Parameters
        ----------
        t_ns : int
            Motion time; must be the end of the period before, ``known_ns``.
        beta_c : float
            Commanded sideslip at the end of the period, rad; the command changes linearly to it.

        Raises
        ------
        ValueError
            For any other time, or if the command is not finite.
        """
        self._steered.command(t_ns, beta_c)
        self.end_s = self.known_ns / 1e9

    def forget(self, t_ns):
        """Forget the motion before t_ns; a node needs only as much as its sensors look back."""
        self._steered.forget(t_ns)

    def states(self, t_ns):
        """Return the SteeredStates at motion times t_ns (n,) int64."""
        z, v_z, beta, command, _ = self._steered.at(t_ns)
        return SteeredStates(np.asarray(t_ns), z, v_z, beta, command)

    def at(self, t_ns):
        """Return the Truth at motion times t_ns (n,) int64; ValueError if it is not known."""
        t_ns = np.asarray(t_ns)
        if 0 < len(t_ns) <= FEW:
            return Truth(t_ns, *map(np.array, zip(*map(self.one, t_ns.tolist()))))
        pose = self._pose(self._flow_at(t_ns), self._steered.at(t_ns), _series)
        return truth_from_pose(t_ns, *pose, self._rotation, self._gravity)

    def one(self, t_ns):
        """
        Return the truth at one instant, with the bits of ``at`` but faster.

        Returns
        -------
        tuple
            lat, lon (rad), height (m), v_n (m/s), q_nb, omega_ib_b (rad/s), f_ib_b (m/s^2),
            floats and tuples of floats.
        """
        lat, lon, height, q_nb = self._pose(self._flow(t_ns), self._steered.one(t_ns),
                                            taylor.InstantSeries)
        v_n, omega_in_n, f_n = translation(lat, lon, height, self._rotation, self._gravity)
        return (lat.value, lon.value, height.value, v_n, *in_body(omega_in_n, f_n, q_nb))

    def _flow(self, t_ns):
        """Return ``_flow_at`` of one instant; it is evaluated for several periods in advance."""
        # Truth and sensors ask for the same phases in every control period.
        period, phase = divmod(t_ns, self.period_ns)
        first, flows = self._ahead.get(phase, (0, ()))
        if not 0 <= period - first < len(flows):
            stamps = t_ns + self.period_ns * np.arange(AHEAD, dtype=np.int64)
            columns = [series.c.T.tolist() for series in self._flow_at(stamps)]
            flows = [tuple(taylor.InstantSeries(tuple(c)) for c in row)
                     for row in zip(*columns)]
            if len(self._ahead) >= PHASES:
                self._ahead.clear()
            self._ahead[phase] = first, flows = period, flows
        return flows[period - first]

    def _flow_at(self, t_ns):
        """
        Return the quantities that do not depend on the commands, as Series at the instants.

        These are: lat, lon, height of the track; lat and lon per metre to its right; the heading,
        and its change on a parallel track one metre to the right (convergence of meridians); the
        components of the unit vector to the right of the track, along and to the right of the
        heading; and the attitude, by bank and angle of attack, relative to level axes along the
        nose.
        """
        t = t_ns * 1e-9
        lat, lon, psi = self._track.at(t)
        sin_lat, cos_lat = taylor.sincos(lat)
        sin_psi, cos_psi = taylor.sincos(psi)
        east, north = (sin_psi * self._airspeed + self.wind[0],
                       cos_psi * self._airspeed + self.wind[1])
        size = taylor.sqrt(east * east + north * north)
        # Unit vector to the right of the velocity over ground.
        right_e, right_n = north / size, -east / size
        d_lat, d_lon = ellipsoid.level_angles(right_e, right_n, sin_lat, cos_lat, self._height)
        along = right_e * sin_psi + right_n * cos_psi
        aside = right_e * cos_psi - right_n * sin_psi
        # The bank also balances the Coriolis force, as in ``route``.
        turn = psi.derivative() - (lon.derivative() + 2.0 * self._spin) * sin_lat
        bank = taylor.atan2(turn * self._airspeed, turn.constant(STANDARD_GRAVITY))
        height = psi.constant(self._height)
        if self.gusts:
            east, north, up = self.gusts.displacement(t)
            by_lat, by_lon = ellipsoid.level_angles(east, north, sin_lat, cos_lat, self._height)
            lat, lon, height = lat + by_lat, lon + by_lon, height + up
        return (lat, lon, height, d_lat, d_lon,
                *(x.to_order(1) for x in (psi, d_lon * sin_lat, along, aside)),
                *quaternion.multiply(angles.about_axis(0, bank), self._nose_up))

    def _pose(self, flow, steered, series):
        """Return lat, lon, height, q_nb; series: function from Taylor coefficients to a Series."""
        lat, lon, height, d_lat, d_lon, psi, converged, along, aside, *level = flow
        z, v_z, beta, command, _ = steered
        force = beta * -self._force
        offset = series((z, v_z, 0.5 * force))
        lat, lon = lat + offset * d_lat, lon + offset * d_lon
        rate = series((v_z, force))
        slip = taylor.atan2(rate * aside, rate * along + self._airspeed) - series(
            (beta, (command - beta) * (1.0 / self._lag_s)))
        sin, cos = taylor.sincos((0.5 * math.pi - (psi + offset * converged + slip)) * 0.5)
        x, y, z, w = level
        return lat, lon, height, (cos * x - sin * y, cos * y + sin * x, cos * z + sin * w,
                                  cos * w - sin * z)


def _series(coefficients):
    return taylor.Series(np.stack(coefficients))


def guided_motion(motion, datum, earth):
    """Return the GuidedMotion of MotionSettings; earth: Earth; the datum is not used."""
    return GuidedMotion(motion.route, motion.guided, earth)
