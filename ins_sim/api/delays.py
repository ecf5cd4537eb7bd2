"""Study of gyro channel delays (Bogdanov and Fomichev 2018), and its result."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
import os
from typing import Any, TYPE_CHECKING

import numpy as np

from ins_sim import parameter_files, resources
from ins_sim.core.timeseries.named_columns import BODY, ENU
from ins_sim.io.motion import read_motion
from ins_sim.jobs.blocks import run_blocks
from ins_sim.jobs.executors import open_executor
from ins_sim.studies.delays.figure import (make_figures, RECORDED, recorded_name, RECORDING_PATH,
                                           SHIPPED)
from ins_sim.studies.delays.maps import RatesMap, RockingMap
from ins_sim.studies.delays.study import distinct_runs, FigureResult, fly_task, gather
from .dataframes import dataframe
from .datasets import dataset
from .inputs import checked_path, files, Names, plain, Values
from .results import Folder

if TYPE_CHECKING:
    import pandas
    import xarray


@dataclass(frozen=True, eq=False, repr=False)
class DelayStudy:
    """
    Results of the study of gyro channel delays, by figure.

    Attributes
    ----------
    results : tuple of FigureResult
        For each figure its settings (``figure``), its runs (``runs``: errors, prediction and
        zero-delay twin) and its map (``map``), in SI units and radians.
    """

    results: tuple[FigureResult, ...]

    def __repr__(self) -> str:
        """Return one line, which a notebook shows."""
        return f'<DelayStudy: {", ".join(self.names)}>'

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the figures."""
        return tuple(result.figure.name for result in self.results)

    def result(self, name: str) -> FigureResult:
        """Return the FigureResult with a name; raise ValueError if there is no such figure."""
        for result in self.results:
            if result.figure.name == name:
                return result
        raise ValueError(f'name is {name!r}; expected one of {", ".join(self.names)}')

    def to_dataframe(self, name: str) -> pandas.DataFrame:
        """
        Return the curves of a figure, or the cells of its map, as a DataFrame.

        Parameters
        ----------
        name : str
            One of ``names``.

        Returns
        -------
        pandas.DataFrame
            The columns of the CSV file of the figure; the first one is the index.

        Raises
        ------
        ImportError
            If pandas is not installed.
        ValueError
            If there is no such figure.
        """
        from ins_sim.report.studies.delay_data import figure_tables
        columns = dict(figure_tables(self.result(name))[name])
        first = next(iter(columns))
        frame = dataframe(columns.pop(first), columns)
        frame.index.name = first
        return frame

    def to_xarray(self, name: str) -> xarray.Dataset:
        """
        Return a figure as a Dataset.

        Parameters
        ----------
        name : str
            One of ``names``.

        Returns
        -------
        xarray.Dataset
            The dimensions are run, time and axis for errors of runs, and the axes of the map for
            a map. Units are SI and radians, except the axes of the rocking map, in degrees.

        Raises
        ------
        ImportError
            If xarray is not installed.
        ValueError
            If there is no such figure.
        """
        result = self.result(name)
        if isinstance(result.map, RatesMap):
            return dataset({'gamma_rate': (result.map.gamma_rates, 'rad/s'),
                            'psi_rate': (result.map.psi_rates, 'rad/s')},
                           {'drift': (('gamma_rate', 'psi_rate'), result.map.largest, 'rad/s')})
        if isinstance(result.map, RockingMap):
            return dataset({'elevation': (result.map.elevation_deg, 'deg'),
                            'azimuth': (result.map.azimuth_deg, 'deg'),
                            'psi': (result.map.psi_deg, 'deg'), 'axis': (ENU, '')},
                           {'size': (('elevation', 'azimuth'), result.map.size, 'rad/s'),
                            'drift': (('psi', 'axis'), result.map.drift, 'rad/s')})
        return _runs_dataset(result)

    def save(self, folder: Folder, overwrite: bool = False) -> None:
        """
        Write the report and its data into a folder, as ``ins_sim delay-study -o``.

        Parameters
        ----------
        folder : str or path
        overwrite : bool, optional
            Replace the folder if it holds such a study.

        Raises
        ------
        ValueError
            If the folder exists and must not be replaced, or holds something else.
        """
        from ins_sim.own_folders.own_folder import whole_folder
        from ins_sim.report.studies.delay_folder import MARK, write_study
        checked_path('folder', folder)
        with whole_folder(folder, overwrite, MARK, 'overwrite=True') as work:
            write_study(work, self.results)


