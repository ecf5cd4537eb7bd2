"""
The track of a vehicle in a steady wind, along great circles and in turns.

The state is geodetic latitude, longitude, and the heading of the air velocity; airspeed and height
are constant. On the sphere of the great circles the velocity V = (V_E, V_N) has the components
p = m_E V_E and q = m_N V_N (``core.earth.sphere_metric``). The path is a great circle if the
course atan2(p, q) changes at the rate sin(lat_c) lon'. The corresponding heading, and that of a
turn relative to the great circle, follow by differentiating p and q.
"""

import math

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.sphere_metric import (direction_on_earth, AXIS_RATIO2, sphere_metric,
                                              SQUASH)
from ins_sim.core.numerics import taylor
from ins_sim.core.numerics.elementary import atan2, sincos, sqrt

# Order of the Taylor expansions about the knots; the remainder is below rounding
# (docs/design/route.md).
ORDER = 10
STEP_M = 2000.0
# Nodes and weights of Gauss-Legendre quadrature with eight points.
_NODES = (-0.9602898564975363, -0.7966664774136267, -0.525532409916329, -0.1834346424956498,
          0.1834346424956498, 0.525532409916329, 0.7966664774136267, 0.9602898564975363)
_WEIGHTS = (0.10122853629037626, 0.22238103445337448, 0.31370664587788727, 0.362683783378362,
            0.362683783378362, 0.31370664587788727, 0.22238103445337448, 0.10122853629037626)


class Flow:
    """Flight at a constant height (m) and airspeed (m/s) in a wind (east, north, m/s)."""

    def __init__(self, height, airspeed, wind):
        self.height, self.airspeed, self.wind = height, airspeed, wind

    def rates(self, sin_lat, cos_lat, sin_psi, cos_psi, turn):
        """
        Return lat', lon', psi' (rad/s) if the heading turns at the rate turn off a great circle.

        Arguments are floats, or Series of the same instants.
        """
        a_e, a_n = sin_psi * self.airspeed, cos_psi * self.airspeed
        v_e, v_n = a_e + self.wind[0], a_n + self.wind[1]
        lat_rate, lon_rate = ellipsoid.level_angles(v_e, v_n, sin_lat, cos_lat, self.height)
        m_e, m_n, by_e, by_n = sphere_metric(sin_lat, cos_lat, self.height)
        p, q = v_e * m_e, v_n * m_n
        sin_c = sin_lat * AXIS_RATIO2 / sqrt(1.0 - SQUASH * (sin_lat * sin_lat))
        straight = ((p * p + q * q) * sin_c * lon_rate - p * q * (by_e - by_n) * lat_rate) / (
            m_e * q * a_n + m_n * p * a_e)
        return lat_rate, lon_rate, straight + turn

    def course(self, lat, psi):
        """Return the course on the sphere, rad, floats."""
        m_e, m_n, _, _ = sphere_metric(*sincos(lat), self.height)
        sin_psi, cos_psi = sincos(psi)
        return atan2((self.airspeed * sin_psi + self.wind[0]) * m_e,
                     (self.airspeed * cos_psi + self.wind[1]) * m_n)

    def on_leg(self, leg, x):
        """Return lat, lon, heading (rad), X' (m/s) at distance x (n,), m, on a Leg."""
        lat, lon = leg.from_xz(x, np.zeros_like(x))
        chi = leg.course(lat, lon)
        m_e, m_n, _, _ = sphere_metric(*sincos(lat), self.height)
        east, north, size = direction_on_earth(m_e, m_n, chi)
        w_e, w_n = self.wind
        # Wind triangle: the air velocity cancels the cross-track component of the wind.
        across, along = w_e * north - w_n * east, w_e * east + w_n * north
        speed = sqrt(self.airspeed * self.airspeed - across * across) + along
        psi = atan2(speed * east - w_e, speed * north - w_n)
        return lat, lon, psi, ellipsoid.MEAN_RADIUS * speed / size


class LegPiece:
    """
    Knots of one piece of the track.

    Attributes
    ----------
    t : (m,) time since the start of the piece, s
    lat, lon : (m,) geodetic latitude and longitude, rad
    psi : (m,) heading of the air velocity, rad
    turn : (m, j) Taylor coefficients of the turn rate at each knot
    length_s : duration of the piece, s
    """

    def __init__(self, t, lat, lon, psi, turn, length_s):
        self.t, self.lat, self.lon, self.psi = t, lat, lon, psi
        self.turn, self.length_s = turn, length_s


def leg_piece(flow, leg, first, last):
    """
    Return the LegPiece along a leg from distance X = first to last, m.

    The time is the integral of dX/X' by Gauss-Legendre quadrature with eight points every two
    kilometres; this is exact to rounding, because X' varies over thousands of kilometres.
    """
    count = max(1, math.ceil((last - first) / STEP_M))
    half = 0.5 * (last - first) / count
    x = first + 2.0 * half * np.arange(count)
    spent = np.zeros(count)
    for node, weight in zip(_NODES, _WEIGHTS):
        spent = spent + weight / flow.on_leg(leg, (x + half) + half * node)[3]
    t = np.concatenate([[0.0], np.cumsum(half * spent)])
    lat, lon, psi, _ = flow.on_leg(leg, x)
    return LegPiece(t[:-1], lat, lon, psi, np.zeros((count, 1)), float(t[-1]))


class RouteTrack:
    """The pieces in sequence, from time zero; flow: a Flow."""

    def __init__(self, flow, pieces):
        starts = np.concatenate([[0.0], np.cumsum([p.length_s for p in pieces])])
        self.end_s = float(starts[-1])
        self._t = np.concatenate([p.t + start for p, start in zip(pieces, starts)])
        lat, lon, psi = (np.concatenate([getattr(p, name) for p in pieces])
                         for name in ('lat', 'lon', 'psi'))
        turn = np.zeros((ORDER, len(lat)))
        first = 0
        for p in pieces:
            turn[:p.turn.shape[1], first:first + len(p.t)] = p.turn.T
            first += len(p.t)
        # Unwrap longitude and heading across knots, so that quaternions keep their sign.
        self._coefficients = _expand(flow, lat, np.unwrap(lon), np.unwrap(psi), turn)

    def at(self, t):
        """
        Return the Series, of order 2, of lat, lon and heading (rad) at times t (n,), s.

        Before zero and after the end the first and the last leg are extended.
        """
        index = np.clip(np.searchsorted(self._t, t, side='right') - 1, 0, None)
        x = t - self._t[index]
        a = self._coefficients[:, :, index]
        c0, c1, c2 = a[ORDER], np.zeros_like(a[0]), np.zeros_like(a[0])
        for k in range(ORDER - 1, -1, -1):
            c2 = c2 * x + c1
            c1 = c1 * x + c0
            c0 = c0 * x + a[k]
        return tuple(taylor.Series(np.stack(rows)) for rows in zip(c0, c1, c2))


def _expand(flow, lat, lon, psi, turn):
    """Return the Taylor coefficients of lat, lon, psi at the knots, (ORDER + 1, 3, m)."""
    c = np.zeros((ORDER + 1, 3, len(lat)))
    c[0] = lat, lon, psi
    for k in range(ORDER):
        lat_k, psi_k = (taylor.Series(c[:k + 1, i]) for i in (0, 2))
        rates = flow.rates(*taylor.sincos(lat_k), *taylor.sincos(psi_k),
                           taylor.Series(turn[:k + 1]))
        for i, rate in enumerate(rates):
            c[k + 1, i] = rate.c[k] / (k + 1)
    return c
