"""Find the origin of the map frame of an odometry in a bag from a NavSatFix of the same bag."""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.frames import level_frame
from ins_sim.core.numerics.elementary import sincos
from ins_sim.messages import topics
from ins_sim.settings.place import Datum

ODOMETRY, FIX = 'odometry', 'fix'
# Odometry and NavSatFix topics of the same solution, as the nodes publish them.
PAIRS = tuple(f'{room}/' for room in ('truth', 'ins', 'aided'))
# Largest movement of the computed origin during the recording, m.
STEADY_M = 1.0
ROUNDS = 100


def map_origin(bag, name, given):
    """
    Return the Datum of the frame of an Odometry topic, and a sentence about it.

    The origin is computed from NavSatFix messages with the same stamps, of the same solution or of
    another one in the same namespace. Without such messages the given datum is used.

    Parameters
    ----------
    bag : BagReader
    name : odometry topic
    given : Datum of the settings; the default one counts as not given

    Raises
    ------
    ValueError
        If the bag has no such NavSatFix and no datum is given.
    """
    for odometry, fix in _pairs(bag, name):
        origins = _origins(bag, odometry, fix)
        if origins is None:
            continue
        lat, lon, height = origins[0]
        apart = max(math.dist(_ecef(*origins[0]), _ecef(*other)) for other in origins)
        if apart > STEADY_M:
            raise ValueError(f'{bag.path}: {odometry} and {fix} give origins of the map frame '
                             f'that are {apart:.3g} m apart; expected one origin, or '
                             'motion.recording.origin datum')
        datum = Datum(*(float(round(math.degrees(a), 12)) for a in (lat, lon)), height)
        return datum, (f'{bag.path}: the origin of the frame of {name} is at '
                       f'{datum.latitude_deg:.9g}, {datum.longitude_deg:.9g} deg, '
                       f'{datum.height_m:.6g} m, computed from {fix}')
    if given == Datum():
        raise ValueError(f'{bag.path} has no NavSatFix for {name}, so the origin of its frame is '
                         'unknown; expected datum.latitude_deg, datum.longitude_deg and '
                         'datum.height_m of the origin (the default datum is used only if '
                         'motion.recording.origin is datum)')
    return given_origin(bag, name, given)


def given_origin(bag, name, given):
    """Return the given Datum as origin of an Odometry topic, and a sentence about it."""
    return given, (f'{bag.path}: the origin of the frame of {name} is assumed at the given '
                   f'datum, {given.latitude_deg:.9g}, {given.longitude_deg:.9g} deg, '
                   f'{given.height_m:.6g} m')


def _pairs(bag, name):
    """Yield pairs of Odometry and NavSatFix topics that determine the origin, the best first."""
    known = {topic: channel.type_name for topic, channel in bag.topics.items()}
    own = f'{name.removesuffix(ODOMETRY)}{FIX}'
    space = next((name.removesuffix(pair + ODOMETRY) for pair in PAIRS
                  if name.endswith(pair + ODOMETRY)), '/')
    found = [(name, own)] if name.endswith(ODOMETRY) else []
    found += [(f'{space}{pair}{ODOMETRY}', f'{space}{pair}{FIX}') for pair in PAIRS]
    others = [topic for topic, kind in known.items() if kind == topics.FIX]
    if len(others) == 1:
        found.append((name, others[0]))
    for odometry, fix in found:
        if known.get(odometry) == topics.ODOMETRY and known.get(fix) == topics.FIX:
            yield odometry, fix


def _origins(bag, odometry, fix):
    """Return the origins (lat, lon, height) computed at the first, middle and last stamp."""
    poses = bag.arrays(odometry, ('position',))
    fixes = bag.arrays(fix, ('latitude', 'longitude', 'altitude', 'status'))
    fixes = fixes[(fixes['status'] >= 0) & np.isfinite(fixes['altitude'])
                  & (np.abs(fixes['latitude']) <= 90.0) & np.isfinite(fixes['longitude'])]
    poses = poses[np.isfinite(poses['position']).all(axis=1)]
    _, a, b = np.intersect1d(poses['stamp_ns'], fixes['stamp_ns'], return_indices=True)
    if not len(a):
        return None
    found = []
    for k in sorted({0, len(a) // 2, len(a) - 1}):
        fixed = fixes[b[k]]
        found.append(_origin((math.radians(fixed['latitude']), math.radians(fixed['longitude']),
                              float(fixed['altitude'])), poses['position'][a[k]].tolist()))
    return found


def _origin(place, r_m):
    """Return the origin (lat, lon, height) of the frame in which a position is r_m."""
    x = _ecef(*place)
    origin = place
    for _ in range(ROUNDS):
        r = quaternion.rotate(level_frame(*origin[:2]), tuple(r_m))
        last, origin = origin, ellipsoid.geodetic(*(a - b for a, b in zip(x, r)))
        if math.dist(last, origin) < 1e-13:
            break
    return origin


def _ecef(lat, lon, height):
    return ellipsoid.ecef(*sincos(lat), *sincos(lon), height)
