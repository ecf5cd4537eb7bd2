"""
Write tracks as KML 2.2 (OGC 07-147r2) for map and globe programs.

The heights are above the ellipsoid, although KML defines them above mean sea level. The difference
(the geoid undulation) is up to about 100 m; the file contains a note about it.
"""

from xml.sax.saxutils import escape

import numpy as np

from ins_sim.visible_text import visible

FILE = 'track.kml'
# The colours of the figures in the notation of KML, aabbggrr.
COLOURS = {'truth': 'ff000000', 'solution': 'ffb27200', 'aided solution': 'ffb27200',
           'strapdown alone': 'ff005ed5', 'GNSS fixes': 'ff009fe6'}
OTHER = 'ff009fe6'
NOTE = ('Heights are above the ellipsoid of WGS 84; a program that takes them as heights above '
        'the sea draws them up to about 100 m too high or too low.')


def write_tracks(folder, title, tracks):
    """Write Tracks (``track.run_tracks``) as track.kml into a folder (pathlib.Path)."""
    places = '\n'.join(_placemark(track) for track in tracks)
    (folder / FILE).write_text(
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<kml xmlns="http://www.opengis.net/kml/2.2">\n<Document>\n'
        f'<name>{_text(title)}</name>\n<description>{NOTE}</description>\n{places}\n'
        '</Document>\n</kml>\n', encoding='utf-8')


def _placemark(track):
    colour = COLOURS.get(track.name, OTHER)
    if track.points:
        parts = [f'<Point><altitudeMode>absolute</altitudeMode><coordinates>{place}'
                 '</coordinates></Point>' for place in _coordinates(*_degrees(track))]
    else:
        parts = ['<LineString><altitudeMode>absolute</altitudeMode><coordinates>'
                 + '\n'.join(_coordinates(*piece)) + '</coordinates></LineString>'
                 for piece in unbroken(*_degrees(track))]
    return (f'<Placemark><name>{_text(track.name)}</name><Style><LineStyle><color>{colour}</color>'
            f'<width>2</width></LineStyle><IconStyle><color>{colour}</color><scale>0.4</scale>'
            '</IconStyle></Style><MultiGeometry>\n' + '\n'.join(parts)
            + '\n</MultiGeometry></Placemark>')


def _degrees(track):
    """Return longitude within -180 to 180 deg, latitude, and height."""
    lon = np.degrees(track.lon)
    return (lon + 180.0) % 360.0 - 180.0, np.degrees(track.lat), track.height


def unbroken(lon, lat, height):
    """
    Split a line into pieces (lon, lat, height) that do not cross the 180 deg meridian.

    ``lon`` and ``lat`` are in deg, ``height`` in m. At a crossing, a piece ends with the
    interpolated point on the meridian, and the next one begins with the same point on the other
    side.
    """
    crossings = np.flatnonzero(np.abs(np.diff(lon)) > 180.0)
    pieces, begin, first = [], [], 0
    for k in crossings:
        side = np.copysign(180.0, lon[k])
        ahead = lon[k + 1] + 2.0 * side
        part = (side - lon[k]) / (ahead - lon[k]) if ahead != lon[k] else 0.0
        there = [values[k] + part * (values[k + 1] - values[k]) for values in (lat, height)]
        pieces.append(_joined(begin, (lon, lat, height), first, k + 1, [(side, *there)]))
        begin, first = [(-side, *there)], k + 1
    return [*pieces, _joined(begin, (lon, lat, height), first, len(lon), [])]


def _joined(before, columns, first, last, behind):
    rows = np.stack([values[first:last] for values in columns], axis=-1)
    return np.concatenate([np.reshape(before, (-1, 3)), rows, np.reshape(behind, (-1, 3))]).T


def _coordinates(lon, lat, height):
    return [f'{x:.8f},{y:.8f},{z:.2f}' for x, y, z in zip(lon, lat, height)]


def _text(words):
    return escape(visible(words))
