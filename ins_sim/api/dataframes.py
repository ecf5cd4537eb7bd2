"""Convert histories to pandas DataFrames whose column names contain the unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ins_sim.core.timeseries.histories import History
from ins_sim.core.timeseries.named_columns import history_columns

if TYPE_CHECKING:
    import pandas


def dataframe(t_ns: np.ndarray, table: dict[str, np.ndarray]) -> pandas.DataFrame:
    """
    Return a DataFrame whose index ``t_ns`` is the time in ns.

    Raises ImportError, which says what to install, if pandas is not installed.
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
    return dataframe(history.arrays()['t_ns'], history_columns(history))


def chosen(records: dict[str, History | None], name: str) -> History:
    """Return a record by name; raise ValueError if there is no such record."""
    if name not in records:
        raise ValueError(f'record is {name!r}; expected one of {", ".join(records)}')
    record = records[name]
    if record is None:
        there = ', '.join(key for key, value in records.items() if value is not None)
        raise ValueError(f'record is {name!r}, which this run does not have; expected one of '
                         f'{there}')
    return record
