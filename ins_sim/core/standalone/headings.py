"""Headings of an alignment from other sources than the gyros: course of fixes, magnetic field."""

from collections import deque
import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import to_compass
from ins_sim.core.navigation import alignment
from ins_sim.core.navigation.recorded import RecordedNavigator
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import length
from ins_sim.core.postprocessing.course import CourseSearch

# Limits of the magnetic field of the Earth, T.
LEAST_FIELD, MOST_FIELD = 2e-5, 7e-5
# Number of magnetic samples kept.
MOST = 20_000


class LiveCourse:
    """
    The heading from the course of the fixes after a standstill.

    It follows ``course.find_course``, which works on a recording. A sample is navigated only when
    a fix at or after its time has arrived, because the way to that fix could still belong to it.

    Parameters
    ----------
    settings : StrapdownSettings
    still : Standstill
    place : latitude (rad), longitude (rad), height (m)
    spin : rotation rate of the Earth, rad/s

    Attributes
    ----------
    over : whether the search has ended
    scatter : standard deviation of the heading found, rad
    """

    def __init__(self, settings, still, place, spin):
        limits = settings.alignment
        q_nb = alignment.level_attitude(still.force, 0.0)
        self._bias = tuple(alignment.gyro_bias(still, q_nb, place[0], spin).tolist())
        self._search = CourseSearch(still.end_ns, limits.course_distance_m,
                                    limits.course_search_s)
        self._navigator = RecordedNavigator(settings.input, spin, (*place, (0.0, 0.0, 0.0), q_nb))
        self._taken = 0
        self.over, self.scatter = False, math.pi

    def advance(self, samples, fixes, gap_ns):
        """
        Navigate up to the last fix; return the heading (rad) and how it was found, or None.

        Parameters
        ----------
        samples : all ImuSamples since the end of the standstill
        fixes : FixTrack
        gap_ns : longest step that does not count as a gap, ns; a gap ends the search
        """
        for way in fixes.take_ways():
            self._search.add(*way)
        b = self._bias
        while self._taken < len(samples) and not self.over and (
                fixes.covers(samples[self._taken].t_ns)
                or self._search.is_over(samples[self._taken].t_ns)):
            t_ns, omega, f, _ = samples[self._taken]
            if self._taken and t_ns - samples[self._taken - 1].t_ns > gap_ns:
                self.over = True
                break
            solution = self._navigator.step(
                t_ns, (omega[0] - b[0], omega[1] - b[1], omega[2] - b[2]), f)
            self._taken += 1
            if self._taken == 1:
                continue
            if self._search.is_over(t_ns):
                self.over = True
                break
            found = self._search.turn(t_ns, float(to_compass(np.array(solution[4]))[2]))
            if found is not None:
                self.scatter = self._search.scatter
                return found
        return None

    @property
    def state(self):
        """What the search is waiting for."""
        return self._search.describe()


class FieldSamples:
    """Collects samples of the magnetic field, in the frame of the IMU."""

    def __init__(self):
        self._samples = deque(maxlen=MOST)

    def push(self, t_ns, field):
        """Store a magnetic field, T, with its stamp."""
        self._samples.append((t_ns, field))

    def between(self, start_ns, end_ns):
        """Return the mean field between two stamps, (3,) T, or None without samples."""
        inside = [field for t_ns, field in self._samples if start_ns <= t_ns <= end_ns]
        return np.array(inside).mean(axis=0) if inside else None


def magnetic_heading(field_b, force, declination):
    """
    Return the heading from the magnetic field at rest, rad.

    Parameters
    ----------
    field_b : (3,) mean field in b, T
    force : (3,) mean specific force in b, m/s^2
    declination : of the field, east of true north, rad

    Raises
    ------
    ValueError
        If the field is not of the size of the Earth's.
    """
    size = length(field_b)
    if not LEAST_FIELD <= size <= MOST_FIELD:
        raise ValueError(f'the magnetic field is {1e6 * size:.3g} uT; expected '
                         f'{1e6 * LEAST_FIELD:g} to {1e6 * MOST_FIELD:g} uT: is the magnetometer '
                         'calibrated, and in T?')
    q_nb = alignment.level_attitude(force, 0.0)
    east, north, _ = quaternion.rotate(q_nb, tuple(field_b.tolist()))
    return declination - elementary.atan2(east, north)
