"""Self-alignment of a live IMU: first a standstill, then position and heading when available."""

import math

from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation import alignment
from ins_sim.core.numerics.fixed_order import length
from ins_sim.core.numerics.elementary import cos
from ins_sim.core.numerics.instants import seconds
from ins_sim.core.numerics.units import DEG_PER_HOUR, STANDARD_GRAVITY
from ins_sim.core.postprocessing.gravity_check import check_gravity, LEAST_FORCE
from ins_sim.core.postprocessing.mounting import levelled_mounting
from ins_sim.core.postprocessing.reference import LONGEST_STEP_S
from ins_sim.core.postprocessing.sample_checks import without_zeros
from ins_sim.core.simulation.free_covariance import sigmas_of
from .headings import LiveCourse, magnetic_heading
from .mounted import turned_samples
from .samples import recorded
from .standstill_stream import StandstillStream
from .start import attitude_text, given_place, given_sigmas, Start

# Fixes further apart than this, m, show that the vehicle was not at rest.
MOVED_M = 10.0
# Standard deviation of an unknown heading, rad.
UNKNOWN_HEADING = math.pi
# Heading, rad, of a vehicle that points along the x axis (East) of odom.
ALONG_X = 0.5 * math.pi


class AlignmentStart:
    """
    Waits for a standstill, then for the data that give position and heading.

    Parameters
    ----------
    settings : StrapdownSettings
    inputs : StandaloneNavigator, for its ``samples``, ``fixes``, ``field`` and ``declination``
    first_ns : stamp of the first sample, from which the windows of the standstill are counted
    again : whether given values are no longer valid, for example after a gap
    last_place : last position of the solution before, or None
    turn : quaternion by which the samples have already been levelled, or None

    Attributes
    ----------
    notes : sentences on what prevented the alignment; the owner removes them
    refused : the last of them that made the alignment start again, or ''
    turn : quaternion that levels the samples (mounting.source level), or None

    """

    def __init__(self, settings, inputs, first_ns, again=False, last_place=None, turn=None):
        self._s, self._inputs = settings, inputs
        self._first_ns, self._again, self._last_place = first_ns, again, last_place
        self._spin = ellipsoid.rotation_rate(settings.earth.rotation)
        self.notes, self.refused, self.turn = [], '', turn
        self._begin()

    def _begin(self):
        limits = self._s.alignment
        self._stream = StandstillStream(
            limits, self._inputs.samples.step, self._first_ns,
            lambda force: check_gravity(force, limits.gravity_m_s2))
        self._levels = self._s.mounting.source == 'level' and self.turn is None
        self._still = self._course = self._place = None
        self._samples, self._placed, self._gyrocompass = [], False, None
        self._reasons = []

    @property
    def state(self):
        """What the alignment is waiting for."""
        if self._still is None:
            return (f'at rest for {self._stream.elapsed_s:g} s of at least '
                    f'{self._stream.needed_s:g} s')
        if not self._placed:
            return f'waiting for a fix on {self._s.inputs.fix}'
        return f'waiting for a course: {self._course.state}' if self._course else 'deciding'

    def push(self, sample):
        """Process an ImuSample."""
        if self._still is not None:
            self._samples.append(sample)
            return
        still = self._stream.push(sample)
        self._complain(self._stream.notes)
        self._stream.notes.clear()
        if still is not None:
            self._found(still)

    def _complain(self, sentences):
        self.notes += sentences
        self.refused = sentences[-1] if sentences else self.refused

    def pop(self):
        """Remove the last sample, because another one replaces it; return whether it worked."""
        if self._still is None:
            return self._stream.pop()
        if len(self._samples) < 2:
            return False
        self._samples.pop()
        return True

    def _found(self, still):
        samples = self._stream.samples
        try:
            self._check(still, samples)
        except ValueError as error:
            self._complain([f'alignment: {error}; the alignment starts again'])
            self._begin()
            return
        if self._levels:
            yaw = math.radians(self._s.mounting.rpy_deg[2])
            self.turn = levelled_mounting(still.force, yaw)
            self._begin()
            for sample in turned_samples(samples, self.turn):
                self.push(sample)
            return
        self._still, self._samples = still, samples[still.last - 1:]
        self._stream = None
        self._inputs.fixes.forget_ways(still.end_ns)

    def _check(self, still, samples):
        """Raise ValueError if the vehicle was not at rest or forces are not in m/s^2."""
        without_zeros(recorded(samples[still.first:still.last]), 'refuse', [])
        check_gravity(still.force, self._s.alignment.gravity_m_s2)
        if length(still.force) < LEAST_FORCE:
            raise ValueError('the mean specific force at rest is zero; expected about 9.8 m/s^2 '
                             'upwards')
        way, time_s = self._inputs.fixes.moved(still.start_ns, still.end_ns)
        if way > max(MOVED_M, self._s.alignment.speed_m_s * time_s):
            raise ValueError(f'the fixes have moved by {way:.1f} m in the {time_s:.1f} s in which '
                             'the IMU seemed to be at rest; expected a vehicle at rest')

    def decide(self):
        """Return the Start, or None if it cannot be decided yet."""
        if self._still is None or not (self._placed or self._find_place()):
            return None
        still, infos = self._still, [self._still.describe()]
        lat = self._latitude
        found = self._heading(infos)
        if found is None:
            return None
        q_nb, sigma, known, compassed = found
        bias, bias_sigma = self._bias(still, q_nb, lat, known, compassed, infos)
        roll, pitch, text = attitude_text(q_nb)
        infos.append(f'start at {seconds(still.end_ns)}: {text}')
        warnings = [] if known and self._place else [self._warning(known)]
        if max(abs(roll), abs(pitch)) > alignment.UPRIGHT_DEG:
            warnings.append(f'alignment: {text}: {alignment.TILTED}')
        place = self._place or (lat, math.radians(self._s.datum.longitude_deg),
                                self._s.datum.height_m)
        _, accelerometer = sigmas_of(self._s)
        sigmas = given_sigmas(self._s.initial, self._inputs.fixes.sigma(still.end_ns), sigma)
        tilt = math.sqrt(max(accelerometer.bias)) / STANDARD_GRAVITY
        sigmas = sigmas._replace(tilt=_joint(sigmas.tilt, tilt), gyro_bias=bias_sigma)
        return Start(self._samples, (*place, (0.0, 0.0, 0.0), q_nb), bias, sigmas,
                     known and self._place is not None, infos, warnings)

    def _find_place(self):
        """Find the position at the end of the standstill; return whether the search is over."""
        end_ns, fixes = self._still.end_ns, self._inputs.fixes
        if self._s.initial.position == 'given':
            self._place = self._last_place if self._again else given_place(self._s.initial)
        elif fixes.covers(end_ns) or self._samples[-1].t_ns > end_ns + LONGEST_STEP_S * 1e9:
            self._place = fixes.place(end_ns, near=True)
            if self._place is None:
                self._reasons.append(f'the position is unknown, because no fix on '
                                     f'{self._s.inputs.fix} is within {LONGEST_STEP_S:g} s of the '
                                     'standstill')
        else:
            return False
        self._placed = True
        return True

    @property
    def _latitude(self):
        return self._place[0] if self._place else math.radians(self._s.datum.latitude_deg)

    def _heading(self, infos):
        """Return q_nb, sigma, whether known, whether gyrocompassed; None if it may still come."""
        still, wanted = self._still, self._s.initial.heading
        if wanted == 'given' and not self._again:
            sigma = 1e-3 * self._s.initial.azimuth_sigma_mrad
            infos.append('heading as given')
            return (alignment.level_attitude(still.force, math.radians(
                self._s.initial.heading_deg)), sigma, True, False)
        if self._place is not None:
            found = self._compassed(wanted, infos) or self._by_course(wanted, infos)
            if found is not None:
                return found
            if self._course is not None and not self._course.over:
                return None
            found = self._by_field(wanted, infos)
            if found is not None:
                return found
        return alignment.level_attitude(still.force, ALONG_X), UNKNOWN_HEADING, False, False

    def _refuse(self, reason):
        if reason not in self._reasons:
            self._reasons.append(reason)

    def _compassed(self, wanted, infos):
        if wanted not in ('auto', 'gyrocompass', 'given'):
            return None
        if not self._spin:
            self._refuse('the Earth does not rotate (earth.rotation)')
            return None
        if self._gyrocompass is None:
            self._gyrocompass = alignment.trusted_gyrocompass(self._still, self._latitude,
                                                              self._s.alignment)
        compass, reason = self._gyrocompass
        if compass is None:
            self._refuse(reason)
            return None
        infos.append(f'heading by gyrocompassing: {compass.describe()}')
        return compass.q_nb, compass.sigma, True, True

    def _by_course(self, wanted, infos):
        fixes = self._inputs.fixes
        if wanted not in ('auto', 'course', 'given') or not fixes.fixes:
            return None
        if self._course is None:
            self._course = LiveCourse(self._s, self._still, self._place, self._spin)
            self._inputs.infos.append(
                f'alignment: {"; ".join([*self._reasons, ""])}the heading will be the course of '
                f'{self._s.inputs.fix}, once it has moved by '
                f'{self._s.alignment.course_distance_m:g} m (alignment.course_distance_m)')
        found = self._course.advance(self._samples, fixes, self._inputs.samples.gap_ns)
        if found is None:
            if self._course.over:
                self._refuse(f'{self._s.inputs.fix} {self._course.state}')
            return None
        heading, text = found
        infos.append(f'heading from the course of {self._s.inputs.fix} {text}')
        return (alignment.level_attitude(self._still.force, heading), self._course.scatter, True,
                False)

    def _by_field(self, wanted, infos):
        if wanted not in ('auto', 'magnetometer', 'given'):
            return None
        mean = self._inputs.field.between(self._still.start_ns, self._still.end_ns)
        if mean is None:
            self._refuse(f'there is no message on {self._s.inputs.magnetic_field}')
            return None
        declination, text = self._inputs.declination(self._still.end_ns, self._place)
        try:
            heading = magnetic_heading(mean, self._still.force, declination)
        except ValueError as error:
            self._refuse(str(error))
            return None
        infos.append(f'heading by the magnetic field, declination '
                     f'{math.degrees(declination):.2f} deg {text}')
        return (alignment.level_attitude(self._still.force, heading),
                math.radians(self._s.initial.magnetic_sigma_deg), True, False)

    def _bias(self, still, q_nb, lat, known, compassed, infos):
        """Return the gyro bias to subtract, or None, and its standard deviation by axis."""
        wanted, assumed = (self._s.alignment.gyro_bias,
                           self._s.alignment.gyro_bias_sigma_deg_h / DEG_PER_HOUR)
        figures = math.sqrt(max(sigmas_of(self._s)[0].bias))
        if wanted == 'keep' or wanted == 'auto' and compassed:
            return None, max(figures, assumed)
        bias = alignment.gyro_bias(still, q_nb, lat, self._spin)
        infos.append(alignment.bias_sentence(bias))
        error = float(max(still.rate_error))
        # With unknown heading the level component of the Earth rate has an unknown direction.
        return tuple(bias.tolist()), error if known else _joint(error, self._spin * cos(lat))

    def _warning(self, heading_known):
        """Return the warning that heading or position is unknown."""
        reasons = '; '.join(self._reasons) or 'no source for it'
        what, how = ('levelled only, the heading is unknown', 'heading 0 along x, ')
        if heading_known:
            what, how = 'the position is unknown', ''
        return (f'alignment: {what}: {reasons}. The solution is given in odom only, {how}without '
                'map -> odom and ins/fix. What would help: initial.position given; '
                f'initial.heading given; fixes on {self._s.inputs.fix} while the vehicle moves; '
                f'a magnetometer on {self._s.inputs.magnetic_field}; or gyros whose '
                'alignment.gyro_bias_sigma_deg_h is known to be small')


def _joint(one, other):
    """Return the standard deviation of the sum of two independent errors."""
    return math.sqrt(one * one + other * other)
