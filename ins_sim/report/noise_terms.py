"""Noise coefficients of a triad in data-sheet units: fitted values and those of the settings."""

from dataclasses import dataclass, fields
import math

import numpy as np
from rich.table import Table

from ins_sim.core.sensors.imu.triad_model import KEYS, triad_model
from ins_sim.settings.instrument_errors import AccelerometerErrors, GyroErrors
from . import allan

AXES = ('x', 'y', 'z')
# A channel whose scatter is below this part of its magnitude contains rounding, not noise.
ROUNDING = 1e-9


@dataclass(frozen=True)
class Term:
    """
    One noise coefficient of a triad.

    Attributes
    ----------
    symbol : Q, N, B or K
    name, unit : as in data sheets
    si : one unit in SI
    slope : slope of its Allan deviation over tau in a log-log plot
    """

    symbol: str
    name: str
    unit: str
    si: float
    slope: str


def _terms(cls, names):
    """Return the Terms of a triad, with the units of the settings."""
    keys = {coefficient: (key, si) for key, (coefficient, si) in KEYS[cls].items()}
    units = {f.name: f.metadata['unit'] for f in fields(cls)}
    made = []
    for symbol, coefficient, slope, name in zip('QNBK', ('quantum', 'white', 'flicker', 'walk'),
                                                ('-1', '-1/2', '0', '+1/2'), names):
        key, si = keys[coefficient]
        made.append(Term(symbol, name, units[key], si, slope))
    return tuple(made)


TRIADS = {
    'gyro': _terms(GyroErrors, ('quantisation', 'angle random walk', 'bias instability',
                                'rate random walk')),
    'accelerometer': _terms(AccelerometerErrors, ('quantisation', 'velocity random walk',
                                                  'bias instability',
                                                  'acceleration random walk'))}


@dataclass(frozen=True)
class Noise:
    """
    The noise found in one triad.

    Attributes
    ----------
    triad : 'gyro' or 'accelerometer'
    axes : axes whose samples are not constant
    allan : Allan of these axes, SI
    known : mean Allan variance (m,) of known processes that were not fitted
    by_axis : Coefficients of each axis
    together : Coefficients of the mean variance
    settings : expected Q, N, B, K by axis (4, 3), SI, or None
    """

    triad: str
    axes: tuple
    allan: allan.Allan
    known: np.ndarray
    by_axis: tuple
    together: allan.Coefficients
    settings: np.ndarray | None

    def fitted(self):
        """Return the Allan deviation of the fit to all axes at each tau (m,), SI."""
        return np.sqrt(self.together.deviation(self.allan.tau_s) ** 2 + self.known)

    def expected(self):
        """
        Return the Allan deviation expected from the settings at each tau (m,), SI.

        It is the root of the mean variance of the axes, or None if no settings are known or they
        contain no noise.
        """
        if self.settings is None:
            return None
        noisy = self.settings[:, [AXES.index(axis) for axis in self.axes]]
        mean = allan.Coefficients(*np.sqrt(np.mean(noisy ** 2, axis=-1)).tolist())
        deviation = np.sqrt(mean.deviation(self.allan.tau_s) ** 2 + self.known)
        return deviation if deviation.all() else None

    def rows(self):
        """
        Return for each Term a dict of texts and numbers in its unit.

        None marks values that are not observable: a constant axis, or a coefficient whose part of
        the Allan variance is small or uncertain at every tau.
        """
        found = {**dict(zip(self.axes, self.by_axis)), 'all': self.together}
        seen = {axis: c.seen(self.allan.channels([k]))
                for k, (axis, c) in enumerate(zip(self.axes, self.by_axis))}
        seen['all'] = self.together.seen(self.allan)
        rows = []
        for k, term in enumerate(TRIADS[self.triad]):
            row = {'triad': self.triad, 'symbol': term.symbol, 'name': term.name,
                   'unit': term.unit}
            for axis in (*AXES, 'all'):
                row[axis] = (_values(found[axis])[k] / term.si
                             if axis in found and seen[axis][k] else None)
            row['settings'] = (None if self.settings is None
                               else (self.settings[k] / term.si).tolist())
            rows.append(row)
        return rows


def _values(coefficients):
    return tuple(getattr(coefficients, f.name) for f in fields(coefficients))


def expected_coefficients(errors, dt_s, name, factors=(1.0, 1.0, 1.0)):
    """
    Return Q, N, B, K by axis (4, 3), SI, expected from GyroErrors or AccelerometerErrors.

    Q is the weight of a pulse over sqrt(12) (IEEE Std 952, C.1.1.5). A Gauss-Markov process with
    an infinite correlation time is counted as a random walk. ``factors`` are the variances of the
    axes relative to that of a channel.
    """
    model = triad_model(errors, dt_s, name)
    endless = [s / 60.0 if math.isinf(t) else 0.0
               for s, t in zip(model.gauss_markov_sigma, model.gauss_markov_time)]
    return np.sqrt(factors) * np.array([np.array(model.quantum) / math.sqrt(12.0), model.white,
                                        model.flicker, np.hypot(model.walk, endless)])


def analyse_noise(triad, samples, rate_hz, errors=None, factors=(1.0, 1.0, 1.0)):
    """
    Return the Noise of samples (n, 3) of a triad, SI, or None if they are constant.

    ``errors`` are the GyroErrors or AccelerometerErrors of the settings, if known. A Gauss-Markov
    bias in them is not fitted, because an Allan deviation cannot distinguish it from B and K.
    ``factors``: see ``expected_coefficients``.
    """
    size = np.abs(samples).max()
    # Written as "not <=" so that an axis with NaN does not count as constant.
    noisy = [k for k in range(3) if not np.ptp(samples[:, k]) <= ROUNDING * size]
    if not noisy:
        return None
    found = allan.estimate_deviation(samples[:, noisy], rate_hz)
    known, wanted = np.zeros_like(found.deviation), None
    if errors is not None:
        name = f'{triad}.errors'
        model = triad_model(errors, 1.0 / rate_hz, name)
        wanted = expected_coefficients(errors, 1.0 / rate_hz, name, factors)
        known = np.stack([factors[k] * allan.gauss_markov_variance(
            found.tau_s, model.gauss_markov_sigma[k], model.gauss_markov_time[k])
            for k in noisy], -1)
    mean = known.mean(axis=-1)
    try:
        by_axis = tuple(allan.fit_coefficients(found.channels([k]), known[:, k])
                        for k in range(len(noisy)))
        together = allan.fit_coefficients(found, mean)
    except ValueError as error:
        raise ValueError(f'{triad}: {error}') from None
    return Noise(triad, tuple(AXES[k] for k in noisy), found, mean, by_axis, together, wanted)


def show_noise(noise, title, console):
    """Print the rows of a Noise."""
    names = ', '.join(f'{t.symbol} {t.name}' for t in TRIADS[noise.triad])
    table = Table(title=f'{noise.triad}: {title}',
                  caption=f'{names}; all: of the mean variance of the axes; -: not observable')
    known = noise.settings is not None
    table.add_column('')
    table.add_column('unit')
    for head in (*AXES, 'all', *(('settings',) if known else ())):
        table.add_column(head, justify='right')
    for row in noise.rows():
        cells = [_number(row[head]) for head in (*AXES, 'all')]
        if known:
            alike = len(set(row['settings'])) == 1
            cells.append(', '.join(map(_number, row['settings'][:1 if alike else None])))
        table.add_row(row['symbol'], row['unit'], *cells)
    console.print(table)


def _number(value):
    return '-' if value is None else f'{value:.4g}'
