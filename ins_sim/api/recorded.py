"""Strapdown navigation with a recorded IMU, and its result."""

from __future__ import annotations

from dataclasses import dataclass
import os
from typing import Any, TYPE_CHECKING

import numpy as np

from ins_sim import parameter_files
from ins_sim.core.postprocessing import navigate as replay
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.postprocessing.sources import Sources
from ins_sim.core.timeseries.histories import NavStates
from ins_sim.core.timeseries.named_columns import columns
from ins_sim.io import imu
from ins_sim.settings.navigate import NAVIGATE, NavigateSettings
from .dataframes import dataframe
from .datasets import track_dataset
from .inputs import checked_path, files, Name, Names, plain, Values
from .offline import Progress
from .results import Folder

if TYPE_CHECKING:
    import pandas
    import xarray

# The period of the highest rate that a node can be set to, 20 kHz.
SHORTEST_NS = 50_000


@dataclass(frozen=True, eq=False, repr=False)
class ImuRecord:
    """
    Samples of a recorded IMU as arrays, in the axes of the sensor.

    Parameters
    ----------
    t_ns : (n,) int64 array
        Time stamps in ascending order, ns.
    omega : (n, 3) array
        Angular rate, rad/s.
    f : (n, 3) array
        Specific force, m/s^2; it points up at rest.

    Raises
    ------
    ValueError
        On other shapes or types, values that are not finite, and stamps that are not in ascending
        order or have a median step below 50 us.
    """

    t_ns: np.ndarray
    omega: np.ndarray
    f: np.ndarray

    def __repr__(self) -> str:
        """Return one line, which a notebook shows."""
        return f'<ImuRecord: {len(self.t_ns)} samples>'

    def __post_init__(self) -> None:
        """Check the arrays."""
        t_ns = _array('t_ns', self.t_ns, 'whole numbers of nanoseconds')
        if t_ns.ndim != 1 or t_ns.dtype.kind not in 'iu':
            raise ValueError(f't_ns is an array of {t_ns.dtype}, shape {t_ns.shape}; expected '
                             'whole numbers of nanoseconds, int64, of shape (n,)')
        if (t_ns[1:] <= t_ns[:-1]).any():
            k = int(np.argmax(t_ns[1:] <= t_ns[:-1]))
            raise ValueError(f't_ns[{k + 1}] is {t_ns[k + 1]} after {t_ns[k]}; expected '
                             'increasing stamps')
        step_ns = float(np.median(np.diff(t_ns))) if len(t_ns) > 1 else SHORTEST_NS
        if step_ns < SHORTEST_NS:
            raise ValueError(f't_ns has a median step of {step_ns:g} ns; expected at least '
                             f'{SHORTEST_NS:g} ns: are the stamps in another unit?')
        object.__setattr__(self, 't_ns', t_ns.astype(np.int64))
        for name, unit in (('omega', 'rad/s'), ('f', 'm/s^2')):
            values = _array(name, getattr(self, name), f'numbers in {unit}')
            if values.dtype.kind not in 'fiu' or values.shape != (len(t_ns), 3):
                raise ValueError(f'{name} is an array of {values.dtype}, shape {values.shape}; '
                                 f'expected numbers in {unit} of shape ({len(t_ns)}, 3), one '
                                 'row per stamp')
            if not np.isfinite(values).all():
                k = int(np.argmin(np.isfinite(values).all(axis=1)))
                raise ValueError(f'{name}[{k}] is {values[k].tolist()}; expected finite numbers')
            object.__setattr__(self, name, values.astype(float))


def _array(name: str, values: Any, expected: str) -> np.ndarray:
    try:
        return np.asarray(values)
    except ValueError:
        raise ValueError(f'{name} has rows of different lengths; expected {expected}') from None


