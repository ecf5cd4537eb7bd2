"""
Study of the closed loop of Ivanov (2015) on the complete chain: which filters disturb it.

Motion, IMU, meter, navigator and autopilot are those of ``simulate``. The expected results come
from an independent simulation, in which the command was held over a control period; here it
changes linearly.
"""

from dataclasses import dataclass, replace
import math

import numpy as np

from ins_sim.core.guidance.error_loop import fly_reduced, ReducedCases
from ins_sim.core.guidance.linear_loop import Aiding, KINDS, limits
from ins_sim.core.guidance.linear_plant import lateral_loop
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.simulation.guided_flight import fly
from .oscillations import frequency, growth_rate, half_range

# Growth of flights is evaluated at these fractions of the linear limits of k_z.
NEAR = (0.98, 1.02)
# Histories are stored at this step.
KEPT_S = 0.1
QUIET_DEG = 0.05


@dataclass(frozen=True)
class Published:
    """
    Expected results of a case; None if not stated.

    Attributes
    ----------
    beta_deg : half the range of the sideslip over the last 30 %, deg; 0 for less than QUIET_DEG
    frequency : frequency of the oscillation, rad/s
    swing_m : half the range of z, m
    end_m : z at the end, m
    """

    beta_deg: float
    frequency: float | None = None
    swing_m: float | None = None
    end_m: float | None = None


@dataclass(frozen=True)
class LoopCase:
    """
    A flight of the study.

    Attributes
    ----------
    k_z : lateral scale factor error of the meter
    filter : name of the filter of the navigator
    cycles : N, number of cycles of a window
    gain : K_v, 1/s, for sliding windows, otherwise the gain of the filter
    slides : whether a window ends every cycle
    offset_m : z at the start, m
    engage_s : time at which the autopilot is engaged, s
    duration_s : length of the flight, s
    published : Published results, or None
    """

    k_z: float
    filter: str
    cycles: int
    gain: float = 0.0
    slides: bool = False
    offset_m: float = 100.0
    engage_s: float = 0.0
    duration_s: float = 300.0
    published: Published | None = None

    @property
    def label(self):
        """Return a label with filter, N and gain."""
        if self.filter in ('window_kf', 'eskf'):
            return f'{self.filter}, N {self.cycles}'
        name = 'sliding' if self.slides else self.filter
        return f'{name}, N {self.cycles}, {"K_v" if self.slides else "K"} {self.gain:g}'


@dataclass(frozen=True)
class LoopFlight:
    """Histories of a flight at t_s (n,), s: true z, m, and beta, rad, and the estimated z, m."""

    t_s: np.ndarray
    z: np.ndarray
    beta: np.ndarray
    z_estimated: np.ndarray

    @property
    def beta_deg(self):
        """Return half the range of beta over the last 30 %, deg."""
        return math.degrees(half_range(self.beta))

    @property
    def swing_m(self):
        """Return half the range of z over the last 30 %, m."""
        return half_range(self.z)

    @property
    def frequency(self):
        """Return the frequency of beta over the last half, rad/s, or None."""
        return frequency(self.t_s, self.beta)


def _slid(k_z, cycles, gain, published, **more):
    return LoopCase(k_z, 'conventional', cycles, gain, True, published=published, **more)


def _paper(k_z, cycles, gain, published, **more):
    return LoopCase(k_z, 'paper_corrected', cycles, gain, published=published, **more)


QUIET = Published(0.0)
TABLE = (
    *(_slid(0.0, cycles, gain, QUIET) for cycles in (10, 100, 1000) for gain in (1.0, 50.0)),
    LoopCase(0.0, 'conventional', 100, 0.3), LoopCase(0.0, 'conventional', 100, 0.4),
    _paper(0.0, 100, 1.9, QUIET), _paper(0.0, 1000, 0.344, QUIET),
    _slid(0.15, 100, 1.0, Published(4.3, 0.345)),
    _slid(0.17, 100, 1.0, Published(8.0, 0.318, 31.0)),
    _slid(0.15, 10, 1.0, Published(8.0, 0.557, 10.0)),
    _slid(0.15, 100, 5.0, Published(8.0)), _slid(0.30, 100, 1.0, Published(8.0)),
    _slid(0.15, 100, 0.2, Published(0.0, end_m=-10.0)),
    _paper(0.15, 1000, 0.1, QUIET), _paper(0.15, 1000, 0.344, Published(0.0, end_m=347.0)),
    _paper(0.15, 1000, 1.0, QUIET), _paper(0.15, 100, 0.344, Published(0.0, end_m=792.0)),
    _paper(0.15, 1000, 0.344, Published(0.0, end_m=2200.0), duration_s=1800.0),
    _paper(0.15, 1000, 0.344, Published(0.0, end_m=0.0), engage_s=20.0),
    _paper(0.30, 1000, 0.344, QUIET), _paper(0.30, 1000, 1.0, Published(8.0)),
    _paper(0.30, 1000, 1.0, QUIET, offset_m=10.0),
    LoopCase(0.15, 'window_kf', 1000, published=QUIET),
    LoopCase(0.15, 'eskf', 1000, published=QUIET))
# {condition: parameters that add it to those of the study}
CONDITIONS = {
    'perfect meter': (),
    'noise of the meter': (
        'velocity_meter:surrogate.sigma_x_m_s:=8.0', 'velocity_meter:surrogate.sigma_z_m_s:=8.7',
        'velocity_meter:surrogate.slip_x:=6.0', 'velocity_meter:surrogate.slip_z_m_s:=160.0'),
    'wind 8 m/s across': ('motion.route.wind_m_s:=8.0', 'motion.route.wind_from_deg:=320.0'),
    'gusts 0.5 m/s': ('motion.route.gust_m_s:=0.5',),
    'signals of the meter': ('velocity_meter:mode:=signal',
                             'aided_navigator:meter_model.bias_x_m_s:=-16.0')}
