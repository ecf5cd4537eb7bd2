"""Consistency of a filter: its errors normalised by its own covariance (NEES)."""

from typing import Any, NamedTuple

import numpy as np

from .kalman import normalised_square

ENU, BODY = 'enu', 'xyz'
# Groups of states whose errors are normalised together; the last one holds all states.
BLOCKS = ('position', 'velocity', 'attitude', 'state')


class FilterNote(NamedTuple):
    """
    State names, covariance and estimates of a filter at one instant.

    states, given, covariance, estimates: see AidingFilter; biases: estimated biases of the gyros
    (rad/s) and of the accelerometers (m/s^2), which are subtracted from the readings.
    """

    states: tuple
    given: tuple
    covariance: Any
    biases: tuple
    estimates: tuple


def note_of(navigator):
    """Return the FilterNote of an AidedNavigator with a solution."""
    filter_ = navigator.filter
    return FilterNote(filter_.states, filter_.given, filter_.covariance, navigator.ins.biases,
                      filter_.estimates)


class TrueValues(NamedTuple):
    """
    True values of what the filter estimates besides the solution.

    gyro, accelerometer: biases by axis of b, rad/s and m/s^2, or None if unknown; meter: mounting
    error (rad), forward and lateral scale error of the velocity meter.
    """

    gyro: tuple | None
    accelerometer: tuple | None
    meter: tuple


def state_errors(note, level, true):
    """
    Return {state name: estimate minus truth} for the states with a known truth.

    Parameters
    ----------
    note : FilterNote
    level : attitude, velocity and position errors, see ``navigation.errors.level_errors``
    true : TrueValues

    """
    attitude, velocity, position = level
    found = {}
    for name, values in (('position', position), ('velocity', velocity), ('attitude', attitude)):
        found.update({f'{name}_{axis}': v for axis, v in zip(ENU, values)})
    gyro, accelerometer = note.biases
    for name, taken, bias in (('gyro_bias', gyro, true.gyro),
                              ('accelerometer_bias', accelerometer, true.accelerometer)):
        if bias is not None:
            found.update({f'{name}_{axis}': a - b for axis, a, b in zip(BODY, taken, bias)})
    found.update({name: a - b for name, a, b in zip(('mounting', 'scale_x', 'scale_z'),
                                                    note.estimates, true.meter)})
    return {name: error for name, error in found.items()
            if name in note.states and name not in note.given}


def nees(note, level, true):
    """
    Return the NEES and the degrees of freedom of each of BLOCKS.

    The NEES is e' P^-1 e with the errors e of the states of a block and their part P of the
    covariance. If the filter is consistent it is chi-square with as many degrees of freedom as
    there are states (Bar-Shalom, Li and Kirubarajan, "Estimation with Applications to Tracking
    and Navigation", 2001, 5.4).

    Parameters
    ----------
    note, level, true : see ``state_errors``

    Returns
    -------
    nees : list of float, NaN for a block without states
    freedom : list of int, 0 for a block without states; all blocks are empty without a covariance

    """
    errors = {} if note.covariance is None else state_errors(note, level, true)
    found, freedom = [], []
    for block in BLOCKS:
        names = [name for name in errors if block == 'state' or name.startswith(f'{block}_')]
        freedom.append(len(names))
        found.append(_normalised([errors[name] for name in names], note.covariance,
                                 [note.states.index(name) for name in names]))
    return found, freedom


def _normalised(errors, covariance, places):
    if not places:
        return np.nan
    part = covariance[np.ix_(places, places)]
    scale = np.sqrt(np.diagonal(part))
    # Normalise P to correlations first: metres and radians then have comparable magnitudes.
    try:
        return normalised_square(np.array(errors) / scale,
                                 part / np.multiply.outer(scale, scale))
    except np.linalg.LinAlgError:
        return np.nan
