"""Convert NEES and NIS of an ensemble to columns of a DataFrame and variables of a Dataset."""

from __future__ import annotations

from typing import Any, TYPE_CHECKING

import numpy as np

from ins_sim.core.aiding.consistency import BLOCKS
from ins_sim.core.ensemble.consistency import ChiSquareSums
from ins_sim.report.consistency import sum_intervals
from ins_sim.studies.aided_ensembles import Consistency
from .dataframes import dataframe

if TYPE_CHECKING:
    import pandas


def nees_columns(consistency: Consistency) -> dict[str, np.ndarray]:
    """Return {nees_position, nees_position_low, ...: (m,)}, means over runs and 95 % bounds."""
    found = {}
    for k, block in enumerate(BLOCKS):
        found.update(_columns(f'nees_{block}',
                              ChiSquareSums(*(a[:, k] for a in consistency.nees))))
    return found


def fixes_dataframe(consistency: Consistency, source: str) -> pandas.DataFrame:
    """Return one row per fix of a sensor: mean NIS, 95 % interval, runs that used it or not."""
    if source not in consistency.fixes:
        raise ValueError(f'record is {source!r}; expected errors, final or '
                         f'{", ".join(consistency.fixes)}')
    fixes = consistency.fixes[source]
    return dataframe(fixes.t_ns, {**_columns('nis', fixes.sums), 'taken': fixes.taken,
                                  'refused': fixes.refused})


def _columns(name: str, sums: ChiSquareSums) -> dict[str, np.ndarray]:
    low, high = sum_intervals(sums)
    return {name: sums.mean, f'{name}_expected': sums.expected, f'{name}_low': low,
            f'{name}_high': high}


def consistency_coords(consistency: Consistency) -> dict[str, tuple[Any, str]]:
    """Return the coordinates of ``consistency_variables`` in the form of ``dataset``."""
    return {'block': (BLOCKS, ''), **{f'{source}_time': (fixes.t_ns, 'ns')
                                      for source, fixes in consistency.fixes.items()}}


def consistency_variables(consistency: Consistency) -> dict[str, Any]:
    """Return mean NEES and NIS with their 95 % intervals in the form of ``dataset``."""
    found: dict[str, Any] = {name: (('time', 'block'), values, '')
                             for name, values in _columns('nees', consistency.nees).items()}
    for source, fixes in consistency.fixes.items():
        columns = _columns(f'{source}_nis', fixes.sums)
        columns.update({f'{source}_taken': fixes.taken, f'{source}_refused': fixes.refused})
        found.update({name: ((f'{source}_time',), values, '')
                      for name, values in columns.items()})
    return found
