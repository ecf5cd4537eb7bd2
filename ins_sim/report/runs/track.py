"""Tracks of a run: the true places of the vehicle and those of its solutions."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.earth import ellipsoid
from ..charts.chart import Chart, Curve, DASHED, DASH_DOT, DOT, Markers, Panel, TRIANGLE
from ..charts.palette import BLACK, BLUE, GREEN, ORANGE, RED
from ..charts.scales import LENGTHS, scale
from ..charts.thinning import kept_points
from .curves import BLOCK, STRETCHES

# No track is shown of a vehicle that stays within this distance of its start, m.
STAYS = 100.0


@dataclass(frozen=True, eq=False)
class Track:
    """
    Places of a vehicle.

    Attributes
    ----------
    name : name of the track
    lat, lon, height : (n,), rad, rad, m
    points : whether to draw single points instead of a line
    """

    name: str
    lat: np.ndarray
    lon: np.ndarray
    height: np.ndarray
    points: bool = False

    @property
    def start(self):
        """Return latitude, longitude and height of the first place."""
        return float(self.lat[0]), float(self.lon[0]), float(self.height[0])


def run_tracks(result, flown=None):
    """
    Return the Tracks of a SimulationResult and, unless it is None, of its AidedResult ``flown``.

    The first Track is the truth. The list is empty if the vehicle does not move.
    """
    tracks = [_thinned('truth', result.truth)]
    start = tracks[0].start
    east, north = _from(start, tracks[0])
    if not max(np.abs(east).max(), np.abs(north).max()) > STAYS:
        return []
    if flown is None:
        return [*tracks, _thinned('solution', result.states)]
    tracks += [_thinned('aided solution', flown.states),
               _thinned('strapdown alone', result.states)]
    fixes = [fix for fix in flown.gnss_fixes if fix.valid]
    if fixes:
        tracks.append(Track('GNSS fixes', *(
            np.array([getattr(fix, name) for fix in fixes]) for name in ('lat', 'lon', 'height')),
            points=True))
    return tracks


def _thinned(name, history):
    """Return the thinned Track of a history, which may not fit into memory."""
    parts = []
    for block in history.blocks(BLOCK):
        places = [block.lat[:], block.lon[:], block.height[:]]
        stretches = max(1, -(-2 * STRETCHES * len(block) // len(history)))
        kept = kept_points(places[1], places[0], stretches)
        parts.append([values[kept] for values in places])
    return Track(name, *(np.concatenate(arrays) for arrays in zip(*parts)))


def _from(start, track):
    """Return east and north (n,) of a Track from a start (lat, lon, height), m."""
    return np.array(ellipsoid.offset(*start, (track.lat, track.lon, track.height))[:2])


STYLES = {'truth': {'colour': BLACK}, 'solution': {'colour': BLUE, 'dash': DASHED},
          'aided solution': {'colour': BLUE, 'dash': DASHED},
          'strapdown alone': {'colour': RED, 'dash': DASH_DOT}}


def track_chart(title, tracks):
    """Return the Chart of Tracks seen from above; the first one is the truth."""
    start = tracks[0].start
    places = [_from(start, track) for track in tracks]
    factor, unit = scale(LENGTHS, max(np.abs(place).max() for place in places))
    marks = []
    for track, (east, north) in zip(tracks, places):
        if track.points:
            marks.insert(0, Markers(east * factor, north * factor, track.name, ORANGE, DOT, 3.0))
        else:
            marks.append(Curve(east * factor, north * factor, track.name, **STYLES[track.name]))
    east, north = places[0] * factor
    marks.append(Markers(east[:1], north[:1], 'start', GREEN, TRIANGLE, 9.0))
    return Chart('track', f'{title}: track', (Panel(
        tuple(marks), f'east of the start [{unit}]', f'north of the start [{unit}]', equal=True),))
