"""The navigator of a live IMU without truth: readings in, solutions out."""

from collections import deque
import math

from ins_sim.core.attitude import quaternion
from .alignment_start import AlignmentStart
from .fixes import FixTrack
from .headings import FieldSamples
from .order import HOLD, OrderedSamples, REPLACE, RESTART
from .running import RunningNavigation
from .start import CourseStart, GivenStart
from .vertical_reference import VerticalReference

# Largest number of waiting samples that are navigated in one call.
AT_ONCE = 500
# Largest lead of a fix over the readings, s; in lock-step fixes arrive up to a window earlier.
MOST_AHEAD_S = 60.0


class StandaloneNavigator:
    """
    Finds its start, then navigates, like ``core.postprocessing.navigate`` on a recording.

    Parameters
    ----------
    settings : StrapdownSettings
    mounting : LiveMounting
    declination : function (stamp ns, (lat, lon, height)) -> declination of the magnetic field,
        rad, and its source

    Attributes
    ----------
    faults, warnings, infos : sentences; the owner removes them
    samples : OrderedSamples
    fixes : FixTrack
    field : FieldSamples
    run : RunningNavigation, or None before the start
    begun : number of navigations begun
    gaps : number of gaps
    """

    def __init__(self, settings, mounting, declination):
        self._s, self.declination = settings, declination
        self._mounting, self.samples = mounting, OrderedSamples(settings.gaps, mounting)
        self.faults, self.warnings, self.infos = [], [], []
        self.begun = self.gaps = 0
        self._forget()

    def reset(self):
        """Start again from the beginning."""
        self.samples.restart()
        self._forget()

    rejoin = reset

    def _forget(self, again=False):
        """Forget solution and start; again: after a gap, when given values are no longer valid."""
        self._last_place = self.run.place if again and self.run is not None else None
        self._again = again
        if not again:
            self.fixes, self.field = FixTrack(), FieldSamples()
        self._heights = VerticalReference(self._s.vertical.reference == 'pressure')
        self.run = self._start = self._realigning = self._turn = self._published_ns = None
        self._waiting, self._count, self.newest_ns = deque(), 0, None

    @property
    def q_bs(self):
        """Return the quaternion from the frame of the IMU to base_link, or None."""
        q_bs = self._mounting.q_bs
        return q_bs if q_bs is None or self._turn is None else quaternion.multiply(self._turn,
                                                                                   q_bs)

    @property
    def waiting(self):
        """Return whether samples wait to be navigated."""
        return self.run is not None and bool(self._waiting)

    @property
    def processed_ns(self):
        """Return the stamp of the last solution, or None."""
        return self._published_ns

    @property
    def located(self):
        """Return whether there is a solution whose position and heading on the map are known."""
        return self.run is not None and self.run.located

    @property
    def state(self):
        """What the navigator is doing, in a few words."""
        if self.run is not None:
            return 'navigating' if self.located else 'navigating in odom alone'
        if self._mounting.q_bs is None:
            return 'waiting for /tf_static'
        if self._again and self._s.initial.source == 'given':
            return 'waiting for ~/reset'
        return 'waiting for readings' if self._start is None else self._start.state

    def push_fix(self, fix):
        """Process a PlaceFix; return the solutions that become possible."""
        ahead_s = 0.0 if self.newest_ns is None else 1e-9 * (fix.t_ns - self.newest_ns)
        if ahead_s > MOST_AHEAD_S:
            self.faults.append(f'a fix on {self._s.inputs.fix} is {ahead_s:.6g} s ahead of the '
                               f'imu readings; expected at most {MOST_AHEAD_S:g} s, and one '
                               'clock for both; the fix was dropped')
            return []
        if not self.fixes.push(fix):
            return []
        self._heights.push_fix(fix.t_ns, fix.height)
        return self._decided()

    def push_transforms(self, transforms):
        """Add transforms of /tf_static, {(parent, child): q from child to parent}."""
        self._mounting.add(transforms)

    def push_pressure(self, t_ns, static_pa):
        """Process a static pressure, Pa."""
        self._heights.push_pressure(t_ns, static_pa)

    def push_field(self, t_ns, field):
        """Process a magnetic field in the frame of the IMU, T."""
        if self.q_bs is not None:
            self.field.push(t_ns, quaternion.rotate(self.q_bs, field))

    def push_imu(self, t_ns, omega, f, tag=None):
        """
        Process a reading in the axes of the sensor; return the solutions that become possible.

        omega (rad/s) and f (m/s^2) are tuples; tag is returned with the solution (Solved).
        """
        outputs = []
        for kind, sample in self.samples.push(t_ns, omega, f, tag):
            outputs += self._taken(kind, sample)
        for source in (self.samples, self._mounting):
            self.faults += source.faults
            source.faults.clear()
        self.infos += self._mounting.notes
        self._mounting.notes.clear()
        return outputs

    def _taken(self, kind, sample):
        if kind == RESTART:
            self._forget()
        elif kind == REPLACE and not self._took_back():
            return []
        elif kind == HOLD and not self._bridges(sample):
            self._forget(again=self._again or self.run is not None)
            self._complain()
        self.newest_ns = sample.t_ns
        if self._turn is not None:
            sample = sample._replace(omega=quaternion.rotate(self._turn, sample.omega),
                                     f=quaternion.rotate(self._turn, sample.f))
        if self.run is not None:
            self._waiting.append(sample)
            return self.drain() + self._realigned(sample)
        if self._start is None:
            self._start = self._make_start(sample.t_ns)
        if self._start is None:
            return []
        self._start.push(sample)
        self._hear(self._start)
        self._turn = self._start.turn
        return self._decided()

    def _complain(self):
        if self._again and self._s.initial.source == 'given':
            self.warnings.append('initial.source is given, but that state is not valid after a '
                                 'gap; expected a call of ~/reset when the vehicle is in that '
                                 'state again, or initial.source alignment or fix')

    def _took_back(self):
        """Undo the last sample; return whether that was possible."""
        if self._waiting:
            self._waiting.pop()
            return True
        if self.run is not None:
            return self.run.undo()
        return self._start is not None and self._start.pop()

    def _bridges(self, sample):
        """Return whether the gap before a sample is bridged, and report what is done."""
        gap_s, longest_s = 1e-9 * (sample.t_ns - self.newest_ns), self._s.gaps.longest_bridge_s
        self.gaps += 1
        if gap_s <= longest_s:
            self.faults.append(f'imu has a gap of {gap_s:.6g} s: bridged by linear interpolation '
                               f'of rate and force (gap {self.gaps})')
            return True
        self.faults.append(f'imu has a gap of {gap_s:.6g} s; expected at most '
                           f'gaps.longest_bridge_s, {longest_s:g} s: starting anew (gap '
                           f'{self.gaps})')
        return False

    def _make_start(self, first_ns):
        initial = self._s.initial
        if initial.source == 'alignment':
            return AlignmentStart(self._s, self, first_ns, self._again, self._last_place)
        if initial.source == 'given':
            return None if self._again else GivenStart(self._s, None)
        return (CourseStart if initial.heading == 'course' else GivenStart)(self._s, self.fixes)

    def _hear(self, start):
        self.warnings += start.notes
        start.notes.clear()

    def _decided(self):
        """Begin to navigate if the start is decided; return the solutions."""
        if self.run is not None or self._start is None or not self.samples.step.known:
            return []
        start = self._start.decide()
        self._hear(self._start)
        if start is None:
            return []
        self._begin(start)
        return self.drain()

    def _begin(self, start):
        self.infos += start.infos
        self.warnings += start.warnings
        self.run = RunningNavigation(self._s, start, self.samples.step.median_ns, self._heights)
        if self.run.begins_map:
            lat, lon, height = start.state[:3]
            self.infos.append('datum is the default, so the origin of map is the start: latitude '
                              f'{math.degrees(lat):.7f} deg, longitude {math.degrees(lon):.7f} '
                              f'deg, height {height:.2f} m')
        self._waiting, self._start, self._realigning = deque(start.samples), None, None
        self.begun += 1

    def drain(self, count=AT_ONCE):
        """Navigate at most ``count`` waiting samples; return the solutions."""
        outputs = []
        while self._waiting and count:
            sample, count = self._waiting.popleft(), count - 1
            try:
                solved = self.run.step(sample, self.samples.gap_ns)
            except ValueError as error:
                self.faults.append(f'{error}: starting anew')
                self._forget(again=True)
                self._complain()
                return outputs
            if self._published_ns is not None and solved.t_ns <= self._published_ns:
                # After ~/align the new solution begins at a time already published; skip to it.
                continue
            self._published_ns = solved.t_ns
            if self._count % self._s.output_every == 0:
                outputs.append(solved)
            self._count += 1
        return outputs

    def align(self):
        """Begin another alignment; return whether it began, and a sentence."""
        limits, initial = self._s.alignment, self._s.initial
        if initial.source != 'alignment':
            return False, (f'initial.source is {initial.source}; expected alignment: nothing is '
                           'aligned')
        if self.newest_ns is None:
            return False, f'no readings on {self._s.inputs.imu} to align with'
        if self.run is None:
            return False, f'an alignment is already running: {self.state}'
        self._realigning = AlignmentStart(self._s, self, self.newest_ns, turn=self._turn)
        return True, (f'alignment started: it takes {limits.shortest_s:g} to '
                      f'{limits.longest_s:g} s at rest; until then the solution continues, and it '
                      'is kept if the vehicle moves before')

    def _realigned(self, sample):
        """Give a sample to the alignment requested by ~/align, if any; return the solutions."""
        again = self._realigning
        if again is None:
            return []
        again.push(sample)
        if again.refused:
            self._realigning = None
            self.warnings.append(f'the alignment requested by ~/align was cancelled: '
                                 f'{again.refused}; the solution continues as before')
            return []
        start = again.decide()
        self._hear(again)
        if start is None:
            return []
        self._begin(start)
        return self.drain()
