"""One run navigated with each of the orientation algorithms."""

from dataclasses import dataclass, replace
import math
from time import process_time

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.integration import KINDS, Orientation
from ins_sim.core.motion.motion import check_length
from ins_sim.core.numerics import elementary
from ins_sim.core.simulation.inertial import imu_blocks, navigate_blocks
from ins_sim.core.timeseries.histories import NavErrors, NavStates

TIMED_STEPS = 5000


@dataclass(frozen=True)
class OrientationResult:
    """
    Result of one algorithm.

    Attributes
    ----------
    kind : name of the algorithm, one of ``integration.KINDS``
    drift : (3,) drift of the attitude, East, North, Up, rad/s
    position : (3,) largest position errors, East, North, Up, m
    apart : largest angle between its attitude and that of the quaternion, rad
    step_s : CPU time of a step, s
    """

    kind: str
    drift: np.ndarray
    position: np.ndarray
    apart: float
    step_s: float


def compare_orientations(settings, motion, progress=None):
    """
    Return an OrientationResult for each of ``integration.KINDS``, the quaternion first.

    Parameters
    ----------
    settings : SimulationSettings
        strapdown.orientation is ignored.
    motion : Motion
        The motion of settings.motion_generator.
    progress : callable, optional
        Called with the number of algorithms done.

    Raises
    ------
    ValueError
        If the settings do not define a run of finite length.
    """
    generator = settings.motion_generator
    check_length(generator, motion)
    blocks = list(imu_blocks(settings, motion))
    results, reference = [], None
    for kind in sorted(KINDS, key=lambda k: k != 'quaternion'):
        parts = list(navigate_blocks(replace(settings.strapdown, orientation=kind), motion,
                                     blocks))
        states = NavStates.concatenate(s for _, s, _ in parts)
        errors = NavErrors.concatenate(e for _, _, e in parts)
        reference = states.q_nb if reference is None else reference
        results.append(OrientationResult(
            kind, errors.drift[-1], np.abs(errors.position).max(axis=0),
            _apart(reference, states.q_nb), _step_s(kind)))
        if progress is not None:
            progress(len(results))
    return results


def _apart(p, q):
    """Return the largest angle between attitudes (n, 4), rad."""
    p, q = np.moveaxis(p, -1, 0), np.moveaxis(q, -1, 0)
    x, y, z, w = quaternion.multiply(quaternion.conjugate(p), q)
    return float((2.0 * elementary.atan2(np.sqrt(x * x + y * y + z * z), np.abs(w))).max())


def _step_s(kind):
    algorithm, phi = Orientation(kind), (0.002, -0.003, 0.004)
    best = math.inf
    for _ in range(3):
        start = process_time()
        for _ in range(TIMED_STEPS):
            algorithm.advance(phi, 0.01)
        best = min(best, process_time() - start)
    return best / TIMED_STEPS
