"""Choose the first sample, initial state and gyro bias of a recorded run, and record why."""

from dataclasses import dataclass
from functools import cached_property
import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import from_compass, to_compass
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation import alignment
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.fixed_order import length
from ins_sim.core.numerics.instants import seconds
from . import standstill
from .course import find_course, navigated_headings
from .gravity_check import check_gravity, LEAST_FORCE


@dataclass(frozen=True, eq=False)
class InitialState:
    """
    The first sample, the state at that sample, and how they were found.

    Attributes
    ----------
    index : index of the sample in the record
    state : (lat, lon, height, v_n, q_nb), in rad, rad, m, m/s
    bias : (3,) gyro bias to subtract, rad/s, or None
    still : Standstill, or None
    notes : list of sentences
    figures : {name: value}

    """

    index: int
    state: tuple
    bias: object
    still: object
    notes: list
    figures: dict


def choose_start(settings, sources, imu, broken, first, last, again=False):
    """
    Return an InitialState among the samples from first to last (excluded).

    Parameters
    ----------
    settings : NavigateSettings
    sources : Sources
    imu : RecordedImu in the body frame
    broken : indices of the samples before a gap
    first, last : range of samples
    again : True after a gap, where given initial values no longer apply

    Raises
    ------
    ValueError : with one sentence, if no sample is suitable

    """
    return _Search(settings, sources, imu, broken).start(first, last, again)


