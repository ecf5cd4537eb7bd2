"""Compare all filters on the same flights and seeds: their errors and their consistency."""

from dataclasses import dataclass, fields, replace

import numpy as np

from ins_sim.core.aiding.consistency import note_of
from ins_sim.core.aiding.navigator import METER
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.motion.motion import check_length
from ins_sim.core.simulation import inertial
from ins_sim.core.simulation.aided import make_instruments
from ins_sim.core.sensors.imu.with_errors import with_errors
from ins_sim.core.simulation.aided_run import navigate_aided, Reported, with_truth
from ins_sim.core.simulation.normalised_errors import ErrorNormaliser
from ins_sim.jobs.blocks import run_blocks
from ins_sim.jobs.fingerprint import array_digest, fingerprint
from ins_sim.settings.aided_navigator import FILTERS
from ins_sim.settings.simulation import AidedSimulationSettings

STEP_S = 5.0
MOST_FLIGHTS = 100000


@dataclass(frozen=True)
class FilterCase:
    """A filter, and the number of cycles over which its velocity meter averages."""

    filter: str
    cycles: int


@dataclass(frozen=True)
class FilterFlight:
    """
    One filter on one flight, at instants t_s (n,) since the start.

    Attributes
    ----------
    t_s : (n,) time since the start, s
    error : (n, 3) position error, East, North, Up, m
    sigma : (n, 3) its standard deviation by the filter, m; NaN if unknown
    azimuth : (n,) azimuth error, rad
    azimuth_sigma : (n,) its standard deviation by the filter, rad; NaN if unknown
    estimates : (n, 3) mounting error mu (rad), kx and kz of the velocity meter
    nees : (n, core.aiding.consistency.BLOCKS) NEES
    freedom : (n, core.aiding.consistency.BLOCKS) degrees of freedom of the NEES
    nis : (k,) NIS of the processed fixes of the velocity meter
    nis_t_s : (k,) instants of these fixes, time since the start, s
    refused : number of rejected fixes of the velocity meter
    reason : reason of the last rejection, or ''
    """

    t_s: np.ndarray
    error: np.ndarray
    sigma: np.ndarray
    azimuth: np.ndarray
    azimuth_sigma: np.ndarray
    estimates: np.ndarray
    nees: np.ndarray
    freedom: np.ndarray
    nis: np.ndarray
    nis_t_s: np.ndarray
    refused: int
    reason: str

    @property
    def horizontal(self):
        """Return the horizontal error (n,), m."""
        return np.hypot(self.error[:, 0], self.error[:, 1])


