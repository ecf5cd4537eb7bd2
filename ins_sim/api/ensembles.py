"""Monte Carlo simulation, and its result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import os
from typing import Any, TYPE_CHECKING, Union

import numpy as np

from ins_sim.core.ensemble.many_runs import check_runs
from ins_sim.core.ensemble.result import EnsembleResult
from ins_sim.core.timeseries.named_columns import columns, COLUMNS, ENU, UNITS
from ins_sim.io.motion import read_motion
from ins_sim.jobs.executors import check_jobs, open_executor
from ins_sim.settings.simulation import AidedSimulationSettings, SimulationSettings
from ins_sim.studies.aided_ensembles import (AidedEnsembleResult, AidedPlan, check_aided_flight,
                                             fly_aided_ensemble)
from ins_sim.studies.ensemble_errors import (COLUMNS as PARTS, ensemble_digest,
                                             ensemble_errors, EnsembleErrors, PERCENTS,
                                             worst_run)
from ins_sim.studies.ensembles import EnsemblePlan, fly_ensemble, INSTANTS
from .consistency import (consistency_coords, consistency_variables, fixes_dataframe,
                          nees_columns)
from .dataframes import dataframe
from .datasets import dataset
from .inputs import checked_path

if TYPE_CHECKING:
    import pandas
    import xarray

Folder = Union[str, 'os.PathLike[str]']
Progress = Union[Callable[[float], object], None]


@dataclass(frozen=True, eq=False, repr=False)
class MonteCarlo:
    """
    Statistics of many runs of a simulation.

    Attributes
    ----------
    settings : SimulationSettings or AidedSimulationSettings
        Settings of the first run; those of run k are ``settings.with_run(k)``.
    result : EnsembleResult
        The accumulated statistics, and the solution and its errors at the end of every run.
    errors : EnsembleErrors
        Mean, standard deviation, rms, percentiles and CEP at the instants ``errors.t_ns`` (m,).
    aided : AidedEnsembleResult
        For the aided navigator: ``aided.consistency`` holds NEES at the instants and NIS of the
        fixes, ``aided.refused`` the reasons why runs are excluded. None without aiding.
    """

    settings: SimulationSettings | AidedSimulationSettings
    result: EnsembleResult
    errors: EnsembleErrors
    aided: AidedEnsembleResult | None = None

    def __repr__(self) -> str:
        """Return one line, which a notebook shows."""
        return (f'<MonteCarlo: {len(self.runs)} runs, {len(self.diverged)} of them diverged, '
                f'{len(self.errors.t_ns)} instants>')

    @property
    def runs(self) -> range:
        """The numbers of the runs (n,)."""
        return self.result.runs

    @property
    def final_errors(self) -> dict[str, np.ndarray]:
        """Errors at the end of each run: attitude (rad), velocity (m/s), position (m), (n, 3)."""
        return {name: self.result.final_errors[:, part] for name, part in PARTS.items()}

    @property
    def worst(self) -> tuple[int, float] | None:
        """Number and error, m, of the run with the largest horizontal error at the end."""
        found: tuple[int, float] | None = worst_run(self.result)
        return found

    @property
    def diverged(self) -> tuple[int, ...]:
        """
        Numbers of the runs that diverged.

        The statistics exclude them from the divergence on or, with aiding, altogether.
        """
        return self.result.diverged

    @property
    def digest(self) -> str:
        """SHA-256 of statistics and final errors, the same for any ``jobs`` and ``scheduler``."""
        digest: str = ensemble_digest(self.aided or self.result)
        return digest

    def to_dataframe(self, record: str = 'errors') -> pandas.DataFrame:
        """
        Return the statistics, or the final errors of the runs, as a DataFrame.

        Parameters
        ----------
        record : {'errors', 'final', 'velocity_meter', 'gnss'}
            ``errors``: a row for each instant, index ``t_ns``, columns such as
            ``position_sigma_north_m`` and ``position_cep95_m``; with aiding also
            ``nees_position`` and its 95 % interval, ``nees_position_low`` and ``_high``.
            ``final``: a row for each run, index ``run``, columns such as ``position_north_m``.
            ``velocity_meter`` and ``gnss``, with aiding only: a row for each fix with the mean
            ``nis``.

        Raises
        ------
        ImportError
            If pandas is not installed.
        ValueError
            If there is no such record.
        """
        if record == 'final':
            table: dict[str, np.ndarray] = {}
            for name, values in self.final_errors.items():
                table.update(columns(name, values))
            return dataframe(np.array(self.runs), table).rename_axis('run')
        if record != 'errors':
            if self.aided is None:
                raise ValueError(f'record is {record!r}; expected errors or final')
            return fixes_dataframe(self.aided.consistency, record)
        table = {'runs': self.errors.count}
        for name, dims, values, unit in self._statistics():
            if dims == ('time',):
                table[f'{name}_{unit}'] = values
            elif dims == ('time', 'axis'):
                table.update({f'{name}_{axis}_{unit}': values[:, k]
                              for k, axis in enumerate(ENU)})
        if self.aided is not None:
            table.update(nees_columns(self.aided.consistency))
        return dataframe(self.errors.t_ns, table)

    def to_xarray(self) -> xarray.Dataset:
        """
        Return statistics and final errors as a Dataset.

        The dimensions are run, time (ns), axis (east, north, up) and percent; units are in the
        attributes. With aiding it also holds NEES by block of states (time, block), and NIS by
        fix (``velocity_meter_time`` and ``gnss_time``).

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        variables: dict[str, Any] = {'runs': (('time',), self.errors.count, '')}
        variables.update({name: (dims, values, UNITS[unit])
                          for name, dims, values, unit in self._statistics()})
        variables.update({f'final_{name}': (('run', 'axis'), values, UNITS[COLUMNS[name][1]])
                          for name, values in self.final_errors.items()})
        coords: dict[str, Any] = {
            'run': (np.array(self.runs), ''), 'time': (self.errors.t_ns, 'ns'),
            'axis': (ENU, ''), 'percent': (PERCENTS, '%')}
        if self.aided is not None:
            coords.update(consistency_coords(self.aided.consistency))
            variables.update(consistency_variables(self.aided.consistency))
        return dataset(coords, variables, {'seed': self._simulation.imu_sensor.seed,
                                           'digest': self.digest})

    @property
    def _simulation(self) -> SimulationSettings:
        if isinstance(self.settings, AidedSimulationSettings):
            return self.settings.simulation
        return self.settings

    def _statistics(self) -> list[tuple[str, tuple[str, ...], np.ndarray, str]]:
        """Return name, dimensions, values and unit (as in column names) of each statistic."""
        e = self.errors
        found: list[tuple[str, tuple[str, ...], np.ndarray, str]] = []
        for name in PARTS:
            unit = COLUMNS[name][1]
            for what, values in (('mean', e.mean), ('sigma', e.sigma), ('rms', e.rms)):
                found.append((f'{name}_{what}', ('time', 'axis'), values[name], unit))
            found.append((f'{name}_percentiles', ('percent', 'time', 'axis'),
                          e.percentiles[name], unit))
            found.append((f'{name}_horizontal_rms', ('time',), e.horizontal_rms[name], unit))
            found.append((f'{name}_horizontal_percentiles', ('percent', 'time'),
                          e.horizontal_percentiles[name], unit))
        return found + [(f'position_cep{percent}', ('time',), radius, 'm')
                        for percent, radius in e.cep.items()]

    def save(self, folder: Folder, overwrite: bool = False) -> None:
        """
        Write the report and its data into a folder, as ``ins_sim monte-carlo -o``.

        Parameters
        ----------
        folder : str or path
        overwrite : bool, optional
            Replace the folder if it holds such a study.

        Raises
        ------
        ValueError
            If the folder exists and must not be replaced, or does not hold a study.
        """
        from ins_sim.own_folders.own_folder import whole_folder
        from ins_sim.report.studies import ensemble
        checked_path('folder', folder)
        with whole_folder(folder, overwrite, ensemble.ARRAYS, 'overwrite=True') as work:
            title = ensemble.ensemble_title(self.settings, len(self.runs))
            ensemble.write_ensemble(work, ensemble.ensemble_report(
                title, self.settings, self.aided or self.result))


