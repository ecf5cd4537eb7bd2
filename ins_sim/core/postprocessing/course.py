"""Find the heading at a standstill from the subsequent course of a reference."""

from collections import deque
import math

import numpy as np

from ins_sim.core.attitude.angles import to_compass
from ins_sim.core.navigation.recorded import RecordedNavigator
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import length


def navigated_headings(imu, state, kind, spin):
    """
    Yield stamp (ns) and heading (rad) for each sample of a RecordedImu after the first.

    state: (lat, lon, height, v_n, q_nb) at the first sample; kind, spin: see RecordedNavigator.
    """
    samples = zip(imu.t_ns.tolist(), map(tuple, imu.omega.tolist()), map(tuple, imu.f.tolist()))
    nav = RecordedNavigator(kind, spin, state)
    nav.step(*next(samples))
    for sample in samples:
        yield sample[0], float(to_compass(np.array(nav.step(*sample)[4]))[2])


class CourseSearch:
    """
    Finds the heading at a standstill from the subsequent displacements of a reference.

    Each displacement between stamps is rotated back by the change of heading since the start.
    The sum then points along the heading at the start, if the vehicle drives forwards. The
    position noise cancels in the sum, except for that of its ends.

    Parameters
    ----------
    start_ns : instant at which the standstill ends
    distance_m : required length of the sum
    search_s : time within which it must be reached

    """

    def __init__(self, start_ns, distance_m, search_s):
        self._start_ns, self._distance_m, self._search_s = start_ns, distance_m, search_s
        self._ways, self._parts = deque(), []
        self._along = self._across = 0.0

    def add(self, middle_ns, way):
        """Add the next displacement: the instant of its middle, and (east, north), m."""
        if middle_ns >= self._start_ns:
            self._ways.append((middle_ns, way))

    def is_over(self, t_ns):
        """Return whether the search time has passed at a stamp."""
        return t_ns > self._start_ns + round(self._search_s * 1e9)

    def turn(self, t_ns, turned):
        """
        Process the heading, rad, at a stamp of a navigation that started with heading zero.

        All displacements whose middle is before that stamp must have been added. Returns the
        heading at the start, rad, and a text on how it was found; or None.
        """
        while self._ways and self._ways[0][0] <= t_ns:
            _, (east, north) = self._ways.popleft()
            s, c = elementary.sincos(turned)
            part = north * c + east * s, east * c - north * s
            self._parts.append(part)
            self._along, self._across = self._along + part[0], self._across + part[1]
        along, across, way = self._along, self._across, self.way
        if way < self._distance_m:
            return None
        aside = np.array([(b * along - a * across) / way for a, b in self._parts])
        self.scatter = length(aside) / way
        return elementary.atan2(across, along), (
            f'over {way:.1f} m until {(t_ns - self._start_ns) * 1e-9:.1f} s after the start, '
            f'scatter {math.degrees(self.scatter):.2g} deg')

    @property
    def way(self):
        """Return the length of the sum so far, m."""
        return math.sqrt(self._along * self._along + self._across * self._across)

    def describe(self):
        """Return the reason why no heading was found."""
        return (f'moves {self.way:.3g} m on one course within {self._search_s:g} s '
                f'(alignment.course_distance_m {self._distance_m:g})')


def find_course(turning, displacements, start_ns, distance_m, search_s):
    """
    Return the heading at the start, rad, and how it was found; or None and the reason.

    Parameters
    ----------
    turning : ``navigated_headings`` from heading zero
    displacements : result of ``Reference.displacements``; None if there are none
    start_ns, distance_m, search_s : see CourseSearch

    """
    if displacements is None:
        return None, 'contains neither a position nor a velocity to find the course from'
    search = CourseSearch(start_ns, distance_m, search_s)
    for middle_ns, way in zip(*displacements):
        search.add(middle_ns, way)
    for t_ns, turned in turning:
        if search.is_over(t_ns):
            break
        found = search.turn(t_ns, turned)
        if found is not None:
            return found
    return None, search.describe()
