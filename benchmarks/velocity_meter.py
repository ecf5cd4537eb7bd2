"""
The effect of the choices in docs/design/velocity_meter.md on the errors of the meter.

Run: python benchmarks/velocity_meter.py [windows of one cycle, 2000] [windows of 100, 100]
"""

import math
import sys
from time import process_time

import numpy as np

from ins_sim.core.sensors.velocity_meter import reading as fit
from ins_sim.settings.catalogue import build
from ins_sim.core.timeseries.fixes import VALID
from ins_sim.core.sensors.velocity_meter.antennas import antenna_geometry
from ins_sim.settings.velocity_meter import VelocityMeterSettings
from ins_sim.core.sensors.velocity_meter.pulses import Correlator, Field

BETA = math.radians(6.0)


class ShortCorrelator(Correlator):
    """
    A correlator that stops at the end of the cycle: n - lag products in each sum.

    Sums are divided by n (biased) or by the number of products.
    """

    def __init__(self, settings, biased):
        super().__init__(settings)
        self._biased = biased

    def functions_of(self, signals):
        """Return the functions of powers of one cycle, (5, lags)."""
        n = self._count
        values = abs(signals[:, :n]) ** 2
        values = values / values.mean(axis=1, keepdims=True) - 1.0
        return np.array([[values[i, :n - k] @ values[j, k:] / (n if self._biased else n - k)
                          for k in range(self._lags)] for i, j in fit.PAIRS])


def readings(cycles, windows, beta=0.0, biased=None, **signal):
    """
    Return the Readings of windows.

    biased: None for the Correlator of the meter, otherwise how ShortCorrelator divides its sums.
    """
    s = build(VelocityMeterSettings, {'mode': 'signal', 'window.cycles': cycles,
                                      **{f'signal.{k}': v for k, v in signal.items()}})
    field = Field(s)
    correlator = Correlator(s) if biased is None else ShortCorrelator(s, biased)
    rng, found = np.random.default_rng(1), []
    v = 250.0 * math.cos(beta), 250.0 * math.sin(beta), 0.0
    for _ in range(windows):
        signals = (field.signals(rng.standard_normal(field.width), *v) for _ in range(cycles))
        if biased is None:
            parts = zip(*map(correlator.sums, signals))
            functions = correlator.functions([sum(part) for part in parts], cycles)
        else:
            functions = sum(map(correlator.functions_of, signals)) / cycles
        found.append(fit.read_correlations(functions, s.lag_s, antenna_geometry(s.antennas), 0.0))
    return found


def show(name, found, beta=0.0, least=0.0):
    """Print bias and sigma of the readings; least: speed below which fixes are rejected, m/s."""
    good = [(one.v_x, one.v_z) for one in found if one.status == VALID and one.v_x >= least]
    x = np.array(good) - (250.0 * math.cos(beta), 250.0 * math.sin(beta))
    core = np.subtract(*np.percentile(x, [75, 25], axis=0)) / 1.349
    scale = f', V_z scale {x[:, 1].mean() / (250.0 * math.sin(beta)):+.4f}' if beta else ''
    print(f'{name}: {100.0 * (1.0 - len(x) / len(found)):.1f} % invalid, sigma {x[:, 0].std():.2f}'
          f' / {x[:, 1].std():.2f}, core {core[0]:.2f} / {core[1]:.2f}, bias {x[:, 0].mean():+.2f}'
          f' / {x[:, 1].mean():+.2f} m/s{scale}')


def main(one=2000, hundred=100):
    """Print a line for each choice."""
    start = process_time()
    for least in (0.0, 30.0):
        show(f'N = 1, speeds from {least:g} m/s', readings(1, one), least=least)
    show('N = 1, fewer products at longer lags', readings(1, one // 4, biased=False), least=30.0)
    show('N = 100', readings(100, hundred))
    show('N = 100, complex amplitudes', readings(100, hundred, detection='complex'))
    show('N = 100, a sample each pulse', readings(100, hundred, pulses_per_lag=1, lags=384))
    for normalisation in ('window', 'cycle'):
        show(f'N = 100, beta = 6 deg, mean power of the {normalisation}',
             readings(100, hundred, BETA, normalisation=normalisation), BETA)
    show('N = 100, products over one number', readings(100, hundred // 4, biased=True))
    evenly = fit.log_quadratic
    fit.log_quadratic = lambda values, first, even=False: evenly(values, first)
    show('N = 1, autocorrelations with d free', readings(1, one))
    show('N = 100, autocorrelations with d free', readings(100, hundred))
    fit.log_quadratic = evenly
    print(f'{process_time() - start:.0f} s')


if __name__ == '__main__':
    main(*map(int, sys.argv[1:]))
