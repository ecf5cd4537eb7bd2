"""Convert records to xarray Datasets with named dimensions, labels and units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TYPE_CHECKING, Union

import numpy as np

from ins_sim.core.timeseries.histories import History
from ins_sim.core.timeseries.named_columns import BODY, COLUMNS, ENU, METER, QUATERNION, UNITS

if TYPE_CHECKING:
    import xarray

Labels = Union[Sequence[Any], np.ndarray]
# One dimension for each meaning of the last axis of an array, so that records can be merged.
DIMENSIONS = {ENU: 'axis', BODY: 'body_axis', QUATERNION: 'quaternion', METER: 'estimate'}


def dataset(coords: Mapping[str, tuple[Labels, str]],
            variables: Mapping[str, tuple[Sequence[str], np.ndarray, str]],
            attrs: Mapping[str, Any] | None = None) -> xarray.Dataset:
    """
    Return a Dataset.

    Parameters
    ----------
    coords : mapping
        Labels and unit ('' for none) by the name of the dimension:
        ``{'run': (numbers, ''), 'time': (t_ns, 'ns'), 'axis': (ENU, '')}``.
    variables : mapping
        Dimensions, array and unit ('' for none) by the name of the variable:
        ``{'position': (('run', 'time', 'axis'), array, 'm')}``.
    attrs : mapping, optional
        Attributes of the whole Dataset, such as the seed.

    Raises
    ------
    ImportError
        If xarray is not installed; the message says what to install.
    """
    try:
        import xarray
    except ImportError:
        raise ImportError("to_xarray needs xarray; expected pip install 'ins_sim[xarray]'"
                          ) from None
    return xarray.Dataset(
        {name: (tuple(dims), values, _unit(unit))
         for name, (dims, values, unit) in variables.items()},
        coords={name: (name, np.asarray(labels), _unit(unit))
                for name, (labels, unit) in coords.items()},
        attrs=dict(attrs or {}))


def track_dataset(t_ns: np.ndarray, fields: Mapping[str, np.ndarray],
                  attrs: Mapping[str, Any] | None = None) -> xarray.Dataset:
    """Return the Dataset of fields, (n,) or (n, components), at the instants t_ns (n,)."""
    coords: dict[str, tuple[Labels, str]] = {'time': (t_ns, 'ns')}
    variables = {}
    for name, values in fields.items():
        components, unit = COLUMNS[name]
        dims = ['time']
        if components:
            dims.append(DIMENSIONS[components])
            coords[dims[-1]] = components, ''
        variables[name] = dims, values, UNITS[unit]
    return dataset(coords, variables, attrs)


def history_dataset(history: History, attrs: Mapping[str, Any] | None = None) -> xarray.Dataset:
    """Return the Dataset of a history."""
    fields = history.arrays()
    return track_dataset(fields.pop('t_ns'), fields, attrs)


def _unit(unit: str) -> dict[str, str]:
    return {'units': unit} if unit else {}
