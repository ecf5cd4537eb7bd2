"""Comparison of the aiding filters on the same flights, and its result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
import os
from typing import Any, TYPE_CHECKING, Union

import numpy as np

from ins_sim.core.aiding.consistency import BLOCKS
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.motion.motion import check_length
from ins_sim.core.timeseries.named_columns import ENU
from ins_sim.jobs.executors import check_jobs, open_executor
from ins_sim.report.studies.filters import filter_row, FilterRow
from ins_sim.settings.simulation import AidedSimulationSettings
from ins_sim.studies.filters import (cases_of, compare, ComparedFilters, FilterFlight, FilterPlan,
                                     run_settings)
from .dataframes import dataframe
from .datasets import dataset
from .inputs import checked_path

if TYPE_CHECKING:
    import pandas
    import xarray

Folder = Union[str, 'os.PathLike[str]']
Progress = Union[Callable[[float], object], None]


@dataclass(frozen=True, eq=False, repr=False)
class FilterComparison:
    """
    Results of several filters on the same flights.

    Attributes
    ----------
    settings : AidedSimulationSettings
        Settings of flight 0; the seeds of flight k are larger by k.
    found : ComparedFilters
        ``flown`` holds for each case a FilterFlight for each flight; ``digest`` is the SHA-256 of
        all of them.
    rows : tuple of FilterRow
        Summary of each case: errors, NIS and NEES with their intervals.
    """

    settings: AidedSimulationSettings
    found: ComparedFilters
    rows: tuple[FilterRow, ...]

    def __repr__(self) -> str:
        """Return one line, which a notebook shows."""
        return (f'<FilterComparison: {len(self.rows)} filters, {self.rows[0].flights} flights, '
                f'best {self.best}>')

    @property
    def best(self) -> str:
        """Name of the filter (and window) with the smallest rms horizontal error at the end."""
        return str(min(self.rows, key=lambda row: row.end_m).name)

    @property
    def digest(self) -> str:
        """SHA-256 of all flights; it does not depend on ``jobs`` or ``scheduler``."""
        return self.found.digest

    def to_dataframe(self) -> pandas.DataFrame:
        """
        Return a DataFrame with a row for each case.

        The columns are the fields of FilterRow, and NEES at the end by block of states.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        table: dict[str, list[Any]] = {}
        for row in self.rows:
            values = asdict(row)
            nees = values.pop('nees')
            for block in BLOCKS:
                mean, low, high, _ = nees.get(block, (None,) * 4)
                values.update({f'nees_{block}': mean, f'nees_{block}_low': low,
                               f'nees_{block}_high': high})
            for name, value in {**values, 'consistency': row.consistency}.items():
                table.setdefault(name, []).append(value)
        return dataframe(np.arange(len(self.rows)),
                         {name: np.array(values, dtype=_type(values))
                          for name, values in table.items()}).rename_axis('case')

    def to_xarray(self) -> xarray.Dataset:
        """
        Return the flights as a Dataset with the dimensions case, run, time, axis, block.

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        def stacked(of: Callable[[FilterFlight], np.ndarray]) -> np.ndarray:
            return np.array([[of(flight) for flight in flights] for flights in self.found.flown])

        first = self.found.flown[0][0]
        dims = ('case', 'run', 'time')
        return dataset(
            {'case': ([row.name for row in self.rows], ''),
             'run': (np.arange(len(self.found.flown[0])), ''),
             'time': (np.rint(1e9 * first.t_s).astype(np.int64), 'ns'), 'axis': (ENU, ''),
             'block': (BLOCKS, '')},
            {'position': ((*dims, 'axis'), stacked(lambda f: f.error), 'm'),
             'position_sigma': ((*dims, 'axis'), stacked(lambda f: f.sigma), 'm'),
             'azimuth': (dims, stacked(lambda f: f.azimuth), 'rad'),
             'azimuth_sigma': (dims, stacked(lambda f: f.azimuth_sigma), 'rad'),
             'nees': ((*dims, 'block'), stacked(lambda f: f.nees), ''),
             'freedom': ((*dims, 'block'), stacked(lambda f: f.freedom), '')},
            {'digest': self.digest})

    def save(self, folder: Folder, overwrite: bool = False) -> None:
        """
        Write the report and its data into a folder, as ``ins_sim compare-filters -o``.

        Parameters
        ----------
        folder : str or path
        overwrite : bool, optional
            Replace the folder if it holds such a comparison.

        Raises
        ------
        ValueError
            If the folder exists and must not be replaced, or does not hold a comparison.
        """
        from ins_sim.own_folders.own_folder import whole_folder
        from ins_sim.report.studies import filter_charts
        checked_path('folder', folder)
        with whole_folder(folder, overwrite, filter_charts.MARK, 'overwrite=True') as work:
            title = filter_charts.comparison_title(self.settings, self.rows[0].flights)
            page = filter_charts.page_of(title, self.settings, self.rows, self.found.flown,
                                         self.digest)
            filter_charts.write_comparison(work, page, self.rows)


def _type(values: list[Any]) -> Any:
    """Return the dtype of a column: float if a value is None, which becomes NaN, else None."""
    return float if any(value is None for value in values) else None


def compare_filters(settings: AidedSimulationSettings, runs: int = 24,
                    filters: Sequence[str] | None = None, cycles: Sequence[int] | None = None,
                    jobs: int = 0, scheduler: str | None = None, blocks: Folder | None = None,
                    progress: Progress = None) -> FilterComparison:
    """
    Simulate the same flights with several filters of the aided navigator.

    Parameters
    ----------
    settings : AidedSimulationSettings
        From ``read_settings(..., aided=True)``; the seeds of flight k are larger by k.
    runs : int, optional
        Number of flights.
    filters : sequence of str, optional
        Names of the filters; by default all.
    cycles : sequence of int, optional
        Numbers of navigation cycles in a fix of the velocity meter: the first is used for all
        filters, the others in addition for eskf. By default ``window.cycles``.
    jobs : int, optional
        Number of processes; 0: one for each core, 1: this process alone. The result does not
        depend on it.
    scheduler : str, optional
        Address of a Dask scheduler, such as ``'tcp://host:8786'``, used instead of processes.
    blocks : str or path, optional
        Folder in which finished flights are kept, so that the same call resumes an interrupted
        one. It is not deleted at the end.
    progress : callable, optional
        Called with the fraction done, 0 to 1.

    Returns
    -------
    FilterComparison

    Raises
    ------
    ValueError
        As ``simulate_aided``; on an unknown filter; if ``blocks`` holds flights of other
        settings; if the cluster cannot be used.

    Examples
    --------
    >>> import ins_sim
    >>> settings = ins_sim.read_settings(['route_flight', 'grade_mid'],
    ...                                  {'duration_s': 20.0, 'window.cycles': 100}, aided=True)
    >>> study = ins_sim.compare_filters(settings, runs=2, filters=['free', 'eskf'], jobs=1)
    >>> [row.name for row in study.rows]
    ['free, N 100', 'eskf, N 100']
    """
    if not isinstance(settings, AidedSimulationSettings):
        raise ValueError(f'settings are {type(settings).__name__}; expected '
                         'AidedSimulationSettings of read_settings(..., aided=True)')
    check_jobs(jobs, scheduler)
    if isinstance(filters, str):
        raise ValueError(f'filters is {filters!r}; expected a list of names')
    plan = FilterPlan(settings, runs, cases_of(
        filters, list(cycles or [settings.velocity_meter.window.cycles])))
    generator = run_settings(settings, 0).simulation.motion_generator
    check_length(generator, make_motion(generator.motion, generator.datum, generator.earth))
    store = None
    if blocks is not None:
        from ins_sim.jobs.store import BlockStore
        store = BlockStore(checked_path('blocks', blocks), plan.identity())
    total = plan.flights - (store.found if store else 0)

    def went(done: int) -> None:
        if progress is not None:
            progress(done / total)

    with open_executor(jobs, scheduler) as executor:
        found = compare(plan, executor, store, went)
    rows = tuple(filter_row(case, f) for case, f in zip(found.cases, found.flown))
    return FilterComparison(settings, found, rows)
