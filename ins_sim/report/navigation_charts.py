"""Charts of the navigation on a recording: the track, and errors against the references."""

import numpy as np

from ins_sim.core.earth import ellipsoid
from ins_sim.core.postprocessing.imu_record import find_gaps
from ins_sim.core.postprocessing.reference import LONGEST_STEP_S
from .charts import palette
from .charts.chart import (Chart, CIRCLE, Curve, DASHED, DOTTED, Level, Markers, Panel, SOLID,
                           Stretch)
from .charts.scales import ANGLES, LENGTHS, scale, SPEEDS, TIMES
from .charts.thinning import kept_points
from .runs.track import Track

DASHES = (SOLID, DASHED, DOTTED)
REFERENCES = (palette.ORANGE, palette.PURPLE)
# A step of a reference longer than its median step by this factor is a gap, if it is long at all.
SPARSE = 10.0
# Compared quantities: name, units, names of the horizontal and of the vertical part.
ERRORS = (('position', LENGTHS, 'horizontal position', 'height'),
          ('velocity', SPEEDS, 'horizontal velocity', 'vertical velocity'),
          ('attitude', ANGLES, 'tilt', 'heading'))
PARTS = (palette.RED, palette.GREEN)
# The two parts of an error get separate panels if they differ by more than this factor.
APART = 10.0
# If the track of the solution extends farther than the references by the factor DIVERGED, a
# second panel shows the surroundings of the references, enlarged by the factor NEAR.
DIVERGED, NEAR = 4.0, 1.2


def navigation_charts(title, result, gap_factor):
    """
    Return the Charts of a NavigationResult: over time, and the track.

    ``title`` names the recording; a step of more than ``gap_factor`` median steps is a gap.
    """
    step_ns = np.median(np.diff(result.states[0].t_ns))
    title = f'{title} at {1e9 / step_ns:.4g} Hz'
    over_time = _errors(title, result, gap_factor) if result.comparisons else _solution(
        title, result, gap_factor)
    return over_time, _track_chart(title, result)


class _Clock:
    """The time since the start of the solution, in the unit of its length."""

    def __init__(self, states):
        self._start_ns = int(states[0].t_ns[0])
        self._per_s, unit = scale(TIMES, (int(states[-1].t_ns[-1]) - self._start_ns) * 1e-9)
        self.label = f'time since the start [{unit}]'

    def __call__(self, t_ns):
        return (t_ns - self._start_ns) * 1e-9 * self._per_s


def _errors(title, result, gap_factor):
    """Return the Chart of the solution minus its references."""
    clock, panels = _Clock(result.states), []
    several = len(result.comparisons) > 1
    for kind, units, *names in ERRORS:
        parts = [[], []]
        for comparison, dash in zip(result.comparisons, DASHES):
            track = getattr(comparison, kind)
            if track is not None:
                east, north, up = track.values.T
                # A rotation about up is counter-clockwise, a heading is clockwise.
                both = np.hypot(east, north), -up if kind == 'attitude' else up
                for part, colour, values in zip(parts, PARTS, both):
                    part.append((comparison.name, track.t_ns, values, colour, dash))
        if parts[0]:
            panels += [_error_panel(what, units, lines, several, result, gap_factor, clock)
                       for what, lines in _together(kind, names, parts)]
    reference = 'its references' if several else result.comparisons[0].name
    return Chart('navigation', f'Solution of the strapdown on {title}, less {reference}',
                 tuple(panels))


def _together(kind, names, parts):
    """
    Return what each panel shows and its lines, {part: lines}.

    Both parts share a panel unless one of them would hide the other.
    """
    low, high = sorted(_largest(part) for part in parts)
    found = dict(zip(names, parts))
    return [(kind, found)] if high <= APART * low else [
        (name, {name: lines}) for name, lines in found.items()]


def _error_panel(what, units, lines, several, result, gap_factor, clock):
    """Return the Panel of an error: for each part, one line per reference."""
    factor, unit = scale(units, max(map(_largest, lines.values())))
    marks = [*_gaps(result.states, gap_factor, clock),
             Level(y=0.0, colour=palette.GREY, dash=DOTTED)]
    for part, of_part in lines.items():
        for reference, t_ns, values, colour, dash in of_part:
            words = [part] * (len(lines) > 1) + [reference] * several
            marks.append(Curve(*_broken(t_ns, values * factor, clock), ', '.join(words) or None,
                               colour, dash, 1.2))
    return Panel(tuple(marks), clock.label, f'{what} error [{unit}]')


def _largest(lines):
    return max(float(np.abs(values).max()) for _, _, values, _, _ in lines)


