"""Navigate with a recording: clean, mount, start, step, compare; note every irregularity."""

from dataclasses import dataclass
from functools import partial
import math

import numpy as np

from ins_sim.core.attitude import angles
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation.recorded import RecordedLoop, RecordedNavigator
from ins_sim.core.navigation.strapdown import runs_away
from ins_sim.core.numerics.instants import seconds
from ins_sim.core.timeseries.histories import NavStates
from . import mounting, standstill
from .comparison import compare_with_reference
from .gravity_check import check_gravity
from .imu_record import find_gaps, gap_limit_ns, ordered_samples
from .initial_state import choose_start
from .sample_checks import checked_samples

# Smallest number of samples of a useful solution.
FEWEST = 10


@dataclass(frozen=True, eq=False)
class NavigationResult:
    """
    The result of a navigation.

    Attributes
    ----------
    states : NavStates of each segment
    references : what the solution was compared with, a list of References
    comparisons : a Comparison for each reference
    notes : sentences on what was found and done
    figures : the same as numbers, {name: value}

    """

    states: list
    references: list
    comparisons: list
    notes: list
    figures: dict


def navigate(settings, sources, progress=None):
    """
    Return the NavigationResult of NavigateSettings and Sources.

    progress: called with the fraction done.  Raises ValueError, with one sentence, if the
    navigation cannot start.
    """
    notes = []
    try:
        return _navigate(settings, sources, progress, notes)
    except ValueError as error:
        if not notes:
            raise
        raise ValueError(f'{error}. Notes: {"; ".join(notes)}') from None


def _navigate(settings, sources, progress, notes):
    """Do the work of ``navigate``; append findings to notes as they occur."""
    imu, remarks = checked_samples(sources.imu, settings.stamps, settings.accept.zero_readings)
    notes += [*sources.notes, *remarks]
    imu, losses = ordered_samples(imu)
    step_ns = imu.step_ns
    broken = find_gaps(imu.t_ns, settings.gap_factor)
    notes.insert(0, f'{len(imu)} samples of {sources.name} in '
                 f'{(imu.t_ns[-1] - imu.t_ns[0]) * 1e-9:.3f} s, median step {step_ns * 1e-6:.6g} '
                 f'ms; dropped: {losses.not_finite} not finite, {losses.repeated} with a repeated '
                 f'stamp, {losses.out_of_order} out of order{losses.first_back}; {len(broken)} '
                 'gaps')
    figures = {'samples': len(imu), 'step_ms': step_ns * 1e-6, 'not_finite': losses.not_finite,
               'out_of_order': losses.out_of_order, 'repeated': losses.repeated,
               'gaps': len(broken)}
    first, last = _span(settings, imu)
    q_bs = _mounting(settings, sources, imu, first, notes)
    figures['mounting_xyzw'] = list(q_bs)
    imu = imu.turned(q_bs)
    begin = choose_start(settings, sources, imu, broken, first, last)
    notes += begin.notes
    figures.update(begin.figures)
    if begin.bias is not None:
        imu = imu.less_bias(begin.bias)
    if settings.duration_s:
        stop_ns = imu.t_ns[begin.index] + round(settings.duration_s * 1e9)
        last = min(last, int(np.searchsorted(imu.t_ns, stop_ns, side='right')))
    run = _Replay(settings, sources, imu, notes, progress)
    states = run.segments(begin, last, partial(choose_start, settings, sources, imu, broken))
    if not states:
        earlier = ('an earlier start' if settings.initial.attitude == 'given' else
                   f'a shorter alignment (alignment.longest_s is {settings.alignment.longest_s:g} '
                   's)')
        raise ValueError(f'{sources.name} has fewer than {FEWEST} samples after the start at '
                         f'{seconds(imu.t_ns[begin.index])}; expected a longer recording or '
                         f'{earlier}')
    references = [] if sources.reference is None else [sources.reference]
    if sources.odometry is not None:
        lat, lon, height, _, q_nb = begin.state
        laid = sources.odometry.aligned_to(int(imu.t_ns[begin.index]), lat, lon, height, q_nb)
        if laid is None:
            notes.append(f'{sources.odometry.name} has no message at the start: not compared')
        else:
            references.append(laid)
    pairs = [(r, compare_with_reference(states, r)) for r in references]
    pairs = [(r, c) for r, c in pairs if c is not None]
    return NavigationResult(states, [r for r, _ in pairs], [c for _, c in pairs], notes, figures)


def _span(settings, imu):
    """Return the index of the first sample to use and the total number of samples."""
    first = int(np.searchsorted(imu.t_ns, imu.t_ns[0] + round(settings.start_s * 1e9)))
    if len(imu) - first < FEWEST:
        raise ValueError(f'start_s is {settings.start_s:g} s and the IMU has '
                         f'{len(imu)} samples in {(imu.t_ns[-1] - imu.t_ns[0]) * 1e-9:.6g} s; '
                         f'expected at least {FEWEST} samples after the start')
    return first, len(imu)


