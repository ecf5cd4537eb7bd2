"""Results of the simulations: arrays, DataFrames and Datasets, and a folder on disk."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
import os
from typing import Any, TYPE_CHECKING, Union

from ins_sim.core.motion.motion import Motion
from ins_sim.core.prediction.drift import NoPrediction
from ins_sim.core.prediction.predict import predict
from ins_sim.core.simulation.aided_run import AidedResult
from ins_sim.core.simulation.guided_flight import GuidedResult
from ins_sim.core.simulation.inertial import SimulationResult
from ins_sim.core.timeseries.fixes import GnssFix, VelocityFix
from ins_sim.core.timeseries.histories import (AidedErrors, History, ImuSamples, NavErrors,
                                               NavStates, Truth)
from ins_sim.settings.simulation import AidedSimulationSettings, SimulationSettings
from .dataframes import chosen, history_dataframe
from .datasets import history_dataset
from .inputs import checked_path

if TYPE_CHECKING:
    import pandas
    import xarray

Folder = Union[str, 'os.PathLike[str]']


@dataclass(frozen=True, eq=False, repr=False)
class Run:
    """
    Result of a simulation of motion, IMU and strapdown.

    Attributes
    ----------
    settings : SimulationSettings
    motion : Motion
        The motion that was simulated.
    result : SimulationResult
        All arrays; the properties below give its fields.
    own_motion : bool
        Whether the motion was given as an object, so that the settings do not describe it.
    steered : GuidedResult
        Steering of a guided motion: ``estimates`` and ``states`` at the control instants. None
        for any other motion.
    """

    settings: SimulationSettings
    motion: Motion
    result: SimulationResult
    own_motion: bool = False
    steered: GuidedResult | None = None

    def __repr__(self) -> str:
        """Return one line, which a notebook shows."""
        return f'<Run: {_length(self.states)}>'

    @property
    def truth(self) -> Truth:
        """True motion at the output instants (n,)."""
        return self.result.truth

    @property
    def imu(self) -> ImuSamples:
        """All IMU samples in body axes: rad/s and m/s^2."""
        return self.result.imu

    @property
    def states(self) -> NavStates:
        """Strapdown solution at the output instants (n,)."""
        return self.result.states

    @property
    def errors(self) -> NavErrors:
        """Solution minus truth at the output instants: East, North, Up; rad, m/s, m, rad/s."""
        return self.result.errors

    @property
    def twin(self) -> NavErrors | None:
        """Errors of the same run without delays; None if it was not simulated."""
        return self.result.twin

    @property
    def faults(self) -> tuple[str, ...]:
        """One sentence for each gap at which the strapdown started again."""
        return self.result.faults

    def to_dataframe(self, record: str = 'errors') -> pandas.DataFrame:
        """
        Return one record as a DataFrame.

        Parameters
        ----------
        record : {'errors', 'states', 'truth', 'imu', 'twin'}

        Returns
        -------
        pandas.DataFrame
            The index ``t_ns`` is motion time in whole nanoseconds, so that records can be joined
            exactly. The columns are named by field, component and unit: ``position_north_m``.

        Raises
        ------
        ImportError
            If pandas is not installed.
        ValueError
            If the run has no such record.
        """
        return history_dataframe(self._record(record))

    def to_xarray(self, record: str = 'errors') -> xarray.Dataset:
        """
        Return one record as a Dataset.

        Parameters
        ----------
        record : {'errors', 'states', 'truth', 'imu', 'twin'}

        Returns
        -------
        xarray.Dataset
            The dimensions are ``time`` (motion time in whole nanoseconds) and, for vectors,
            ``axis`` (east, north, up), ``body_axis`` (x, y, z) or ``quaternion`` (x, y, z, w), so
            that records can be merged. The attribute ``units`` of a variable holds its unit.

        Raises
        ------
        ImportError
            If xarray is not installed.
        ValueError
            If the run has no such record.
        """
        return history_dataset(self._record(record), {'record': record})

    def _record(self, record: str) -> History:
        names = ('errors', 'states', 'truth', 'imu', 'twin')
        return chosen({name: getattr(self, name) for name in names}, record)

    def save(self, folder: Folder, overwrite: bool = False, *, thin: int = 1, csv: bool = False,
             tum: bool = False) -> None:
        """
        Write the run into a folder, as ``ins_sim simulate -o``.

        The folder is created when it is complete. It holds run.npz, parameters.yaml,
        manifest.yaml, summary.json, the figures as PNG, report.html and, if the vehicle moves,
        track.kml. A motion of your own is in the arrays but not in parameters.yaml.

        Parameters
        ----------
        folder : str or path
        overwrite : bool, optional
            Replace the folder if it holds a run.
        thin : int, optional
            Write only every thin-th output instant of truth, solution and errors; all IMU samples
            are written.
        csv : bool, optional
            Also write a CSV table of each record, with the columns of ``to_dataframe``.
        tum : bool, optional
            Also write the trajectories in the map frame as TUM files, for evo.

        Raises
        ------
        ValueError
            If the folder exists and must not be replaced, or does not hold a run.
        """
        self._write(folder, overwrite, None, (thin, csv, tum))

    def _write(self, folder: Folder, overwrite: bool, report: Any,
               files: tuple[int, bool, bool]) -> None:
        from ins_sim.own_folders.own_folder import existing_parent, whole_folder
        from ins_sim.report import guided, storage, summary, titles
        from ins_sim.report.files.wanted import WantedFiles
        from ins_sim.report.runs.page import run_notes
        from ins_sim.report.spool import Spool
        wanted = WantedFiles(*files)
        checked_path('folder', folder)
        with Spool(existing_parent(folder)) as spool, whole_folder(
                folder, overwrite, storage.MARK, 'overwrite=True') as work:
            try:
                prediction = predict(self.settings, self.motion, spool.store)
            except NoPrediction:
                prediction = None
            title = titles.title(self.settings)
            rows = summary.summary_rows(self.settings, self.errors, self.twin, prediction)
            if self.own_motion:
                # Published figures belong to the motion of the settings.
                rows = [replace(row, published=None) for row in rows]
                title = f'{type(self.motion).__name__} given as an object'
            storage.write_run(work, self.settings, self.result,
                              [*rows, *guided.guided_rows(self.steered)], prediction, title,
                              report, self.own_motion, self.steered,
                              run_notes(self.settings, self.result, prediction, self.steered),
                              wanted)


@dataclass(frozen=True, eq=False, repr=False)
class AidedRun:
    """
    Result of a simulation with velocity meter, GNSS and the aided navigator.

    Attributes
    ----------
    settings : AidedSimulationSettings
    run : Run
        The unaided part: IMU, strapdown and its errors.
    result : AidedResult
        The arrays of the aided navigator; the properties below give its fields.
    """

    settings: AidedSimulationSettings
    run: Run
    result: AidedResult

    def __repr__(self) -> str:
        """Return one line, which a notebook shows."""
        name = self.settings.aided_navigator.filter
        return (f'<AidedRun: filter {name}, {_length(self.states)}, {len(self.velocity_fixes)} '
                f'velocity and {len(self.gnss_fixes)} GNSS fixes>')

    @property
    def truth(self) -> Truth:
        """True motion at the output instants of the aided navigator (n,)."""
        return self.result.truth

    @property
    def states(self) -> NavStates:
        """Aided solution (n,)."""
        return self.result.states

    @property
    def errors(self) -> AidedErrors:
        """Aided solution minus truth and its standard deviations, (n, 3): East, North, Up."""
        return self.result.errors

    @property
    def judged(self) -> Sequence[Any]:
        """One JudgedFix for each fix, in the order of arrival: whether it was used, and why."""
        return self.result.judged

    @property
    def velocity_fixes(self) -> Sequence[VelocityFix]:
        """Fixes of the velocity meter."""
        return self.result.velocity_fixes

    @property
    def gnss_fixes(self) -> Sequence[GnssFix]:
        """GNSS fixes."""
        return self.result.gnss_fixes

    @property
    def faults(self) -> tuple[str, ...]:
        """One sentence for each fault at which the navigator started again or dropped a fix."""
        return self.result.faults

    def to_dataframe(self, record: str = 'errors') -> pandas.DataFrame:
        """
        Return one record as a DataFrame, as ``Run.to_dataframe`` does.

        Parameters
        ----------
        record : {'errors', 'states', 'truth'}
            For records of the unaided part use ``run.to_dataframe``.
        """
        return history_dataframe(self._record(record))

    def to_xarray(self, record: str = 'errors') -> xarray.Dataset:
        """
        Return one record as a Dataset, as ``Run.to_xarray`` does.

        Parameters
        ----------
        record : {'errors', 'states', 'truth'}
            ``estimates`` in errors has the dimension ``estimate``. For records of the unaided
            part use ``run.to_xarray``.
        """
        return history_dataset(self._record(record), {'record': record})

    def _record(self, record: str) -> History:
        names = ('errors', 'states', 'truth')
        return chosen({name: getattr(self, name) for name in names}, record)

    def save(self, folder: Folder, overwrite: bool = False, *, thin: int = 1, csv: bool = False,
             tum: bool = False) -> None:
        """Write the run into a folder, as ``ins_sim simulate --aided -o``; see ``Run.save``."""
        from ins_sim.report import aided
        rows = aided.aided_rows(self.settings, self.result, self.run.states, self.run.errors)
        self.run._write(folder, overwrite, aided.AidedReport(self.settings, self.result, rows),
                        (thin, csv, tum))


def _length(states: NavStates) -> str:
    first, last = states.t_ns[0] * 1e-9, states.t_ns[-1] * 1e-9
    return f'{len(states.t_ns)} instants from {first:.6g} to {last:.6g} s'
