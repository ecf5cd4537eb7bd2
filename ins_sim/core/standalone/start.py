"""The state at which a strapdown without truth starts, and its uncertainty."""

import math
from typing import NamedTuple

import numpy as np

from ins_sim.core.attitude.angles import from_compass, to_compass
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation.errors import position_error
from ins_sim.core.numerics import elementary
from ins_sim.core.postprocessing.gravity_check import check_gravity
from ins_sim.core.postprocessing.reference import LONGEST_STEP_S
from ins_sim.core.simulation.free_covariance import StartSigmas

# Time for which a start on the move keeps samples for a late fix, s.
KEPT_S = 10.0
# On the move, the mean specific force of the first readings may differ from gravity by this much.
MOST_OFF_M_S2 = 6.0


class Start(NamedTuple):
    """
    The start of a navigation.

    Attributes
    ----------
    samples : ImuSamples since the first one
    state : lat (rad), lon (rad), height (m), v_n (m/s), q_nb at the first sample
    bias : (3,) gyro bias to subtract, rad/s, or None
    sigmas : StartSigmas
    located : whether position and heading are known, so that odom can be placed on the map
    infos, warnings : sentences for the log
    """

    samples: list
    state: tuple
    bias: tuple | None
    sigmas: StartSigmas
    located: bool
    infos: list
    warnings: list


def given_attitude(initial):
    """Return q_nb from roll, pitch and heading of the settings."""
    return tuple(from_compass(*(math.radians(a) for a in (
        initial.roll_deg, initial.pitch_deg, initial.heading_deg)))[0].tolist())


def given_place(initial):
    """Return latitude (rad), longitude (rad) and height (m) of the settings."""
    return (math.radians(initial.latitude_deg), math.radians(initial.longitude_deg),
            initial.height_m)


def attitude_text(q_nb):
    """Return roll, pitch and heading, deg, and a text with them."""
    roll, pitch, heading = (math.degrees(float(a)) for a in to_compass(np.array(q_nb)))
    return roll, pitch, f'roll {roll:.3f}, pitch {pitch:.3f}, heading {heading:.3f} deg'


def given_sigmas(initial, position=None, azimuth=None):
    """Return the StartSigmas of the settings, with position (m) and azimuth (rad) replaced."""
    tilt = 1e-3 * initial.tilt_sigma_mrad
    return StartSigmas(initial.position_sigma_m or position or 0.0, initial.velocity_sigma_m_s,
                       tilt, 1e-3 * initial.azimuth_sigma_mrad if azimuth is None else azimuth)


class GivenStart:
    """
    Starts at the first sample; with the position of fixes, at the first sample that they cover.

    Parameters
    ----------
    settings : StrapdownSettings
    fixes : FixTrack, or None if the position is given

    Attributes
    ----------
    notes, turn : see AlignmentStart
    """

    state = 'waiting for fixes'
    turn = None

    def __init__(self, settings, fixes):
        self._initial, self._fixes = settings.initial, fixes
        self._samples, self.notes, self._weighed = [], [], False

    def push(self, sample):
        """Process an ImuSample."""
        self._samples.append(sample)

    def pop(self):
        """Remove the last sample, because another one replaces it; return whether it worked."""
        return bool(self._samples) and bool(self._samples.pop())

    def decide(self):
        """Return the Start, or None if it cannot be decided yet."""
        initial, place, sigma = self._initial, None, None
        if not self._weighs():
            return None
        if self._fixes is None:
            place = given_place(initial) if self._samples else None
        else:
            place = self._covered()
            if place is not None:
                sigma = self._fixes.sigma(self._samples[0].t_ns)
        if place is None:
            return None
        q_nb = given_attitude(initial)
        return Start(self._samples, (*place, initial.velocity_m_s, q_nb), None,
                     given_sigmas(initial, sigma), True,
                     [f'start from initial.source {initial.source}: {attitude_text(q_nb)[2]}'],
                     [])

    def _weighs(self):
        """Return whether the force of the first readings is plausible; report if it is not."""
        if self._weighed or not self._samples:
            return self._weighed
        force = np.array([s.f for s in self._samples]).mean(axis=0)
        try:
            check_gravity(force, MOST_OFF_M_S2)
        except ValueError as error:
            self.notes.append(f'start: {error}; navigation does not start')
            self._samples.clear()
        else:
            self._weighed = True
        return self._weighed

    def _covered(self):
        """Return the position at the first sample that has one; forget those before it."""
        samples, fixes = self._samples, self._fixes
        while samples and fixes.covers(samples[0].t_ns):
            place = fixes.place(samples[0].t_ns)
            if place is not None:
                return place
            samples.pop(0)
        while samples and samples[-1].t_ns - samples[0].t_ns > 2e9 * LONGEST_STEP_S:
            samples.pop(0)
        return None


class CourseStart(GivenStart):
    """
    Starts on the move: position, course and velocity from fixes, roll and pitch as given.

    Two fixes at least alignment.course_distance_m apart, within LONGEST_STEP_S, give the course;
    the vehicle must move forwards. The last two fixes give the velocity.
    """

    def __init__(self, settings, fixes):
        super().__init__(settings, fixes)
        self._distance_m = settings.alignment.course_distance_m

    @property
    def state(self):
        """What the start is waiting for."""
        return (f'waiting for fixes {self._distance_m:g} m apart within {LONGEST_STEP_S:g} s '
                '(alignment.course_distance_m)')

    def decide(self):
        """Return the Start, or None if it cannot be decided yet."""
        samples, fixes = self._samples, self._fixes.fixes
        if not self._weighs():
            return None
        while samples and samples[-1].t_ns - samples[0].t_ns > KEPT_S * 1e9:
            samples.pop(0)
        if len(fixes) < 2 or not samples or not samples[0].t_ns <= fixes[-1].t_ns <= \
                samples[-1].t_ns:
            return None
        new, last = fixes[-1], fixes[-2]
        for old in reversed(fixes):
            if new.t_ns - old.t_ns > LONGEST_STEP_S * 1e9:
                return None
            east, north, _ = position_error(*new.place, *old.place)
            way = math.sqrt(east * east + north * north)
            if way >= self._distance_m:
                break
        else:
            return None
        heading, initial = elementary.atan2(east, north), self._initial
        seconds_apart = 1e-9 * (new.t_ns - last.t_ns)
        v = tuple(x / seconds_apart for x in position_error(*new.place, *last.place))
        while samples[0].t_ns < new.t_ns:
            samples.pop(0)
        later_s = 1e-9 * (samples[0].t_ns - new.t_ns)
        place = ellipsoid.moved(*new.place, tuple(x * later_s for x in v))
        sigma = self._fixes.sigma(new.t_ns)
        q_nb = tuple(from_compass(math.radians(initial.roll_deg), math.radians(initial.pitch_deg),
                                  heading)[0].tolist())
        velocity = max(initial.velocity_sigma_m_s, math.sqrt(2.0) * sigma / seconds_apart)
        sigmas = given_sigmas(initial, sigma, elementary.atan2(math.sqrt(2.0) * sigma, way))
        return Start(samples, (*place, v, q_nb), None, sigmas._replace(velocity=velocity),
                     True, [f'start on the move: {attitude_text(q_nb)[2]}, by the course of the '
                            f'fixes over {way:.1f} m'], [])
