"""Errors of an ensemble: sigma, rms, percentiles, circles, and the worst run."""

from dataclasses import dataclass

import numpy as np

from ins_sim.core.ensemble.result import EnsembleResult, horizontal_of
from ins_sim.jobs.fingerprint import array_digest
from .error_circle import error_circle

QUANTITIES = ('attitude', 'velocity', 'position')
COLUMNS = {name: slice(3 * k, 3 * k + 3) for k, name in enumerate(QUANTITIES)}
PERCENTS = (5, 25, 50, 75, 95)
CEP_PARTS = {50: 0.5, 95: 0.95}


@dataclass(frozen=True, eq=False)
class EnsembleErrors:
    """
    The errors of an EnsembleResult at its m instants, solution minus truth, East, North, Up.

    In the dicts by quantity, attitude is in rad, velocity in m/s, position in m.

    Attributes
    ----------
    t_ns : (m,) instants, ns
    count : (m,) number of runs that have not diverged
    mean, sigma, rms : {name of a quantity: (m, 3)}
    percentiles : {name of a quantity: (p, m, 3)} for PERCENTS
    horizontal_rms : {name of a quantity: (m,)} rms of the horizontal magnitude
    horizontal_percentiles : {name of a quantity: (p, m)} of the horizontal magnitude
    cep : {percent: (m,)} radii about the true position that contain this fraction of the runs,
        from mean and covariance, m
    """

    t_ns: np.ndarray
    count: np.ndarray
    mean: dict
    sigma: dict
    rms: dict
    percentiles: dict
    horizontal_rms: dict
    horizontal_percentiles: dict
    cep: dict


def ensemble_errors(result: EnsembleResult) -> EnsembleErrors:
    """Return the EnsembleErrors of an EnsembleResult."""
    statistics, horizontal = result.statistics, result.horizontal
    percentiles = np.stack([statistics.percentile(p) for p in PERCENTS])
    sizes = np.stack([horizontal.percentile(p) for p in PERCENTS])
    place = COLUMNS['position']
    plane = slice(place.start, place.start + 2)
    mean, covariance = statistics.mean[:, plane], statistics.covariance[:, plane, plane]
    return EnsembleErrors(
        result.t_ns, statistics.count,
        *({name: values[..., part] for name, part in COLUMNS.items()}
          for values in (statistics.mean, statistics.sigma, statistics.rms, percentiles)),
        *({name: values[..., k] for k, name in enumerate(QUANTITIES)}
          for values in (horizontal.rms, sizes)),
        {percent: error_circle(mean, covariance, part)
         for percent, part in CEP_PARTS.items()})


def ensemble_digest(result) -> str:
    """Return the SHA-256 of statistics and final errors; it does not depend on the executor."""
    return array_digest(result.arrays())


def worst_run(result):
    """Return number and horizontal error, m, of the run with the largest final error, or None."""
    ends = horizontal_of(result.final_errors)[:, 2]
    if not np.isfinite(ends).any():
        return None
    k = int(np.nanargmax(ends))
    return result.runs[k], float(ends[k])
