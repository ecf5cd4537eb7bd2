"""Estimation of delays and other errors of gyro channels from readings under a known motion."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
import os
from pathlib import Path
from typing import Any, TYPE_CHECKING, Union

import numpy as np

from ins_sim import parameter_files
from ins_sim.core.calibration.bench_record import BenchRecord
from ins_sim.core.calibration.channel_sums import BIAS, LAST, NEXT, SCALE
from ins_sim.core.calibration.delays import TriadEstimate
from ins_sim.core.calibration.model_lag import estimate_with_lag
from ins_sim.io import bench
from ins_sim.report import storage
from ins_sim.report.studies import delay_estimate
from ins_sim.settings.by_node import ALL_NODES, NODES
from ins_sim.settings.instrument_errors import GyroErrors
from ins_sim.settings.recorded_imu import CONVERT
from ins_sim.settings.simulation import SimulationSettings
from .datasets import dataset
from .inputs import checked_path, files, Name, Names, plain, Values
from .results import Run

if TYPE_CHECKING:
    import pandas
    import xarray

Source = Union[Name, Run]
AXES = ['x', 'y', 'z']


@dataclass(frozen=True, eq=False, repr=False)
class DelayEstimate:
    """
    Delays and other errors of three gyro channels.

    Attributes
    ----------
    triad : TriadEstimate
        All estimates; the properties below give the delays.
    notes : tuple of str
        Sentences about assumptions, omitted data and values that cannot be determined.
    """

    triad: TriadEstimate
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        """Return one line, which a notebook shows."""
        return f'<DelayEstimate: {delay_estimate.answer(self.triad)}>'

    @property
    def delays(self) -> np.ndarray:
        """Sum of delay and lag of x, y, z, s, (3,); NaN if it is not observable."""
        return np.array([np.nan if c.refused else c.delay for c in self.triad.channels])

    @property
    def delay_sigmas(self) -> np.ndarray:
        """Standard deviations of the delays, s, (3,)."""
        return np.array([c.delay_sigma for c in self.triad.channels])

    @property
    def lags(self) -> np.ndarray:
        """Part of the delays that the bandwidth causes according to its model, s, (3,)."""
        return np.zeros(3) if self.triad.lags is None else self.triad.lags

    def to_dataframe(self) -> pandas.DataFrame:
        """
        Return the estimates as a DataFrame, one row for each value.

        Returns
        -------
        pandas.DataFrame
            Columns ``axis``, ``name``, ``unit``, ``value``, ``sigma`` and ``told``. ``told`` is
            true if the record determines the value; otherwise sigma is close to the a-priori one.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        try:
            import pandas
        except ImportError:
            raise ImportError("to_dataframe needs pandas; expected pip install 'ins_sim"
                              "[dataframe]'") from None
        table: pandas.DataFrame = pandas.DataFrame(
            [(r.axis, r.name, r.unit, r.value, r.sigma, r.told)
             for r in delay_estimate.found_values(self.triad)],
            columns=['axis', 'name', 'unit', 'value', 'sigma', 'told'])
        return table

    def to_xarray(self) -> xarray.Dataset:
        """
        Return the estimates as a Dataset, in SI and radians.

        Returns
        -------
        xarray.Dataset
            ``delay``, ``lag`` and ``scale_factor`` (body_axis), ``misalignment`` (body_axis,
            towards), ``bias`` (body_axis, record); all but ``lag`` with their standard
            deviations, such as ``delay_sigma``.

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        turned, turned_sigma = np.zeros((3, 3)), np.zeros((3, 3))
        for k, channel in enumerate(self.triad.channels):
            for place, axis in zip((NEXT, LAST), channel.towards):
                turned[k, AXES.index(axis)] = channel.values[place]
                turned_sigma[k, AXES.index(axis)] = channel.sigmas[place]
        values = np.array([c.values for c in self.triad.channels])
        sigmas = np.array([c.sigmas for c in self.triad.channels])
        variables: dict[str, tuple[Sequence[str], np.ndarray, str]] = {
            'delay': (['body_axis'], self.delays, 's'),
            'delay_sigma': (['body_axis'], self.delay_sigmas, 's'),
            'lag': (['body_axis'], self.lags, 's'),
            'misalignment': (['body_axis', 'towards'], turned, 'rad'),
            'misalignment_sigma': (['body_axis', 'towards'], turned_sigma, 'rad')}
        for name, array in (('', values), ('_sigma', sigmas)):
            variables[f'scale_factor{name}'] = ['body_axis'], array[:, SCALE], ''
            variables[f'bias{name}'] = ['body_axis', 'record'], array[:, BIAS:], 'rad/s'
        return dataset({'body_axis': (AXES, ''), 'towards': (AXES, ''),
                        'record': (list(self.triad.records), '')}, variables)


def estimate_delays(sources: Source | Sequence[Source], values: Values | None = None,
                    names: Names = (), topic: str | None = None) -> DelayEstimate:
    """
    Estimate delays, biases, scale factors and misalignments of gyros under a known motion.

    Parameters
    ----------
    sources : Run, path, or a sequence of these
        Runs of ``simulate``, folders of such runs, bags with Imu messages, or CSV files of an IMU.
        All are records of one instrument; each has its own bias.
    values : mapping, optional
        Values of parameters by name, such as the motion of the bench,
        ``{'motion.kind': 'rocking'}``, and the noise of the gyros. If no motion is given, that of
        the run or the truth in the bag is used.
    names : str, path, or a list of these, optional
        Parameter files; ``values`` override them.
    topic : str, optional
        Topic of the Imu messages in a bag, if it has more than one.

    Returns
    -------
    DelayEstimate

    Raises
    ------
    ValueError
        If a record cannot be used or does not fit the motion, or if the motion does not show the
        delay of any channel.
    FileNotFoundError
        If a record does not exist.

    Examples
    --------
    >>> import ins_sim
    >>> settings = ins_sim.read_settings('imu_tactical_fog', {
    ...     'motion.kind': 'rocking', 'motion.psi_deg': 35.264, 'motion.theta_deg': -45.0,
    ...     'gyro.delay_us.y': 5.0, 'duration_s': 60.0})
    >>> found = ins_sim.estimate_delays(ins_sim.simulate(settings, twin=False))
    >>> bool(abs(1e6 * (found.delays - found.lags)[1] - 5.0) < 4e6 * found.delay_sigmas[1])
    True
    """
    one = isinstance(sources, (str, os.PathLike, Run))
    if not one and not isinstance(sources, Iterable):
        raise ValueError(f'sources is {type(sources).__name__}; expected a Run, a path, or a '
                         'sequence of these')
    listed: list[Any] = [sources] if one else list(sources)  # type: ignore[arg-type]
    if not listed:
        raise ValueError('sources is empty; expected at least one Run or path')
    records: list[BenchRecord] = []
    notes: list[str] = []
    errors: list[GyroErrors] = []
    for k, source in enumerate(listed):
        record, said, settings = _record(source, k, values, names, topic)
        records.append(record)
        notes += said
        errors.append(settings.imu_sensor.gyro.errors)
    triad = estimate_with_lag(records, errors[0])
    return DelayEstimate(triad, (*dict.fromkeys(notes), *delay_estimate.sentences(triad)))


def _record(source: Any, place: int, values: Values | None, names: Names,
            topic: str | None) -> tuple[BenchRecord, Sequence[str], SimulationSettings]:
    if isinstance(source, Run):
        record, notes = bench.record_of_run(f'run {place + 1}', source.settings, source.imu,
                                            source.motion)
        return record, notes, source.settings
    folder = Path(checked_path('sources', source))
    given = files(names)
    if (folder / storage.ARRAYS).is_file():
        settings = parameter_files.read([folder / storage.PARAMETERS, *given], plain(values))
        imu = delay_estimate.read_bench_run(folder)
        record, notes = bench.record_of_run(folder.name, settings, imu)
        return record, notes, settings
    built = parameter_files.read_nodes(given, plain(values), {**NODES, **CONVERT},
                                       {**ALL_NODES, **CONVERT})
    settings = SimulationSettings(**{node: built[node] for node in NODES})
    record, notes = bench.read_record(folder, settings, built['convert'], list(values or {}),
                                      topic)
    return record, notes, settings