@dataclass(frozen=True, eq=False, repr=False)
class Navigation:
    """
    Solution of the strapdown navigation with a recorded IMU.

    Attributes
    ----------
    settings : NavigateSettings
    name : str
        Name of the recording.
    result : NavigationResult
        The arrays; the properties below give its fields.
    """

    settings: NavigateSettings
    name: str
    result: replay.NavigationResult

    def __repr__(self) -> str:
        """Return one line, which a notebook shows."""
        return (f'<Navigation: {self.name}, {len(self.segments)} segments, compared with '
                f'{len(self.comparisons)} references>')

    @property
    def segments(self) -> list[NavStates]:
        """Solution: one NavStates for each segment between gaps."""
        return self.result.states

    @property
    def comparisons(self) -> list[Any]:
        """Solution minus reference: one Comparison for each reference."""
        return self.result.comparisons

    @property
    def notes(self) -> list[str]:
        """Sentences about the recording and how it was processed."""
        return self.result.notes

    @property
    def figures(self) -> dict[str, Any]:
        """Figures of the alignment and of the comparisons, by name."""
        return self.result.figures

    def to_dataframe(self, record: str = 'states', reference: int = 0) -> pandas.DataFrame:
        """
        Return the solution, or one of its errors, as a DataFrame.

        Parameters
        ----------
        record : {'states', 'position', 'velocity', 'attitude'}
            The solution, or its error at the stamps of a reference.
        reference : int, optional
            Index into ``comparisons``.

        Returns
        -------
        pandas.DataFrame
            The index ``t_ns`` is the stamp of the recording in whole nanoseconds. The columns
            are named by field, component and unit: ``position_north_m``.

        Raises
        ------
        ImportError
            If pandas is not installed.
        ValueError
            If there is no such record or reference.
        """
        t_ns, fields = self._record(record, reference)
        table: dict[str, np.ndarray] = {}
        for field, values in fields.items():
            table.update(columns(field, values))
        return dataframe(t_ns, table)

    def to_xarray(self, record: str = 'states', reference: int = 0) -> xarray.Dataset:
        """
        Return the solution, or one of its errors, as a Dataset.

        Parameters
        ----------
        record, reference
            As in ``to_dataframe``.

        Returns
        -------
        xarray.Dataset
            The dimensions are ``time``, the stamps of the recording in whole nanoseconds, and
            ``axis`` (east, north, up) or ``quaternion`` (x, y, z, w). The attribute ``units`` of
            a variable holds its unit.

        Raises
        ------
        ImportError
            If xarray is not installed.
        ValueError
            If there is no such record or reference.
        """
        return track_dataset(*self._record(record, reference), {'record': record})

    def _record(self, record: str, reference: int) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Return the stamps and the fields of a record."""
        if record == 'states':
            fields = NavStates.concatenate(self.segments).arrays()
            return fields.pop('t_ns'), fields
        if record not in ('position', 'velocity', 'attitude'):
            raise ValueError(f'record is {record!r}; expected one of states, position, velocity, '
                             'attitude')
        if not 0 <= reference < len(self.comparisons):
            raise ValueError(f'reference is {reference}; the navigation was compared with '
                             f'{len(self.comparisons)} references')
        comparison = self.comparisons[reference]
        track = getattr(comparison, record)
        if track is None:
            raise ValueError(f'{comparison.name} has no {record}; expected another record')
        return track.t_ns, {record: track.values}

    def save(self, folder: Folder, overwrite: bool = False, *, csv: bool = False,
             tum: bool = False) -> None:
        """
        Write the solution into a folder, as ``ins_sim navigate -o``.

        Parameters
        ----------
        folder : str or path
            It is created when it is complete, with nav.npz, parameters.yaml, summary.json and
            navigation.png.
        overwrite : bool, optional
            Replace the folder if it holds a navigation.
        csv : bool, optional
            Also write the solution and its errors as CSV tables.
        tum : bool, optional
            Also write the solution as a TUM file for evo, in the plane tangent to the Earth at
            its first position.

        Raises
        ------
        ValueError
            If the folder exists and must not be replaced, or does not hold a navigation.
        """
        from ins_sim.own_folders.own_folder import whole_folder
        from ins_sim.report import navigation
        with whole_folder(checked_path('folder', folder), overwrite, navigation.MARK,
                          'overwrite=True') as work:
            navigation.write_navigation(work, self.settings, self.name, self.result, csv, tum)


def navigate(source: Name | ImuRecord, values: Values | None = None, names: Names = (),
             progress: Progress = None) -> Navigation:
    """
    Navigate with a recorded IMU, and compare the solution with references if there are any.

    Parameters
    ----------
    source : str, path or ImuRecord
        A rosbag2 bag, a CSV file, or arrays.
    values : mapping, optional
        Values of the parameters of ``navigate`` by name, such as ``{'initial.heading': 'given',
        'initial.heading_deg': 90.0, 'reference.path': 'track.csv'}``.
    names : str, path, or a list of these, optional
        Parameter files with a section ``navigate``.
    progress : callable, optional
        Called with the fraction done, 0 to 1.

    Returns
    -------
    Navigation

    Raises
    ------
    ValueError
        If the parameters or the recording cannot be used.
    FileNotFoundError
        If the recording does not exist.

    Examples
    --------
    Half a minute at rest at 45 degrees north, with the attitude given:

    >>> import ins_sim, numpy as np
    >>> t_ns = 10_000_000 * np.arange(3000)
    >>> omega = np.tile([0.0, 5.16e-5, 5.16e-5], (3000, 1))
    >>> f = np.tile([0.0, 0.0, 9.806], (3000, 1))
    >>> start = {'initial.position': 'given', 'initial.latitude_deg': 45.0,
    ...          'initial.attitude': 'given', 'initial.heading_deg': 90.0,
    ...          'initial.velocity': 'given'}
    >>> result = ins_sim.navigate(ins_sim.ImuRecord(t_ns, omega, f), start)
    >>> len(result.segments)
    1
    """
    settings = parameter_files.read_nodes(files(names), plain(values), NAVIGATE)['navigate']
    if isinstance(source, ImuRecord):
        unknown = np.full((len(source.t_ns), 4), np.nan)
        recorded = RecordedImu(source.t_ns, source.omega, source.f, unknown)
        sources = imu.with_reference(Sources('ImuRecord', recorded, 'imu'), settings)
    elif isinstance(source, (str, os.PathLike)):
        sources = imu.read_imu(source, settings)
    else:
        raise ValueError(f'source is {type(source).__name__}; expected the path of a bag or a CSV '
                         'file, or an ImuRecord')
    return Navigation(settings, sources.name, replay.navigate(settings, sources, progress))
