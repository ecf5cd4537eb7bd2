"""
Flight along a route of great circles, with wind, gusts and a weaving heading.

Between turns the track over ground is the great circle of ``earth.great_circle``; turns are
coordinated and flown inside the corners (``turn``). The vehicle points along its velocity relative
to the air, gusts excluded. With the weave ``flown`` this velocity oscillates, so that the track
weaves too; with ``slipping`` only the heading oscillates, with sideslip, on a straight track.
Gusts displace the vehicle. The body axes are those of the velocity relative to the air, banked
about it as in a coordinated turn, and pitched up about the left axis by the angle of attack. With
the rotation of the local axes and the Coriolis force the bank is

    atan(V [psi' - (2 Omega + lon') sin lat]/g)                                 (Groves 5.44, 5.53)
"""

import math

import numpy as np

from ins_sim.core.attitude import angles, quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.great_circle import GreatCircleRoute
from ins_sim.core.numerics import elementary, taylor
from ins_sim.core.numerics.units import STANDARD_GRAVITY
from ..motion import Motion
from ..truth import truth_from_pose
from .gusts import Gusts
from .track import Flow, leg_piece, RouteTrack
from .turn import turn_between
from .weave import Weave

STEEPEST_DEG = 60.0
GUST_MARGIN = 3.0
# Closer to the poles, longitude and the direction of north change too fast.
POLEMOST_DEG = 89.0


class RouteMotion(Motion):
    """
    The flight of settings.FlownRouteSettings, from the first turning point at motion time zero.

    Weave and gusts are added to the track; they displace it by metres.

    Parameters
    ----------
    settings : settings.FlownRouteSettings
    earth_settings : Earth

    Attributes
    ----------
    end_s : arrival at the last turning point, motion time, s
    route : GreatCircleRoute
    gusts : Gusts or None
    wind : wind velocity, east and north, m/s
    turns : (start, end) of each turn, motion time, s

    Raises
    ------
    ValueError : with one sentence, for a route that cannot be flown
    """

    end_name = 'the arrival at the last turning point'

    def __init__(self, settings, earth_settings):
        self._rotation, self._gravity = earth_settings.rotation, earth_settings.gravity
        self._spin = ellipsoid.rotation_rate(self._rotation)
        self._height, self._airspeed = settings.height_m, settings.airspeed_m_s
        self._attack = math.radians(settings.attack_deg)
        self.route = GreatCircleRoute.of_points(settings.points)
        self._weave = None
        if settings.weave_deg:
            self._weave = Weave(math.radians(settings.weave_deg), settings.weave_period_s,
                                self._airspeed)
        self.gusts = None
        if settings.gust_m_s:
            self.gusts = Gusts(settings.gust_m_s, settings.gust_length_m, self._airspeed,
                               settings.gust_seed)
        self._slips = settings.weave == 'slipping'
        made_good = self._airspeed
        if self._weave and not self._slips:
            made_good *= self._weave.made_good
        _check(settings, made_good)
        self.wind = _wind(settings)
        self._track, self.turns = _track(
            Flow(self._height, made_good, self.wind), self.route.legs,
            math.radians(settings.turn_rate_deg_s), settings.roll_in_s)
        self.end_s = self._track.end_s

    def at(self, t_ns):
        """Return the Truth at motion times t_ns (n,) int64; legs are extended beyond both ends."""
        t = np.asarray(t_ns) * 1e-9
        lat, lon, psi = self._track.at(t)
        east, north, up = self.gusts.displacement(t) if self.gusts else (psi * 0.0,) * 3
        course = psi
        if self._weave:
            time = taylor.Series.time(t, 2)
            psi = psi + self._weave.angle(time)
            if not self._slips:
                along, right = self._weave.displacement(time)
                sin, cos = taylor.sincos(course)
                east, north = east + along * sin + right * cos, north + along * cos - right * sin
                course = psi
        sin_lat, cos_lat = taylor.sincos(lat)
        d_lat, d_lon = ellipsoid.level_angles(east, north, sin_lat, cos_lat, self._height)
        lat, lon = lat + d_lat, lon + d_lon
        # The bank must also balance the Coriolis force, or the aircraft would drift off the great
        # circle.
        turn = course.derivative() - (lon.derivative() + 2.0 * self._spin) * sin_lat
        bank = taylor.atan2(turn * self._airspeed, psi.constant(STANDARD_GRAVITY))
        # The second axis points left: nose up is a negative rotation.
        q_nb = quaternion.multiply(angles.from_angles(-psi, psi.constant(0.0), bank),
                                   angles.about_axis(1, psi.constant(-self._attack)))
        return truth_from_pose(t_ns, lat, lon, up + self._height, q_nb, self._rotation,
                               self._gravity)


def route_motion(motion, datum, earth):
    """Return the RouteMotion of MotionSettings; earth: Earth; the datum is not used."""
    return RouteMotion(motion.route, earth)


def _wind(settings):
    """Return the wind velocity, east and north, m/s; the setting is where it blows from."""
    direction = math.radians(settings.wind_from_deg)
    sin, cos = elementary.sincos(direction)
    return -settings.wind_m_s * sin, -settings.wind_m_s * cos


def _check(settings, made_good):
    """Raise ValueError for impossible flights; made_good: mean airspeed with the weave, m/s."""
    strongest = settings.wind_m_s + GUST_MARGIN * settings.gust_m_s
    if strongest >= made_good:
        raise ValueError(
            f'motion.route.wind_m_s and {GUST_MARGIN:g} times motion.route.gust_m_s are '
            f'{strongest:g} m/s; expected less than the airspeed made good, {made_good:g} m/s')
    rate = math.radians(settings.turn_rate_deg_s)
    if settings.weave == 'flown':
        rate += math.radians(settings.weave_deg) * 2.0 * math.pi / settings.weave_period_s
    bank = math.degrees(elementary.atan2(settings.airspeed_m_s * rate, STANDARD_GRAVITY))
    if bank > STEEPEST_DEG:
        raise ValueError(
            f'motion.route.turn_rate_deg_s {settings.turn_rate_deg_s:g} deg/s and the weave need '
            f'a bank of {bank:.1f} deg at {settings.airspeed_m_s:g} m/s; expected at most '
            f'{STEEPEST_DEG:g} deg')


def _track(flow, legs, rate, roll_s):
    """Return the Track along legs and the (start, end) of its turns, s."""
    pieces, turns, time, x = [], [], 0.0, 0.0
    for k, leg in enumerate(legs):
        try:
            turn = None if leg is legs[-1] else turn_between(flow, leg, legs[k + 1], rate, roll_s)
        except ValueError as error:
            raise ValueError(f'motion.route.points: {error} at point {k + 2}') from None
        last = turn[0] if turn else leg.length
        if last <= x:
            raise ValueError(
                f'motion.route.points: the leg from point {k + 1} to {k + 2} is '
                f'{leg.length:.0f} m long; expected more than {leg.length + x - last:.0f} m for '
                'the turns at its ends')
        pieces.append(leg_piece(flow, leg, x, last))
        time += pieces[-1].length_s
        x = 0.0
        if turn:
            pieces.append(turn[1])
            turns.append((time, time + turn[1].length_s))
            time, x = turns[-1][1], turn[2]
    nearest = math.degrees(max(np.abs(piece.lat).max() for piece in pieces))
    if nearest > POLEMOST_DEG:
        raise ValueError(f'motion.route.points: the route reaches a latitude of {nearest:.2f} deg;'
                         f' expected at most {POLEMOST_DEG:g} deg')
    return RouteTrack(flow, pieces), turns