def _solution(title, result, gap_factor):
    """Return the Chart of velocity and height of a solution that has no reference."""
    clock = _Clock(result.states)
    gaps = _gaps(result.states, gap_factor, clock)
    t_ns = np.concatenate([s.t_ns for s in result.states])
    velocity = np.concatenate([s.v_n for s in result.states])
    height = np.concatenate([s.height for s in result.states])
    per_speed, speed_unit = scale(SPEEDS, float(np.abs(velocity).max()))
    per_m, unit = scale(LENGTHS, float(np.abs(height).max()))
    return Chart('navigation', f'Solution of the strapdown on {title}, which has no reference', (
        Panel((*gaps, *(Curve(*_broken(t_ns, v * per_speed, clock), name, colour, width=1.2)
                        for (name, colour), v in zip(palette.EAST_NORTH_UP.items(), velocity.T))),
              clock.label, f'velocity [{speed_unit}]'),
        Panel((*gaps, Curve(*_broken(t_ns, height * per_m, clock), None, palette.BLUE,
                            width=1.2)), clock.label, f'height [{unit}]')))


def _broken(t_ns, values, clock):
    """Return times and values with NaN in long gaps, so that the curve is interrupted."""
    if len(t_ns) > 1:
        steps = np.diff(t_ns)
        breaks = 1 + np.flatnonzero(steps > max(LONGEST_STEP_S * 1e9, SPARSE * np.median(steps)))
        t_ns, values = np.insert(t_ns, breaks, t_ns[breaks]), np.insert(values, breaks, np.nan)
    return clock(t_ns), values


def _gaps(states, factor, clock):
    """Return the Stretches of the gaps between segments and of those bridged within one."""
    between = [(a.t_ns[-1], b.t_ns[0]) for a, b in zip(states, states[1:])]
    bridged = [(s.t_ns[k], s.t_ns[k + 1]) for s in states for k in find_gaps(s.t_ns, factor)]
    return [Stretch(*clock(np.array(spans)).T, label, colour) for spans, label, colour in (
        (between, 'no solution', palette.GREY), (bridged, 'gap, bridged', palette.SKY)) if spans]


def navigation_tracks(result):
    """Return the Tracks of a NavigationResult: one of each segment, then those of references."""
    start_ns, end_ns = int(result.states[0].t_ns[0]), int(result.states[-1].t_ns[-1])
    tracks = [_track('solution', s.lat, s.lon, s.height) for s in result.states]
    for reference in result.references:
        if reference.position is not None:
            t_ns, values = reference.position.t_ns, reference.position.values
            inside = (t_ns >= start_ns) & (t_ns <= end_ns)
            if inside.any():
                tracks.append(_track(reference.name, *values[inside].T))
    return tracks


def _track(name, lat, lon, height):
    kept = kept_points(lon, lat)
    return Track(name, lat[kept], lon[kept], height[kept])


def _track_chart(title, result):
    """Return the Chart of the tracks of the solution and of the references."""
    tracks, count = navigation_tracks(result), len(result.states)
    start = tracks[0].start
    looks = [(None if k else 'solution', palette.BLUE, SOLID) for k in range(count)]
    looks += [(track.name, colour, DASHED)
              for track, colour in zip(tracks[count:], REFERENCES)]
    ways = [(*look, np.array(ellipsoid.offset(*start, (t.lat, t.lon, t.height))[:2]))
            for look, t in zip(looks, tracks)]
    shown = [_track_panel(ways)]
    near = _size(ways[count:])
    if 0.0 < DIVERGED * near < _size(ways):
        # Show only the surroundings of the references.
        shown.append(_track_panel(ways, near))
    return Chart('track', f'Track of the solution on {title}, from its start', tuple(shown),
                 shared=False, columns=len(shown))


def _size(ways):
    return max((float(np.abs(way).max()) for *_, way in ways), default=0.0)


def _track_panel(ways, near=None):
    """Return the Panel of ways (label, colour, dash, places), about the start if near, m."""
    factor, unit = scale(LENGTHS, near or _size(ways))
    whole = near is None
    marks = []
    for label, colour, dash, way in ways:
        if not whole:
            # Remove the data outside, because the page derives the range of equal axes from data.
            way = np.where(np.abs(way).max(axis=0) <= NEAR * near, way, np.nan)
        marks.append(Curve(*(way * factor), label if whole else None, colour, dash))
    marks.append(Markers(np.zeros(1), np.zeros(1), 'start' if whole else None, palette.BLACK,
                         CIRCLE, 7.0))
    return Panel(tuple(marks), f'east of the start [{unit}]', f'north of the start [{unit}]',
                 '' if whole else 'about the start', equal=True)