class _Search:
    """Search for an InitialState; the arguments are those of ``choose_start``."""

    def __init__(self, settings, sources, imu, broken):
        self._s, self._imu, self._broken = settings, imu, broken
        self._reference, self._odometry = sources.reference, sources.odometry
        self._without_position = sources.without_position
        self._spin = ellipsoid.rotation_rate(settings.earth.rotation)
        self._gravity = ellipsoid.GRAVITY_TERMS[settings.earth.gravity]

    def start(self, first, last, again):
        source = self._s.initial.attitude
        if again:
            known = self._reference is not None and self._reference.attitude is not None
            source = 'reference' if known else 'align'
        if source == 'align':
            return self._aligned(first, last, again)
        return self._moving(first, last, source, again)

    @cached_property
    def _wheels(self):
        return None if self._odometry is None else self._odometry.as_enu()

    def _speed_at(self, t_ns):
        """Return the speed of a reference that measures velocity, (n,) m/s, NaN if unknown."""
        if self._reference is not None and self._reference.velocity is not None:
            return length(self._reference.velocity_at(t_ns))
        if self._odometry is not None:
            return length(self._odometry.velocity_b().at(t_ns))
        return np.full(len(t_ns), np.nan)

    def _moving(self, first, last, source, again):
        """Start at the first sample at which all values needed from the reference are known."""
        reason = None
        for k in range(first, last):
            try:
                q_nb = self._attitude(k, source)
                where = self._position(k, again)
                v = self._velocity(k, q_nb, again)
                break
            except LookupError as error:
                reason = reason or str(error)
        else:
            raise ValueError(reason)
        self._judge_gravity(first, last)
        notes = [f'start at {seconds(self._imu.t_ns[k])}, attitude: {source}']
        figures, bias, still = {}, None, None
        if self._s.alignment.gyro_bias == 'subtract':
            still = self._standstill(0, k, 'a standstill before the start, or '
                                     'alignment.gyro_bias keep', longest=True)
            notes.append(still.describe())
            q_still = None
            if self._reference is not None:
                q_still = self._reference.attitude_at(still.end_ns)
            q_still = q_still or alignment.level_attitude(still.force, 0.0)
            bias = self._bias(still, q_still, where[0], notes, figures)
        return InitialState(k, (*where, v, q_nb), bias, still, notes, figures)

    def _judge_gravity(self, first, last):
        """Reject a specific force at rest that differs from gravity, if the IMU rests at all."""
        try:
            still = standstill.find_standstill(self._imu[first:last], self._s.alignment,
                                               self._speed_at)
        except ValueError:
            return
        check_gravity(still.force, self._s.alignment.gravity_m_s2)

    def _standstill(self, first, last, expected, longest=False):
        try:
            return standstill.find_standstill(self._imu[first:last], self._s.alignment,
                                              self._speed_at, longest)
        except ValueError as error:
            raise ValueError(f'{error}; expected {expected}') from None

    def _attitude(self, k, source):
        given = self._s.initial
        if source == 'given':
            return tuple(from_compass(*(math.radians(a) for a in (
                given.roll_deg, given.pitch_deg, given.heading_deg)))[0].tolist())
        if source == 'imu':
            q = self._imu.q_ns[k]
            if np.isnan(self._imu.q_ns).all():
                raise ValueError('the IMU messages hold no orientation (REP-145); expected '
                                 'another initial.attitude than imu')
            if np.isnan(q).any():
                raise LookupError(f'the IMU message of {seconds(self._imu.t_ns[k])} holds no '
                                  'orientation; expected one at the start')
            return tuple(q.tolist())
        q = None if self._reference is None else \
            self._reference.attitude_at(int(self._imu.t_ns[k]))
        if q is None and self._wheels is not None and self._reference is None:
            q = self._wheels.attitude_at(int(self._imu.t_ns[k]))
        if q is None:
            raise LookupError('no reference has an attitude at the start; expected another '
                              'initial.attitude than reference')
        return q

    def _position(self, k, again, near=False):
        given, t_ns = self._s.initial, int(self._imu.t_ns[k])
        if given.position == 'given' and not again:
            return (math.radians(given.latitude_deg), math.radians(given.longitude_deg),
                    given.height_m)
        track = None if self._reference is None else self._reference.position
        if track is None:
            raise ValueError(f'the latitude is unknown, because {self._without_position}; '
                             'expected initial.position given with initial.latitude_deg, '
                             'longitude_deg and height_m')
        p = track.near(t_ns) if near else track.at([t_ns])[0]
        if np.isnan(p).any():
            raise LookupError(f'the position is unknown at {seconds(t_ns)}: the reference has one '
                              f'from {seconds(track.t_ns[0])} to {seconds(track.t_ns[-1])}; '
                              'expected initial.position given, or another start_s')
        return tuple(p.tolist())

    def _velocity(self, k, q_nb, again):
        given, t_ns = self._s.initial, int(self._imu.t_ns[k])
        if given.velocity == 'given' and not again:
            return given.velocity_m_s
        v = np.full(3, np.nan)
        if self._reference is not None:
            v = self._reference.velocity_at([t_ns])[0]
        if np.isnan(v).any() and self._odometry is not None:
            v_b = self._odometry.velocity_b().at([t_ns])[0]
            v = np.array(quaternion.rotate(q_nb, tuple(v_b.tolist())))
        if np.isnan(v).any():
            raise LookupError(f'no reference has a velocity at {seconds(t_ns)}; expected '
                              'initial.velocity given with initial.velocity_m_s')
        return tuple(v.tolist())

    def _aligned(self, first, last, again):
        limits = self._s.alignment
        still = self._standstill(first, last, 'a standstill, other alignment.* limits, or '
                                 'initial.attitude given, reference or imu')
        k = first + still.last - 1
        notes = [still.describe()]
        check_gravity(still.force, limits.gravity_m_s2)
        if length(still.force) < LEAST_FORCE:
            raise ValueError('the mean specific force at rest is zero, so that the vertical is '
                             'unknown; expected initial.attitude given, reference or imu')
        try:
            where = self._position(k, again, near=True)
            lat = where[0]
            figures = {'stationary_s': (still.end_ns - still.start_ns) * 1e-9,
                       'force_sd_m_s2': still.force_sd, 'rate_sd_rad_s': still.rate_sd,
                       'gravity_excess_m_s2': length(still.force) - ellipsoid.gravity(
                           elementary.sin(lat), where[2], self._gravity)}
            q_nb, compassed = self._headed(still, k, where, again, notes, figures)
            v = (0.0, 0.0, 0.0) if self._s.initial.velocity == 'auto' else \
                self._velocity(k, q_nb, again)
        except LookupError as error:
            raise ValueError(str(error)) from None
        bias, wanted = None, limits.gyro_bias
        if not again and (wanted == 'subtract' or wanted == 'auto' and not compassed):
            bias = self._bias(still, q_nb, lat, notes, figures)
        roll, pitch, heading = (math.degrees(float(a)) for a in to_compass(np.array(q_nb)))
        figures.update(roll_deg=roll, pitch_deg=pitch, heading_deg=heading)
        notes.append(f'start at {seconds(still.end_ns)}: roll {roll:.3f}, pitch {pitch:.3f}, '
                     f'heading {heading:.3f} deg')
        if max(abs(roll), abs(pitch)) > alignment.UPRIGHT_DEG:
            notes.append(alignment.TILTED)
        return InitialState(k, (*where, v, q_nb), bias, still, notes, figures)

    def _headed(self, still, k, where, again, notes, figures):
        """Return q_nb at a standstill and whether its heading is from gyrocompassing."""
        wanted = self._s.initial.heading
        if wanted == 'given' and not again:
            return alignment.level_attitude(
                still.force, math.radians(self._s.initial.heading_deg)), False
        refused = 'the Earth does not rotate (earth.rotation)'
        if wanted in ('auto', 'gyrocompass', 'given') and self._spin:
            compass, refused = alignment.trusted_gyrocompass(still, where[0], self._s.alignment)
            if compass is not None:
                notes.append(f'heading by gyrocompassing: {compass.describe()}')
                figures.update(heading_source='gyrocompass',
                               heading_sigma_deg=math.degrees(compass.sigma))
                return compass.q_nb, True
        if wanted == 'gyrocompass':
            raise ValueError(f'{refused}; expected another initial.heading than gyrocompass')
        heading, source = self._reference_heading(still, k, where, wanted, refused)
        notes.append(f'heading from {source}' + ('' if wanted == 'course' or wanted == 'reference'
                                                 else f', because {refused}'))
        figures.update(heading_source=source)
        return alignment.level_attitude(still.force, heading), False

    def _reference_heading(self, still, k, where, wanted, refused):
        """Return a heading and the text of its source; raise ValueError if no source has one."""
        t_ns = int(self._imu.t_ns[k])
        if wanted != 'course' and self._reference is not None:
            q = self._reference.attitude_at(t_ns)
            if q is not None:
                return float(to_compass(np.array(q))[2]), self._reference.name
        why = 'there is no reference with a position or a velocity'
        if wanted != 'reference' and self._reference is not None:
            found, text = self._course(still, k, where)
            if found is not None:
                return found, f'the course of {self._reference.name} {text}'
            why = f'{self._reference.name} {text}'
        if wanted != 'course' and self._wheels is not None:
            q = self._wheels.attitude_at(t_ns)
            if q is not None:
                return float(to_compass(np.array(q))[2]), \
                    f'{self._odometry.name} (frame {self._odometry.frame} taken for East, North)'
        if wanted in ('auto', 'given'):
            why = f'{refused}, and {why}'
        elif wanted == 'reference':
            why = 'no reference has an attitude at the start'
        raise ValueError(f'the heading is unknown: {why}; expected initial.heading given with '
                         'initial.heading_deg')

    def _course(self, still, k, where):
        """Return the heading at sample k, or None, and a text about it."""
        later = self._broken[self._broken >= k]
        last = int(later[0]) + 1 if len(later) else len(self._imu)
        q_nb = alignment.level_attitude(still.force, 0.0)
        bias = alignment.gyro_bias(still, q_nb, where[0], self._spin)
        turning = navigated_headings(self._imu[k:last].less_bias(bias),
                                     (*where, (0.0, 0.0, 0.0), q_nb),
                                     self._s.input, self._spin)
        limits = self._s.alignment
        return find_course(turning, self._reference.displacements(), int(self._imu.t_ns[k]),
                           limits.course_distance_m, limits.course_search_s)

    def _bias(self, still, q_nb, lat, notes, figures):
        bias = alignment.gyro_bias(still, q_nb, lat, self._spin)
        notes.append(alignment.bias_sentence(bias))
        figures['gyro_bias_rad_s'] = bias.tolist()
        return bias
