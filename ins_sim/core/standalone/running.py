"""Navigation without truth, from its start on, with its covariance."""

import math
from typing import NamedTuple

from ins_sim.core.earth import ellipsoid
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.navigation.recorded import RecordedNavigator
from ins_sim.core.navigation.strapdown import runs_away
from ins_sim.core.numerics.instants import seconds
from ins_sim.core.simulation.free_covariance import PublishedCovariance, published_covariance
from ins_sim.settings.place import Datum


class Solved(NamedTuple):
    """
    A solution.

    Attributes
    ----------
    t_ns : stamp, ns
    state : lat (rad), lon (rad), height (m), v_n (m/s), q_nb
    rate : angular rate of the body minus the bias, rad/s
    tag : object that was given with the sample
    known : PublishedCovariance
    """

    t_ns: int
    state: tuple
    rate: tuple
    tag: object
    known: PublishedCovariance


class RunningNavigation:
    """
    Steps a RecordedNavigator and its covariance through the samples since a Start.

    Parameters
    ----------
    settings : StrapdownSettings
    start : Start
    step_ns : typical step of the stamps, ns
    heights : VerticalReference

    Attributes
    ----------
    frame : MapFrame at the datum, or at the start if the datum is the default
    located : see Start
    begins_map : whether the start is located and is the origin of map
    t_ns : stamp of the last sample, or None

    """

    def __init__(self, settings, start, step_ns, heights):
        lat, lon, height = start.state[:3]
        datum = settings.datum
        self.begins_map = start.located and datum == Datum()
        if datum == Datum():
            datum = Datum(math.degrees(lat), math.degrees(lon), height)
        self.frame = MapFrame(datum, settings.earth.rotation)
        self.located, self.t_ns, self._before = start.located, None, None
        self._bias = start.bias or (0.0, 0.0, 0.0)
        self._step_ns, self._heights = step_ns, heights
        vertical = settings.vertical
        damped_s = None if vertical.channel == 'free' else vertical.time_constant_s
        self._navigator = RecordedNavigator(
            settings.input, ellipsoid.rotation_rate(settings.earth.rotation), start.state,
            damped_s, ellipsoid.GRAVITY_TERMS[settings.earth.gravity])
        self._covariance = published_covariance(settings, self.frame, start.sigmas,
                                                1e-9 * step_ns)
        self._covered_ns = None
        heights.begin(height)

    @property
    def place(self):
        """Return latitude, longitude and height."""
        return self._navigator.solution[:3]

    def step(self, sample, gap_ns):
        """
        Process an ImuSample; return the Solved.

        gap_ns: longest step that does not count as a gap, ns; a longer one is bridged. Raises
        ValueError if the solution diverges.
        """
        (t_ns, omega, f, tag), b = sample, self._bias
        omega = omega[0] - b[0], omega[1] - b[1], omega[2] - b[2]
        navigator, first = self._navigator.copy(), self.t_ns is None
        if not first and t_ns - self.t_ns > gap_ns:
            navigator.bridge_next(self._step_ns)
        solution = navigator.step(t_ns, omega, f, self._heights.at(t_ns))
        if not first and (runs_away(solution) or not all(map(math.isfinite, solution[4]))):
            raise ValueError(f'the solution diverges at {seconds(t_ns)} and is stopped: check '
                             'the initial values and the units of the IMU')
        self._before = self._navigator, self.t_ns
        self._navigator, self.t_ns = navigator, t_ns
        if first:
            self._covariance.begin(t_ns, solution)
        elif t_ns > self._covered_ns:
            self._covariance.take(t_ns, omega, f, navigator)
        self._covered_ns = t_ns
        return Solved(t_ns, solution, omega, tag, self._covariance.shown)

    def undo(self):
        """Undo the last sample; return whether that was possible."""
        if self._before is None or self._before[1] is None:
            return False
        self._navigator, self.t_ns = self._before
        self._before = None
        return True
