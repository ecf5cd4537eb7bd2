"""Read settings for the public functions, and check the arguments of these functions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
import os
from pathlib import Path
from typing import Any, Literal, overload, Union

from ins_sim import parameter_files, resources
from ins_sim.settings.presets import preset, PRESETS, strapdown_values
from ins_sim.settings.simulation import AidedSimulationSettings, SimulationSettings

Name = Union[str, 'os.PathLike[str]']
Names = Union[Name, Iterable[Name]]
Values = Mapping[str, Any]


@overload
def read_settings(names: Names, values: Values | None = None,
                  aided: Literal[False] = False) -> SimulationSettings:
    ...


@overload
def read_settings(names: Names, values: Values | None = None, *,
                  aided: Literal[True]) -> AidedSimulationSettings:
    ...


@overload
def read_settings(names: Names, values: Values | None,
                  aided: Literal[True]) -> AidedSimulationSettings:
    ...


def read_settings(names: Names, values: Values | None = None,
                  aided: bool = False) -> SimulationSettings | AidedSimulationSettings:
    """
    Return the settings of a simulation.

    Parameters
    ----------
    names : str, path, or a list of these
        Parameter files: names of shipped ones, such as ``'motion_2'``, or paths. A section of a
        later file overrides the same section of an earlier one. An empty list gives the defaults.
    values : mapping, optional
        Values by the name of the parameter; they override the files. ``'gyro.delay_us.y'`` sets
        this parameter in every node that has it, ``'strapdown:output_every'`` in one node.
    aided : bool, optional
        Whether to include the settings of the aided navigator and its sensors.

    Returns
    -------
    SimulationSettings or AidedSimulationSettings
        Immutable; fields are attributes, such as ``settings.imu_sensor.gyro.delay_us.y``.

    Raises
    ------
    ValueError
        If a name is unknown (the message gives the nearest known one), or a value has the wrong
        type, is out of range or contradicts other values.
    FileNotFoundError
        If a file does not exist.

    Examples
    --------
    >>> import ins_sim
    >>> settings = ins_sim.read_settings('motion_2', {'duration_s': 60.0, 'gyro.delay_us.y': 1.0})
    >>> settings.imu_sensor.gyro.delay_us.y
    1.0
    >>> ins_sim.read_settings('motion_2', {'duration': 60.0})
    Traceback (most recent call last):
        ...
    ValueError: values: unknown parameter 'duration'; the nearest known one is 'duration_s'
    """
    read = parameter_files.read_aided if aided else parameter_files.read
    return read(files(names), plain(values))


def files(names: Names) -> list[Path]:
    """Return the paths of one or several parameter files given by name or path."""
    given = [names] if isinstance(names, (str, os.PathLike)) else names
    if isinstance(given, (bytes, Mapping)) or not isinstance(given, Iterable):
        raise ValueError(f'names is {given!r}; expected the name or the path of a parameter '
                         'file, or a list of these')
    return [resources.parameter_file(checked_path('names', name)) for name in given]


def checked_path(argument: str, path: Any) -> Name:
    """Return a path; raise ValueError, with the name of the argument, if it is not a path."""
    if not isinstance(path, (str, os.PathLike)):
        raise ValueError(f'{argument} is {path!r}; expected a path')
    return path


def plain(values: Values | None) -> dict[str, Any]:
    """Return values by name, with NumPy arrays and numbers converted exactly to Python ones."""
    if values is None:
        return {}
    if not isinstance(values, Mapping) or not all(isinstance(name, str) for name in values):
        raise ValueError(f'values are {values!r}; expected {{name of a parameter: value}}')
    return {name: value.tolist() if hasattr(value, 'tolist') else value
            for name, value in values.items()}


@overload
def presets(name: None = None) -> dict[str, str]:
    ...


@overload
def presets(name: str) -> dict[str, Any]:
    ...


def presets(name: str | None = None) -> dict[str, Any]:
    """
    Return the presets of instrument errors.

    Parameters
    ----------
    name : str, optional
        Name of a preset.

    Returns
    -------
    dict
        Without a name: the description of every preset, by its name. With a name: the values of
        that preset by parameter, for ``read_settings``.

    Raises
    ------
    ValueError
        If no preset has that name; the message gives the nearest one.

    Examples
    --------
    >>> import ins_sim
    >>> sorted(ins_sim.presets())
    ['navigation_rlg', 'tactical_dtg', 'tactical_fog', 'tactical_mems']
    >>> settings = ins_sim.read_settings('motion_2', ins_sim.presets('tactical_fog'))
    >>> settings.imu_sensor.gyro.errors.angle_random_walk_deg_sqrt_h
    (0.012, 0.012, 0.012)
    >>> ins_sim.presets('tactical_fox')
    Traceback (most recent call last):
        ...
    ValueError: unknown instrument preset 'tactical_fox'; the nearest known one is 'tactical_fog'
    """
    if name is not None and not isinstance(name, str):
        raise ValueError(f'name is {name!r}; expected one of {", ".join(PRESETS)}')
    if name is None:
        return {key: entry.datasheet for key, entry in PRESETS.items()}
    return {**{f'imu_sensor:{key}': value for key, value in preset(name).items()},
            **{f'strapdown:{key}': value
               for key, value in strapdown_values(PRESETS[name]).items()}}