# Cases that are flown under all CONDITIONS.
VARIED = (_slid(0.15, 100, 1.0, None), _slid(0.15, 100, 0.2, None),
          _paper(0.15, 1000, 0.344, None), LoopCase(0.15, 'eskf', 1000))
# Cases whose limits are determined on the complete chain.
AT_THE_LIMIT = (_slid(0.0, 10, 1.0, None), _slid(0.0, 100, 1.0, None),
                _paper(0.0, 100, 0.344, None))


def case_settings(settings, case):
    """
    Return the AidedSimulationSettings of a LoopCase.

    settings: all settings that do not depend on the case. k_z is realised by an elliptical beam,
    which the meter supports in both modes.
    """
    base, meter, navigator = settings.simulation, settings.velocity_meter, settings.aided_navigator
    generator = base.motion_generator
    motion = replace(generator.motion, guided=replace(generator.motion.guided,
                                                      offset_m=case.offset_m))
    guidance = replace(generator.guidance, engage_after_s=case.engage_s)
    base = replace(base, motion_generator=replace(generator, motion=motion, guidance=guidance,
                                                  duration_s=case.duration_s),
                   imu_sensor=replace(base.imu_sensor, motion=motion))
    window = replace(meter.window, cycles=case.cycles, slide_cycles=1 if case.slides else 0)
    beam = replace(meter.beam, sigma_theta_z_rad=meter.beam.sigma_theta_x_rad
                   * math.sqrt(1.0 + case.k_z))
    gain = {'gain_per_s' if case.slides else 'gain': case.gain}
    return replace(settings, simulation=base,
                   velocity_meter=replace(meter, window=window, beam=beam,
                                          surrogate=replace(meter.surrogate, k_z=0.0)),
                   aided_navigator=replace(navigator, filter=case.filter, window=window, **gain))


def fly_case(settings, case):
    """Fly a LoopCase and return the LoopFlight; raises ValueError as the stages do."""
    settings = case_settings(settings, case)
    generator = settings.simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    flown = fly(settings.simulation, motion, settings)
    states = flown.states
    every = max(1, round(KEPT_S * generator.motion.guided.control_rate_hz))
    return LoopFlight((states.t_ns[::every] - states.t_ns[0]) * 1e-9, states.z[::every],
                      states.beta[::every], flown.estimates.z[::every])


def lateral_flight(settings, loop, case):
    """
    Return the LoopFlight of the lateral channel alone for a LoopCase; None for a Kalman filter.

    settings: AidedSimulationSettings; loop: their LateralLoop.
    """
    if case.filter not in KINDS:
        return None
    aiding = aiding_of(case, 1.0 / loop.period_s)
    cases = ReducedCases(*(np.array([x]) for x in (aiding.gain, case.k_z, case.offset_m)))
    most = math.radians(settings.simulation.motion_generator.guidance.limit_deg)
    flown = fly_reduced(loop, aiding, cases, case.duration_s, most, case.engage_s, forward=False)
    return LoopFlight(flown.t_s, flown.z[:, 0], flown.beta[:, 0],
                      flown.z[:, 0] + flown.error_z[:, 0])


def study_loop(settings):
    """
    Return the LateralLoop of AidedSimulationSettings.

    Raises ValueError for loops that the study does not cover: an autopilot that does not return to
    the leg, a command limit of zero, or a control period that differs from the meter's cycle.
    """
    generator = settings.simulation.motion_generator
    loop, rate_hz = lateral_loop(generator), settings.velocity_meter.rate_hz
    if loop is None or loop.k1 == 0.0:
        raise ValueError(f'guidance.autopilot is {generator.guidance.autopilot}; expected one '
                         'with a gain for the offset, which the linear limits of the study need')
    if generator.guidance.limit_deg == 0.0:
        raise ValueError('guidance.limit_deg is 0 deg; expected more than 0, because the '
                         'autopilot cannot steer otherwise')
    control_hz = generator.motion.guided.control_rate_hz
    if control_hz != rate_hz:
        raise ValueError(f'motion.guided.control_rate_hz is {control_hz:g} Hz; expected rate_hz, '
                         f'{rate_hz:g} Hz, which the study requires')
    return loop


def aiding_of(case, rate_hz):
    """Return the Aiding of a LoopCase; rate_hz: rate of the cycles."""
    step = 1 if case.slides else case.cycles
    gain = case.gain / rate_hz if case.slides else case.gain
    return Aiding(case.filter, case.cycles, step, gain)


def linear_limits(loop):
    """Return the positive StabilityLimits of the cases AT_THE_LIMIT."""
    return [limits(loop, aiding_of(case, 1.0 / loop.period_s)).positive for case in AT_THE_LIMIT]


def cases_near(linear):
    """Return LoopCases, two for each of AT_THE_LIMIT, whose growth rates bracket the limit."""
    return [replace(case, k_z=part * limit.k_z, offset_m=1.0)
            for case, limit in zip(AT_THE_LIMIT, linear) for part in NEAR]


def flown_limits(linear, growths):
    """Return the k_z at which flights neither grow nor decay; growths: of ``cases_near``."""
    pairs = zip(linear, growths[::2], growths[1::2])
    return [limit.k_z * (NEAR[0] - low * (NEAR[1] - NEAR[0]) / (high - low))
            for limit, low, high in pairs]


def growth_of_flight(settings, case):
    """Return the growth rate of beta, 1/s, in a flight of a LoopCase without saturation."""
    flight = fly_case(settings, case)
    return growth_rate(flight.t_s, flight.beta)