def monte_carlo(settings: SimulationSettings | AidedSimulationSettings, runs: int = 1000,
                instants: int = INSTANTS, jobs: int = 0, scheduler: str | None = None,
                blocks: Folder | None = None, progress: Progress = None) -> MonteCarlo:
    """
    Simulate many runs with different random numbers, and return statistics of their errors.

    Parameters
    ----------
    settings : SimulationSettings or AidedSimulationSettings
        From ``read_settings``; their ``run`` is the number of the first run. With
        AidedSimulationSettings the aided navigator is simulated, and NEES and NIS are computed.
    runs : int, optional
        Number of runs.
    instants : int, optional
        Number of instants of the statistics, evenly spaced from the start of the strapdown to the
        end.
    jobs : int, optional
        Number of processes; 0: one for each core, 1: this process alone. The result does not
        depend on it.
    scheduler : str, optional
        Address of a Dask scheduler, such as ``'tcp://host:8786'``, used instead of processes.
    blocks : str or path, optional
        Folder in which finished blocks are kept, so that the same call resumes an interrupted
        one. It is not deleted at the end.
    progress : callable, optional
        Called with the fraction done, 0 to 1.

    Returns
    -------
    MonteCarlo

    Raises
    ------
    ValueError
        As ``simulate``; if ``blocks`` holds blocks of other settings; if the cluster cannot be
        used.

    Examples
    --------
    >>> import ins_sim
    >>> settings = ins_sim.read_settings(['racetrack', 'imu_tactical_fog'], {'duration_s': 2.0})
    >>> study = ins_sim.monte_carlo(settings, runs=20, jobs=1)
    >>> study
    <MonteCarlo: 20 runs, 0 of them diverged, 61 instants>
    >>> number, metres = study.worst
    >>> alone = ins_sim.simulate(settings.with_run(number))
    >>> bool((alone.errors.position[-1] == study.final_errors['position'][number]).all())
    True
    """
    check_jobs(jobs, scheduler)
    aided = isinstance(settings, AidedSimulationSettings)
    if not aided and not isinstance(settings, SimulationSettings):
        raise ValueError(f'settings are {type(settings).__name__}; expected SimulationSettings or '
                         'AidedSimulationSettings of read_settings')
    store, plan = None, (AidedPlan if aided else EnsemblePlan)(settings, runs, instants)
    if isinstance(settings, AidedSimulationSettings):
        check_aided_flight(plan, read_motion(settings.simulation.motion_generator))
    else:
        check_runs(settings, read_motion(settings.motion_generator))
    if blocks is not None:
        from ins_sim.jobs.store import BlockStore
        store = BlockStore(checked_path('blocks', blocks), plan.identity())
    total = len(plan.blocks()) - (store.found if store else 0)

    def went(done: int) -> None:
        if progress is not None:
            progress(done / total)

    with open_executor(jobs, scheduler) as executor:
        if aided:
            found = fly_aided_ensemble(plan, read_motion, executor, store, went)
            return MonteCarlo(settings, found.errors, ensemble_errors(found.errors), found)
        result = fly_ensemble(plan, read_motion, executor, store, went)
    return MonteCarlo(settings, result, ensemble_errors(result))