def delay_study(names: Names = SHIPPED, values: Values | None = None,
                recordings: Names = (), jobs: int = 0) -> DelayStudy:
    """
    Repeat the study of gyro channel delays of Bogdanov and Fomichev (2018).

    See docs/how_to/delay_study.md. All default figures take half a minute on two cores.

    Parameters
    ----------
    names : str, path, or a list of these, optional
        Parameter files, one for each figure: names of shipped ones, or paths. By default the nine
        figures of the command ``delay-study``; ``()`` for recordings alone.
    values : mapping, optional
        Values of parameters by name, for all figures; they override the files.
    recordings : str, path, or a list of these, optional
        Recorded flights (CSV files or bags). Each adds a figure.
    jobs : int, optional
        Number of processes; 0: one for each core; 1: this process alone.

    Returns
    -------
    DelayStudy

    Raises
    ------
    ValueError
        If a parameter does not exist or does not fit a figure, or a recording cannot be used.
    FileNotFoundError
        If a file does not exist.

    Examples
    --------
    >>> import ins_sim
    >>> study = ins_sim.delay_study('delay_study_rates', {'duration_s': 60.0,
    ...                             'detunings_rad_s': [0.0]}, jobs=1)
    >>> study.result('delay_study_rates').map.lines
    (-2, 2)
    """
    given: dict[str, Any] = plain(values)
    sources = [(path.stem, path, given) for path in files(names)]
    paths = [recordings] if isinstance(recordings, (str, os.PathLike)) else recordings
    if not isinstance(paths, Iterable):
        raise ValueError(f'recordings is {recordings!r}; expected a path or a list of paths')
    for path in paths:
        name = os.fspath(checked_path('recordings', path))
        sources.append((recorded_name(name), resources.config(RECORDED),
                        {**given, RECORDING_PATH: name}))
    if not sources:
        raise ValueError('names and recordings are empty; expected at least one figure')
    figures = make_figures(sources, parameter_files.read_nodes, read_motion)
    with open_executor(jobs) as executor:
        flown = [run for _, run in run_blocks(fly_task, distinct_runs(figures), executor)]
    return DelayStudy(gather(figures, flown))


def _runs_dataset(result: FigureResult) -> xarray.Dataset:
    """Return the Dataset of the errors of the runs of a figure."""
    from ins_sim.report.studies.delay_names import short_run_name
    runs = result.runs
    coords: dict[str, tuple[Any, str]] = {
        'run': ([short_run_name(run.settings) for run in runs], ''),
        'time': (runs[0].t_s, 's'), 'axis': (ENU, ''),
        'coordinate': (('latitude', 'longitude'), '')}
    over = ('run', 'time')
    variables: dict[str, tuple[tuple[str, ...], np.ndarray, str]] = {
        'position': ((*over, 'axis'), np.stack([run.apart for run in runs]), 'm'),
        'predicted_position': ((*over, 'axis'), np.stack([run.predicted for run in runs]), 'm'),
        'angles': ((*over, 'coordinate'), np.stack([run.angles for run in runs]), 'rad'),
        'predicted_angles': ((*over, 'coordinate'),
                             np.stack([run.predicted_angles for run in runs]), 'rad')}
    if result.figure.shows.figure == 'flight':
        coords['body_axis'] = BODY, ''
        coords['level_axis'] = ENU[:2], ''
        variables['position_per_delay'] = (
            (*over, 'level_axis', 'body_axis'),
            np.stack([run.sensitivity.position for run in runs if run.sensitivity]), 'm/s')
    return dataset(coords, variables)