def _mounting(settings, sources, imu, first, notes):
    """Return q_bs, and note its origin."""
    wanted = settings.mounting
    roll, pitch, yaw = map(math.radians, wanted.rpy_deg)
    if wanted.source == 'level':
        still = standstill.find_standstill(imu[first:], settings.alignment)
        check_gravity(still.force, settings.alignment.gravity_m_s2)
        notes.append('mounting: levelled by the specific force of the standstill')
        return mounting.levelled_mounting(still.force, yaw)
    if wanted.source == 'tf' or wanted.source == 'auto' and not any(wanted.rpy_deg):
        base, frame = wanted.base_frame, sources.frame
        q_bs = None
        if frame != base:
            q_bs = mounting.chained_mounting(sources.transforms, base, frame, notes)
        if q_bs is not None:
            notes.append(f'mounting: /tf_static from {base} to {frame}')
            return q_bs
        if wanted.source == 'tf' and frame != base:
            raise ValueError(f'{sources.name} has no /tf_static; expected mounting.source given '
                             f'with mounting.rpy_deg, or level, for frame {frame!r}')
    text = ', '.join(f'{a:g}' for a in wanted.rpy_deg)
    notes.append(f'mounting: roll, pitch, yaw {text} deg as given')
    return angles.from_rpy(roll, pitch, yaw)


class _Replay:
    """Step through the samples, from gap to gap."""

    def __init__(self, settings, sources, imu, notes, progress):
        self._s, self._imu, self._step_ns, self._notes = settings, imu, imu.step_ns, notes
        self._gap_limit_ns = gap_limit_ns(imu.t_ns, settings.gap_factor)
        self._progress = progress
        self._spin = ellipsoid.rotation_rate(settings.earth.rotation)
        self._longest_bridge_ns = 0.0
        if settings.on_gap == 'bridge':
            self._longest_bridge_ns = settings.longest_bridge_s * 1e9
        self._damped = settings.vertical.channel == 'damped'
        self._heights = np.full(len(imu), np.nan)
        if self._damped:
            track = None if sources.reference is None else sources.reference.position
            if track is None:
                raise ValueError('vertical.channel is damped and no reference has a height; '
                                 'expected vertical.channel free')
            self._heights = track.at(imu.t_ns)[:, 2]

    def segments(self, begin, last, restart):
        """
        Return the NavStates of each segment, and note what was done at each gap.

        restart: function (first, last, again) that returns an InitialState.
        """
        states, bridged = [], 0
        while True:
            loop = RecordedLoop(self._navigator(begin), self._step_ns, self._gap_limit_ns,
                                self._longest_bridge_ns)
            part = self._segment(loop, begin, last)
            if len(part.t_ns) >= FEWEST:
                states.append(part)
            bridged += loop.bridged
            if loop.gap is None:
                break
            if self._s.on_gap != 'restart':
                why = '' if self._s.on_gap == 'stop' else (
                    f', longest_bridge_s {self._s.longest_bridge_s:g}')
                self._notes.append(f'{loop.gap}: the solution ends there (on_gap {self._s.on_gap}'
                                   f'{why})')
                break
            try:
                begin = restart(begin.index + len(part.t_ns), last, again=True)
            except ValueError as error:
                self._notes.append(f'{loop.gap}: no restart: {error}')
                break
            self._notes.append(f'{loop.gap}: restarted')
            self._notes += begin.notes
        if bridged:
            self._notes.append(f'{bridged} gaps bridged by linear interpolation of rate and '
                               'force')
        return states

    def _navigator(self, begin):
        return partial(RecordedNavigator, self._s.input, self._spin, begin.state,
                       self._s.vertical.time_constant_s if self._damped else None,
                       ellipsoid.GRAVITY_TERMS[self._s.earth.gravity])

    def _segment(self, loop, begin, last):
        """Return the NavStates from an InitialState to a gap, or to last (excluded)."""
        stamps, solutions, k = self._imu.t_ns[begin.index:last], [], begin.index
        for j, solution, _ in loop.run(self._samples(begin, last)):
            if solutions and runs_away(solution):
                self._notes.append(f'the solution diverges at {seconds(stamps[j])} and is '
                                   'stopped: check the initial values and the units of the IMU')
                break
            solutions.append(solution)
            if self._progress is not None and (k + j) % 1000 == 0:
                self._progress(j / (len(self._imu) - k))
        return NavStates(stamps[:len(solutions)], *map(np.array, zip(*solutions)))

    def _samples(self, begin, last):
        """Yield stamp, omega, f and reference height from an InitialState to last (excluded)."""
        part, held = slice(begin.index, last), begin.state[2]
        imu = self._imu[part]
        for t_ns, omega, f, height in zip(imu.t_ns.tolist(), imu.omega.tolist(), imu.f.tolist(),
                                          self._heights[part].tolist()):
            # Without a newer height of the reference the last one is used.
            held = held if math.isnan(height) else height
            yield t_ns, omega, f, held
