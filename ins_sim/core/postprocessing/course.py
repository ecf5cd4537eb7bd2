"""The heading at a standstill from the way that a reference goes afterwards."""

import math

import numpy as np

from ins_sim.core.attitude.angles import to_compass
from ins_sim.core.navigation.recorded import RecordedNavigator
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import length


def navigated_headings(imu, state, kind, spin):
    """
    Yield stamp and heading, ns and rad, behind the first sample of a RecordedImu.

    state: (lat, lon, height, v_n, q_nb) at that sample; kind, spin: as in RecordedNavigator.
    """
    samples = zip(imu.t_ns.tolist(), map(tuple, imu.omega.tolist()), map(tuple, imu.f.tolist()))
    nav = RecordedNavigator(kind, spin, state)
    nav.step(*next(samples))
    for sample in samples:
        yield sample[0], float(to_compass(np.array(nav.step(*sample)[4]))[2])


def find_course(turning, displacements, start_ns, distance_m, search_s):
    """
    Return the heading at the start, rad, and how it was found; or None and why not.

    turning: of ``navigated_headings`` from heading zero; displacements: of
    Reference.displacements.  Each way from stamp to stamp is turned back by what the heading has
    changed since the start; the sum then points along the heading at the start, if the vehicle
    goes forwards.  The noise of positions cancels in the sum but for that of its ends.
    """
    if displacements is None:
        return None, 'has no way to show a course'
    middles, ways = displacements
    j = int(np.searchsorted(middles, start_ns))
    along, across, parts = 0.0, 0.0, []
    for t_ns, turned in turning:
        if t_ns > start_ns + round(search_s * 1e9):
            break
        while j < len(middles) and middles[j] <= t_ns:
            east, north = ways[j]
            s, c = elementary.sincos(turned)
            parts.append((north * c + east * s, east * c - north * s))
            along, across = along + parts[-1][0], across + parts[-1][1]
            j += 1
        way = math.sqrt(along * along + across * across)
        if way >= distance_m:
            aside = np.array([(b * along - a * across) / way for a, b in parts])
            scatter = math.degrees(length(aside) / way)
            return elementary.atan2(across, along), (
                f'over {way:.1f} m until {(t_ns - start_ns) * 1e-9:.1f} s after the start, '
                f'scatter {scatter:.2g} deg')
    return None, (f'moves {math.sqrt(along * along + across * across):.3g} m on one course within '
                  f'{search_s:g} s (alignment.course_distance_m {distance_m:g})')
