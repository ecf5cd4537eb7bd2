"""Error budget of a strapdown by linear covariance, and its result."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
import os
from typing import Any, TYPE_CHECKING, Union

import numpy as np

from ins_sim.core.prediction.budget.linear_budget import error_budget, LinearBudget, SAME_S
from ins_sim.core.motion.motion import Motion
from ins_sim.core.timeseries.named_columns import ENU
from ins_sim.report.studies.budget_beside import read_study
from ins_sim.settings.simulation import SimulationSettings
from ins_sim.studies.budget.beside import (BesideRuns, compared, ComparedQuantity,
                                           fly_beside)
from ins_sim.studies.budget.quantities import linear_until, Quantity, QUANTITIES, shares
from ins_sim.studies.budget.requirement import (answer, parse_requirement, RequirementAnswer,
                                                times_of)
from ins_sim.studies.budget.sensitivities import sensitivities, Sensitivity
from ins_sim.studies.error_circle import error_circle
from .dataframes import dataframe
from .datasets import dataset
from .inputs import checked_path
from .offline import check_settings, given_motion

if TYPE_CHECKING:
    import pandas
    import xarray

Folder = Union[str, 'os.PathLike[str]']


def budget(settings: SimulationSettings, times_s: Iterable[float] = (), runs: int = 0,
           motion: Motion | None = None, beside: Folder | None = None) -> ErrorBudget:
    """
    Return the error budget of a strapdown: the contribution of each error source.

    Propagates each error of the settings by linear covariance along the motion of an unaided
    strapdown; nothing is simulated unless ``runs`` are asked for (docs/how_to/error_budget.md;
    docs/theory/error_budget.md).

    Parameters
    ----------
    settings : SimulationSettings
        From ``read_settings``.
    times_s : iterable of float, optional
        Times since the start of the navigation, s, at which the budget is computed in addition to
        its 361 evenly spaced times.
    runs : int, optional
        Number of runs to simulate for a comparison; 0 or at least 2.
    motion : Motion, optional
        A motion of your own, used instead of the one in the settings.
    beside : str or path, optional
        Folder of a study of ``monte_carlo`` with the same settings, for a comparison.

    Returns
    -------
    ErrorBudget

    Raises
    ------
    ValueError
        If the settings describe no run of finite length or no valid motion, if a time lies outside
        of the run, if the instrument or the motion is not covered (tuned gyros, guided motions),
        or if both ``runs`` and ``beside`` are given.

    Examples
    --------
    >>> import ins_sim
    >>> settings = ins_sim.read_settings(['racetrack', 'imu_tactical_fog'])
    >>> found = ins_sim.budget(settings)
    >>> f'{found.rms()[-1] / 1000.0:.2f} km after an hour'
    '9.66 km after an hour'
    >>> found.ranked()[0].label
    'gyro turn-on bias'
    >>> answer = found.requirement('horizontal rms 7408 m at 3600 s')
    >>> f'{answer.alone[0].values[0]:.3f} {answer.alone[0].source.unit}'
    '0.683 deg/h'
    """
    check_settings(settings, SimulationSettings)
    flown = given_motion(settings, motion)
    linear = error_budget(settings, flown, tuple(times_s))
    others: BesideRuns | None = None
    if beside is not None:
        if runs:
            raise ValueError(f'runs is {runs!r} and beside {os.fspath(beside)!r}; expected one '
                             'of them')
        others = read_study(checked_path('beside', beside), settings)
    elif runs:
        others = fly_beside(settings, flown, linear, runs)
    return ErrorBudget(settings, flown, linear, others)


@dataclass(frozen=True, eq=False, repr=False)
class ErrorBudget:
    """
    The error budget of an unaided strapdown along a motion.

    Attributes
    ----------
    settings : SimulationSettings
    motion : Motion
    linear : LinearBudget
        Covariances and mean errors by source: position, velocity and attitude, East, North, Up.
    beside : BesideRuns
        The simulated runs to compare with, or None.
    """

    settings: SimulationSettings
    motion: Motion
    linear: LinearBudget
    beside: BesideRuns | None

    def __repr__(self) -> str:
        """Return one line, which a notebook shows."""
        return (f'<ErrorBudget: {len(self.sources)} sources, {self.rms()[-1]:.4g} m horizontally '
                f'after {self.t_s[-1]:g} s>')

    @property
    def t_s(self) -> np.ndarray:
        """Times since the start of the navigation, s, (n,)."""
        return self.linear.t_s

    @property
    def sources(self) -> tuple[Any, ...]:
        """The ErrorSources: those that differ from run to run, then the fixed ones."""
        return (*self.linear.random, *self.linear.fixed)

    def rms(self, quantity: str = 'horizontal') -> np.ndarray:
        """
        Return the root mean square of a quantity over time.

        Parameters
        ----------
        quantity : {'horizontal', 'east', 'north', 'up', 'velocity', 'tilt', 'azimuth'}

        Returns
        -------
        (n,) array
            At the times ``t_s``, in m, m/s or rad.
        """
        found: np.ndarray = shares(self.linear, _quantity(quantity)).rms
        return found

    def error_circle(self, part: float = 0.5) -> np.ndarray:
        """
        Return the radius of the circle that contains a fraction of the horizontal errors.

        Parameters
        ----------
        part : float
            Fraction between 0 and 1: 0.5 for CEP50, 0.95 for CEP95.

        Returns
        -------
        (n,) array
            Radius at the times ``t_s``, m.
        """
        if not 0.0 < part < 1.0:
            raise ValueError(f'part is {part!r}; expected a number between 0 and 1, such as 0.5')
        radius: np.ndarray = error_circle(self.linear.total_mean()[:, :2],
                                          self.linear.total_covariance()[:, :2, :2], part)
        return radius

    def contributions(self, quantity: str = 'horizontal') -> dict[str, np.ndarray]:
        """
        Return the error that each source causes alone.

        Returns
        -------
        dict of {str: (n,) array}
            By the name of the parameter, in m, m/s or rad: the standard deviation for a source
            that differs from run to run, the magnitude of the error for a fixed one.
        """
        found = shares(self.linear, _quantity(quantity)).contributions()
        return {source.key: row for source, row in zip(self.sources, found)}

    def ranked(self, quantity: str = 'horizontal', t_s: float | None = None) -> list[Any]:
        """
        Return the error sources in descending order of their contribution at a time.

        Parameters: quantity, see ``rms``; one of the times ``t_s``, s, by default the last.
        """
        k = len(self.t_s) - 1 if t_s is None else self.linear.at(t_s)
        made = shares(self.linear, _quantity(quantity)).contributions()[:, k]
        return [self.sources[i] for i in np.argsort(-made, kind='stable')]

    def sensitivities(self, quantity: str = 'horizontal',
                      t_s: float | None = None) -> list[Sensitivity]:
        """
        Return the derivatives of a quantity with respect to the parameters at a time.

        Parameters: quantity, see ``rms``; one of the times ``t_s``, s, by default the last.
        """
        k = len(self.t_s) - 1 if t_s is None else self.linear.at(t_s)
        found: list[Sensitivity] = sensitivities(self.linear, _quantity(quantity), k)
        return found

    def requirement(self, text: str) -> RequirementAnswer:
        """
        Return which parameters must improve, and to what values, to meet a requirement.

        Parameters
        ----------
        text : str
            Such as ``'horizontal rms 1852 m at 3600 s'`` (docs/how_to/error_budget.md). For a time
            that is not in ``t_s`` the errors are propagated again.

        Raises
        ------
        ValueError
            If the text is not a requirement, or the time lies outside of the run.
        """
        wanted, linear = parse_requirement(text), self.linear
        times = times_of([wanted], linear.t_s[-1])
        if abs(linear.t_s - wanted.t_s).min() > SAME_S:
            linear = error_budget(self.settings, self.motion, times)
        found: RequirementAnswer = answer(linear, wanted)
        return found

    def linear_until(self) -> float | None:
        """Return the time, s, after which second-order errors are not negligible, or None."""
        until: float | None = linear_until(self.linear)
        return until

    def compared(self) -> list[ComparedQuantity]:
        """Return the ratio of ensemble to budget for each quantity; empty without runs."""
        found: list[ComparedQuantity] = []
        if self.beside is not None:
            found = compared(self.linear, self.beside)
        return found

    def to_dataframe(self, quantity: str = 'horizontal') -> pandas.DataFrame:
        """
        Return the total of a quantity, and the error that each source causes, as a DataFrame.

        The index ``t_ns`` is the time since the start of the navigation, ns. The columns, in m,
        m/s or rad, are ``rms`` and the names of the parameters. ``quantity``: see ``rms``.
        """
        table = {'rms': self.rms(quantity), **self.contributions(quantity)}
        return dataframe(np.round(1e9 * self.t_s).astype(np.int64), table)

    def to_xarray(self) -> xarray.Dataset:
        """
        Return covariances and mean errors as a Dataset.

        Returns
        -------
        xarray.Dataset
            ``covariance`` (source, time, error, error_2) of the random sources and ``mean``
            (fixed_source, time, error) of the fixed ones, in SI units and radians; time in s.

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        names = [f'{what}_{axis}' for what in ('position', 'velocity', 'attitude') for axis in ENU]
        return dataset(
            {'source': ([source.key for source in self.linear.random], ''),
             'fixed_source': ([source.key for source in self.linear.fixed], ''),
             'time': (self.t_s, 's'), 'error': (names, ''), 'error_2': (names, '')},
            {'covariance': (('source', 'time', 'error', 'error_2'), self.linear.covariance, ''),
             'mean': (('fixed_source', 'time', 'error'), self.linear.mean, '')})

    def save(self, folder: Folder, overwrite: bool = False,
             requirements: Iterable[str] = ()) -> None:
        """
        Write a folder with figures, tables, arrays and report.html, as ``ins_sim budget -o``.

        Parameters
        ----------
        folder : str or path
        overwrite : bool, optional
            Replace the folder if it holds a budget.
        requirements : iterable of str, optional
            Requirements that the report answers, see ``requirement``.

        Raises
        ------
        ValueError
            If the folder exists and must not be replaced, or a text is not a requirement.
        """
        from ins_sim.own_folders.own_folder import whole_folder
        from ins_sim.report.studies import budget as report
        checked_path('folder', folder)
        answers = [self.requirement(text) for text in requirements]
        with whole_folder(folder, overwrite, report.MARK, 'overwrite=True') as work:
            report.write_budget(work, self.settings, self.linear, answers, self.compared(),
                                self.beside)


def _quantity(name: str) -> Quantity:
    if name not in QUANTITIES:
        raise ValueError(f'quantity is {name!r}; expected one of {", ".join(QUANTITIES)}')
    return QUANTITIES[name]
