"""Histories as tables of named columns with units, and as pandas DataFrames."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ins_sim.core.timeseries.histories import History

if TYPE_CHECKING:
    import pandas

ENU, BODY, QUATERNION = ('east', 'north', 'up'), ('x', 'y', 'z'), ('x', 'y', 'z', 'w')
METER = ('mounting_rad', 'scale_x', 'scale_z')
# {field of a history: (components, unit)}
COLUMNS: dict[str, tuple[tuple[str, ...], str]] = {
    'lat': ((), 'rad'), 'lon': ((), 'rad'), 'height': ((), 'm'), 'v_n': (ENU, 'm_s'),
    'q_nb': (QUATERNION, ''), 'omega_ib_b': (BODY, 'rad_s'), 'f_ib_b': (BODY, 'm_s2'),
    'omega': (BODY, 'rad_s'), 'f': (BODY, 'm_s2'), 'parity': ((), 'rad_s'),
    'attitude': (ENU, 'rad'), 'velocity': (ENU, 'm_s'), 'position': (ENU, 'm'),
    'drift': (ENU, 'rad_s'), 'attitude_sigma': (ENU, 'rad'), 'velocity_sigma': (ENU, 'm_s'),
    'position_sigma': (ENU, 'm'), 'estimates': (METER, ''), 'estimates_sigma': (METER, '')}


def columns(field: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Return {name of a column: (n,) array} of one field of a history."""
    components, unit = COLUMNS[field]
    if not components:
        return {f'{field}_{unit}': values}
    names = ('_'.join(filter(None, (field, component, unit))) for component in components)
    return dict(zip(names, np.moveaxis(values, -1, 0)))


def dataframe(t_ns: np.ndarray, table: dict[str, np.ndarray]) -> pandas.DataFrame:
    """
    Return a DataFrame whose index ``t_ns`` is the time in ns.

    Raises ImportError, which says what to install, where there is no pandas.
    """
    try:
        import pandas
    except ImportError:
        raise ImportError("to_dataframe needs pandas; expected pip install 'ins_sim[dataframe]'"
                          ) from None
    table_of_columns: pandas.DataFrame = pandas.DataFrame(
        table, index=pandas.Index(t_ns, name='t_ns'))
    return table_of_columns


def history_dataframe(history: History) -> pandas.DataFrame:
    """Return the DataFrame of a history."""
    arrays = history.arrays()
    t_ns = arrays.pop('t_ns')
    table: dict[str, np.ndarray] = {}
    for field, values in arrays.items():
        table.update(columns(field, values))
    return dataframe(t_ns, table)


def chosen(records: dict[str, History | None], name: str) -> History:
    """Return a record by name; ValueError, in one sentence, where there is none."""
    if name not in records:
        raise ValueError(f'record is {name!r}; expected one of {", ".join(records)}')
    record = records[name]
    if record is None:
        there = ', '.join(key for key, value in records.items() if value is not None)
        raise ValueError(f'record is {name!r}, which this run does not have; expected one of '
                         f'{there}')
    return record
