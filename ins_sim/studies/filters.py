"""All filters over the same flights and seeds: how far each is off, and whether it knows."""

from dataclasses import dataclass, replace

import numpy as np

from ins_sim.core.aiding.navigator import METER
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.motion.motion import check_length
from ins_sim.core.simulation import inertial
from ins_sim.core.simulation.aided import make_instruments
from ins_sim.core.simulation.aided_run import navigate_aided, Reported, with_truth
from ins_sim.settings.aided_navigator import FILTERS

STEP_S = 5.0


@dataclass(frozen=True)
class FilterCase:
    """A filter, and the cycles that its velocity meter averages over."""

    filter: str
    cycles: int


@dataclass(frozen=True)
class FilterFlight:
    """
    One filter on one flight, at instants t_s (n,) since the start.

    error, sigma (n, 3): position East, North, Up and its standard deviation by the filter (NaN:
    none), m; azimuth, azimuth_sigma (n,) rad; estimates (n, 3): mu, kx, kz; nis: of the fixes of
    the velocity meter that were weighed; refused: how many were not taken, and the last reason.
    """

    t_s: np.ndarray
    error: np.ndarray
    sigma: np.ndarray
    azimuth: np.ndarray
    azimuth_sigma: np.ndarray
    estimates: np.ndarray
    nis: np.ndarray
    refused: int
    reason: str

    @property
    def horizontal(self):
        """Return the horizontal error (n,), m."""
        return np.hypot(self.error[:, 0], self.error[:, 1])


def run_settings(settings, run):
    """Return AidedSimulationSettings of a run of the study: its seeds are those given plus run."""
    base = settings.simulation
    generator, sensor = base.motion_generator, base.imu_sensor
    route = generator.motion.route
    motion = replace(generator.motion, route=replace(route, gust_seed=route.gust_seed + run))
    base = replace(base, motion_generator=replace(generator, motion=motion),
                   imu_sensor=replace(sensor, seed=sensor.seed + run, motion=motion))
    meter, gnss, navigator = (replace(s, seed=s.seed + run) for s in (
        settings.velocity_meter, settings.gnss, settings.aided_navigator))
    return replace(settings, simulation=base, velocity_meter=meter, gnss=gnss,
                   aided_navigator=navigator)


def fly_filters(settings, cases, run):
    """
    Return the FilterFlight of each FilterCase on one flight: AidedSimulationSettings, its seeds
    plus run.

    The readings of the IMU, and the fixes of each length of window, are made once.  Raises
    ValueError as the stages do.
    """
    settings = run_settings(settings, run)
    generator = settings.simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    check_length(generator, motion)
    blocks = list(with_truth(motion, inertial.imu_blocks(settings.simulation, motion)))
    chosen = {cycles: _with_cycles(settings, cycles) for cycles in {c.cycles for c in cases}}
    fixes = {cycles: _fixes(s, blocks) for cycles, s in chosen.items()}
    return [_fly(chosen[case.cycles].aided_navigator, case, blocks, fixes[case.cycles])
            for case in cases]


def _with_cycles(settings, cycles):
    """Return AidedSimulationSettings with windows of the velocity meter of that many cycles."""
    window = replace(settings.velocity_meter.window, cycles=cycles)
    return replace(settings, velocity_meter=replace(settings.velocity_meter, window=window),
                   aided_navigator=replace(settings.aided_navigator, window=window))


def _fixes(settings, blocks):
    """Return the fixes of velocity meter and GNSS."""
    return [[fix for _, truth in blocks for fix in instrument.advance(truth)]
            for instrument in make_instruments(settings)]


def _fly(settings, case, blocks, fixes):
    used = settings.gnss_model.use and FILTERS[case.filter].takes_gnss
    settings = replace(settings, filter=case.filter,
                       output_every=max(1, round(STEP_S * settings.rate_hz)),
                       gnss_model=replace(settings.gnss_model, use=used))
    flown = navigate_aided(settings, blocks, *map(Reported, fixes))
    errors = flown.errors
    weighed = [t.outcome for t in flown.judged if t.source == METER]
    refused = [r.reason for r in weighed if not r.taken and case.filter != 'free']
    return FilterFlight(
        (errors.t_ns - errors.t_ns[0]) * 1e-9, errors.position, errors.position_sigma,
        errors.attitude[:, 2], errors.attitude_sigma[:, 2], errors.estimates,
        np.array([r.nis for r in weighed if r.nis is not None]), len(refused),
        refused[-1] if refused else '')
