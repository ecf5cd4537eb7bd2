"""Read the study of ``monte-carlo`` with which a budget is compared."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ins_sim import parameter_files
from ins_sim.core.prediction.budget.propagation import navigation_start_s
from ins_sim.studies.budget.beside import BesideRuns
from ..files.stored_arrays import read_arrays
from ..storage import PARAMETERS
from .ensemble import ARRAYS

KINDS = ('attitude', 'velocity', 'position')
BY_INSTANT = {'t_ns': ('i', (None,)), 'count': ('i', (None,)), 'covariance': ('f', (None, 9, 9)),
              **{f'{name}_mean': ('f', (None, 3)) for name in KINDS}}


def read_study(folder, settings):
    """
    Return the BesideRuns in the folder of a study.

    Raises ValueError or OSError if the folder holds no study, or one with other settings than
    these SimulationSettings; the seed may differ.
    """
    folder = Path(folder)
    path = folder / ARRAYS
    if not path.exists():
        raise ValueError(f'{folder} holds no {ARRAYS}; expected the folder of a study of '
                         'ins_sim monte-carlo')
    theirs = parameter_files.read([folder / PARAMETERS])
    other = [node for node in ('motion_generator', 'imu_sensor', 'strapdown')
             if getattr(_drawn_alike(theirs), node) != getattr(_drawn_alike(settings), node)]
    if other:
        raise ValueError(f'{folder}: the settings of {", ".join(other)} differ from those of the '
                         'budget; expected the same values, except for the seed: use '
                         f'--params-file {folder / PARAMETERS}')
    try:
        arrays = read_arrays(path, BY_INSTANT)
        runs = read_arrays(path, {'runs': ('i', (None,))})['runs']
        diverged = read_arrays(path, {'diverged': ('i', (None,))})['diverged']
    except ValueError as error:
        raise ValueError(f'{path}: {error}; expected the arrays of ins_sim monte-carlo') from None
    mean = np.concatenate([arrays[f'{name}_mean'] for name in KINDS], axis=1)
    return BesideRuns(len(runs), tuple(diverged.tolist()),
                      1e-9 * arrays['t_ns'] - navigation_start_s(settings), arrays['count'], mean,
                      arrays['covariance'])


def _drawn_alike(settings):
    """Return settings with seed and run set to fixed values, for comparison."""
    settings = settings.with_run(0)
    return replace(settings, imu_sensor=replace(settings.imu_sensor, seed=0))