def run_settings(settings, run):
    """Return AidedSimulationSettings of a run of the study: the given seeds plus run."""
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
    Return the FilterFlight of each FilterCase on one flight.

    settings: AidedSimulationSettings; run: is added to their seeds. The readings of the IMU, and
    the fixes for each length of window, are computed once. Raises ValueError as the stages do.
    """
    settings = run_settings(settings, run)
    generator = settings.simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    check_length(generator, motion)
    blocks = list(with_truth(motion, inertial.imu_blocks(settings.simulation, motion)))
    chosen = {cycles: _with_cycles(settings, cycles) for cycles in {c.cycles for c in cases}}
    fixes = {cycles: _fixes(s, blocks) for cycles, s in chosen.items()}
    errors = with_errors(settings.simulation.imu_sensor)
    return [_fly(chosen[case.cycles], case, blocks, fixes[case.cycles], errors) for case in cases]


def cases_of(filters=None, cycles=(1000,)):
    """
    Return the FilterCases of a comparison.

    filters: names, None for all; cycles: of a window, the first for all filters, the others only
    for the eskf.
    """
    for n in cycles:
        if isinstance(n, bool) or not isinstance(n, int) or not 1 <= n <= 100000:
            raise ValueError(f'cycles is {n!r}; expected 1 to 100000')
    names = list(dict.fromkeys(FILTERS if filters is None else filters))
    for name in names:
        if name not in FILTERS:
            raise ValueError(f'filter is {name!r}; expected one of {", ".join(FILTERS)}')
    cases = [FilterCase(name, cycles[0]) for name in names]
    if not cases:
        raise ValueError('filters is empty; expected one or more')
    return tuple(cases + [FilterCase('eskf', n) for n in cycles[1:] if 'eskf' in names])


@dataclass(frozen=True)
class FilterPlan:
    """
    Definition of a comparison: AidedSimulationSettings, number of flights, and FilterCases on
    each.

    ``plan(k)`` computes flight k for ``jobs.blocks.run_blocks``. Raises ValueError for invalid
    numbers.
    """

    settings: AidedSimulationSettings
    flights: int
    cases: tuple

    def __post_init__(self):
        """Check the number."""
        if isinstance(self.flights, bool) or not isinstance(self.flights, int) or not (
                1 <= self.flights <= MOST_FLIGHTS):
            raise ValueError(f'runs is {self.flights!r}; expected a whole number from 1 to '
                             f'{MOST_FLIGHTS}')

    def __call__(self, run):
        """Return the arrays of one flight, see ``flights_of``."""
        found = {}
        for k, flight in enumerate(fly_filters(self.settings, self.cases, run)):
            found.update({f'{f.name}_{k}': np.asarray(getattr(flight, f.name))
                          for f in fields(FilterFlight)})
        return found

    def identity(self):
        """Return the data that determine the numbers, for ``jobs.store.BlockStore``."""
        return fingerprint(self.settings.by_node(), study='compare-filters',
                           runs=self.flights, cases=[f'{c.filter}, N {c.cycles}'
                                                     for c in self.cases])


@dataclass(frozen=True, eq=False)
class ComparedFilters:
    """Result: for each case the FilterFlights, one for each flight, and the digest of all."""

    cases: tuple
    flown: list
    digest: str


def compare(plan, executor, store=None, progress=None):
    """
    Run a FilterPlan and return the ComparedFilters.

    executor, store, progress: see ``run_blocks``. The bits do not depend on the executor.
    """
    flights, arrays = [], {}
    for k, found in run_blocks(plan, range(plan.flights), executor, store, progress):
        flights.append(flights_of(found))
        arrays.update({f'{k}_{name}': array for name, array in found.items()})
    return ComparedFilters(plan.cases, [list(f) for f in zip(*flights)], array_digest(arrays))


def flights_of(arrays):
    """Return the FilterFlight of each case from the arrays of one flight."""
    count = len([name for name in arrays if name.startswith('t_s_')])
    plain = {'refused': int, 'reason': str}
    return [FilterFlight(**{f.name: plain.get(f.name, np.asarray)(arrays[f'{f.name}_{k}'])
                            for f in fields(FilterFlight)}) for k in range(count)]


def _with_cycles(settings, cycles):
    """Return AidedSimulationSettings with velocity meter windows of the given number of cycles."""
    window = replace(settings.velocity_meter.window, cycles=cycles)
    return replace(settings, velocity_meter=replace(settings.velocity_meter, window=window),
                   aided_navigator=replace(settings.aided_navigator, window=window))


def _fixes(settings, blocks):
    """Return the fixes of velocity meter and GNSS."""
    return [[fix for _, truth in blocks for fix in instrument.advance(truth)]
            for instrument in make_instruments(settings)]


def _fly(settings, case, blocks, fixes, imu_errors):
    navigator = settings.aided_navigator
    used = navigator.gnss_model.use and FILTERS[case.filter].takes_gnss
    navigator = replace(navigator, filter=case.filter,
                        output_every=max(1, round(STEP_S * navigator.rate_hz)),
                        gnss_model=replace(navigator.gnss_model, use=used))
    flown = navigate_aided(navigator, blocks, *map(Reported, fixes), note=note_of)
    errors = flown.errors
    judged = [t for t in flown.judged if t.source == METER]
    refused = [t.outcome.reason for t in judged
               if not t.outcome.taken and case.filter != 'free']
    weighed = [t for t in judged if t.outcome.nis is not None]
    return FilterFlight(
        (errors.t_ns - errors.t_ns[0]) * 1e-9, errors.position, errors.position_sigma,
        errors.attitude[:, 2], errors.attitude_sigma[:, 2], errors.estimates,
        *ErrorNormaliser(settings, imu_errors).of(flown),
        np.array([t.outcome.nis for t in weighed], dtype=float),
        np.array([(t.t_ns - errors.t_ns[0]) * 1e-9 for t in weighed], dtype=float),
        len(refused), refused[-1] if refused else '')
