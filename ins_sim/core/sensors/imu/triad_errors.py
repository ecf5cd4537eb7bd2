"""The errors of a triad of gyros or accelerometers, sample by sample."""

import math

import numpy as np

from ins_sim.core.attitude import quaternion
from ins_sim.core.numerics import elementary
from ins_sim.core.numerics.compilation import run
from ins_sim.core.numerics.noise import BLOCK, cut, indexed_noise
from ins_sim.core.numerics.processes import Processes
from .triad_model import temperature_off, triad_model
from .triad_reading import AT_REST, read, read_arrays, read_rows, respond, ZERO

# Flicker noise is modelled as the sum of Gauss-Markov processes with these correlation times, s,
# and the variance B^2 ln(10)/pi each. Its Allan deviation is 0.664 B within 2.5 % from 1 s to
# 30000 s.
FLICKER_TIMES = (0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5)
FLICKER_SIGMA = math.sqrt(elementary.log(10.0) / math.pi)
# A lag has decayed completely after this many time constants; exp underflows beyond.
GONE = 700.0


class TriadErrors:
    """
    The errors of one triad; raises ValueError for settings out of range.

    The random terms are functions of (seed, run, name, index). The quantities carried from sample
    to sample are in ``state``: the last index, the lags and the remainders of the pulses. After a
    jump of the index the lags start settled and the remainders at zero.

    Parameters
    ----------
    settings : GyroErrors or AccelerometerErrors
    seed, run : of the random streams
    name : name of the random streams and prefix of the keys in messages
    dt_s : sampling period, s
    temperature : settings Temperature, or None for the reference temperature
    """

    def __init__(self, settings, seed, run, name, dt_s, temperature=None):
        model = triad_model(settings, dt_s, name)
        self._dt, self._per_dt = dt_s, 1.0 / dt_s
        self._geometry = _geometry(model, seed, run, name)
        self._response = _response(model, seed, run, name)
        self._by_force = _if_any(model.g_linear, model.g_quadratic)
        self._by_temperature = _if_any(model.temperature_bias, model.temperature_scale)
        self._temperature = temperature
        if temperature is None or _never_off(temperature):
            self._by_temperature = None
        self._lags = tuple(discrete_lag(f, model.order, dt_s) for f in model.bandwidth_hz)
        if not any(model.bandwidth_hz):
            self._lags = None
        self._noise = make_noise(model, seed, run, name, dt_s)
        self._noise_of = None
        self._rows = ()
        self._most = tuple(s or math.inf for s in model.saturation)
        if not any(model.saturation):
            self._most = None
        self._quantum = model.quantum if any(model.quantum) else None
        self.perfect = not any((self._geometry, self._response, self._by_force, self._lags,
                                self._by_temperature, self._noise, self._most, self._quantum))
        self.state = (None, AT_REST, ZERO)

    def bias(self, index, value, force):
        """
        Return the error of sample index at a constant input, three floats by body axis.

        White noise, pulses and the limits of the range are left out; for the arguments see
        ``step``.
        """
        warm = None
        if self._by_temperature is not None:
            warm = temperature_off(self._temperature, index * self._dt)
        driven = respond(self._geometry, self._response, self._by_force, self._by_temperature,
                         value, force, warm)
        added = ZERO if self._noise is None else self._noise.bias(index).tolist()
        return tuple(d - v + a for d, v, a in zip(driven, value, added))

    def step(self, index, value, force, t_s):
        """
        Return the reading of sample index, three floats by body axis.

        Parameters
        ----------
        index : motion time divided by the sampling period
        value : mean input over the sampling interval by body axis, rad/s or m/s^2
        force : specific force by body axis, m/s^2
        t_s : motion time, s
        """
        if self.perfect:
            return value
        last, lagged, carried = self.state
        warm = noise = None
        if self._by_temperature is not None:
            warm = temperature_off(self._temperature, t_s)
        if self._noise is not None:
            if index // BLOCK != self._noise_of:
                self._noise_of = index // BLOCK
                self._rows = self._noise(self._noise_of, 1).tolist()
            noise = self._rows[index % BLOCK]
        reading, lagged, carried = read(
            self._geometry, self._response, self._by_force, self._by_temperature, self._lags,
            noise, self._most, self._quantum, self._dt, self._per_dt,
            last is not None and index == last + 1, lagged, carried, value, force, warm)
        self.state = index, lagged, carried
        return reading

    @property
    def at_once(self):
        """
        Return (geometry, response, AdditiveNoise) if the triad has noise and no further term.

        A reading is then ``respond`` with the first two, plus the noise. Otherwise return None.
        """
        if self._noise is None or any((self._by_force, self._by_temperature, self._lags,
                                       self._most, self._quantum)):
            return None
        return self._geometry, self._response, self._noise

    def immediate(self, values, forces, t_s):
        """
        Return the errors (n, 3) that depend on the present input only, and the fixed bias.

        Lags, range, pulses and noise are left out.

        Parameters
        ----------
        values, forces : (n, 3), see ``step``
        t_s : (n,) motion times, s
        """
        warm = None
        if self._by_temperature is not None:
            warm = temperature_off(self._temperature, t_s)
        found = np.stack(respond(self._geometry, self._response, self._by_force,
                                 self._by_temperature, values.T, forces.T, warm), axis=-1) - values
        return found if self._noise is None else found + self._noise.fixed

    def advance(self, first, values, forces, t_s):
        """
        Return the readings (n, 3) of consecutive samples; same bits as ``step``.

        Parameters
        ----------
        first : index of the first sample
        values, forces : (n, 3), see ``step``
        t_s : (n,) motion times, s
        """
        if self.perfect or not len(values):
            return values
        warm = noise = None
        if self._by_temperature is not None:
            warm = temperature_off(self._temperature, t_s)
        if self._noise is not None:
            noise = cut(self._noise, BLOCK, first, len(values))
        last, lagged, carried = self.state
        inputs = (self._geometry, self._response, self._by_force, self._by_temperature,
                  self._lags, noise, self._most, self._quantum, self._dt, self._per_dt,
                  last is not None and first == last + 1, lagged, carried, values, forces, warm)
        readings = np.empty((len(values), 3))
        lagged, carried = run(read_rows, len(readings), inputs, readings, read_arrays)
        self.state = first + len(readings) - 1, lagged, carried
        return readings


def _never_off(temperature):
    return (temperature.constant_c == temperature.reference_c and temperature.ramp_c_h == 0.0
            and temperature.amplitude_c == 0.0)


def _if_any(*terms):
    return terms if any(any(term) for term in terms) else None


def drawn_once(seed, run, name, sigma):
    """Return normal numbers with standard deviations sigma that are drawn once per run."""
    normals = indexed_noise(seed, run, name, 3, 1).normal(0)
    return tuple(s * n for s, n in zip(sigma, normals))


def _geometry(model, seed, run, name):
    """
    Return the nine elements of the matrix from body axes to sensitive axes, or None if unity.

    Its rows are the unit vectors of the sensitive axes: non-orthogonality within the triad, times
    the rotation from the body to the triad (misalignment).
    """
    turn = tuple(m + d for m, d in zip(model.misalignment, drawn_once(
        seed, run, f'{name}.misalignment', model.misalignment_sigma)))
    yx, zx, zy = map(elementary.sin, model.non_orthogonality)
    if not any(turn) and not any((yx, zx, zy)):
        return None
    back = quaternion.exponential(tuple(-a for a in turn))
    columns = [quaternion.rotate(back, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0),
                                                          (0.0, 0.0, 1.0))]
    rows = ((1.0, 0.0, 0.0), (yx, math.sqrt(1.0 - yx * yx), 0.0),
            (zx, zy, math.sqrt(1.0 - zx * zx - zy * zy)))
    return tuple(a * x + b * y + c * z for a, b, c in rows for x, y, z in columns)


def _response(model, seed, run, name):
    scale = tuple(s + d for s, d in zip(model.scale, drawn_once(seed, run, f'{name}.scale_factor',
                                                                model.scale_sigma)))
    return _if_any(scale, model.asymmetry, model.quadratic, model.cubic)


def discrete_lag(frequency_hz, order, dt_s):
    """
    Return the exact discretisation of a lag over one interval with constant input.

    First order: x' = w (u - x) with w = 2 pi f. Second order (Butterworth):
    x'' + sqrt(2) w x' + w^2 x = w^2 u.

    Returns
    -------
    a, b, c, d : matrix that takes (output - input, rate of the output) from the start of the
        interval to its end
    m, n : weights of the same two, at the start, whose weighted sum is the mean of
        (output - input) over the interval
    """
    w = 2.0 * math.pi * frequency_hz
    if w == 0.0:
        return (0.0,) * 6
    if order == 1:
        x = min(w * dt_s, GONE)
        return (elementary.exp(-x), 0.0, 0.0, 0.0, -elementary.expm1(-x) / (w * dt_s), 0.0)
    h = w * math.sqrt(0.5)
    decay, (s, c) = elementary.exp(-min(h * dt_s, GONE)), elementary.sincos(h * dt_s)
    a, b = decay * (c + s), decay * s / h
    e, d = -2.0 * h * decay * s, decay * (c - s)
    mean = -1.0 / (w * w * dt_s)
    return (a, b, e, d, mean * (e + 2.0 * h * (a - 1.0)), mean * (d - 1.0 + 2.0 * h * b))


class AdditiveNoise:
    """
    All additive errors of a triad: a fixed bias, white noise and processes.

    Attributes
    ----------
    fixed : (3,) bias of this run
    white : (3,) standard deviations of the white noise of a sample, or None
    stream : IndexedNoise of the white noise, or None
    processes : functions (first block, count) that return rows (n, 3); their sum is added

    """

    def __init__(self, model, seed, run, name, dt_s):
        self.fixed = np.array([b + d for b, d in zip(model.bias, drawn_once(
            seed, run, f'{name}.turn_on_bias', model.turn_on_sigma))])
        self.white = self.stream = None
        if any(model.white):
            self.white = np.array(model.white) / math.sqrt(dt_s)
            self.stream = indexed_noise(seed, run, f'{name}.white', 3)
        self.processes = []
        hour = tuple(s / 60.0 if math.isinf(t) else s
                     for s, t in zip(model.gauss_markov_sigma, model.gauss_markov_time))
        # The Gauss-Markov process keeps the old name of its stream, so that a given seed still
        # draws the same numbers.
        for term, sigma, time in (('in_run_bias', hour, model.gauss_markov_time),
                                  ('walk', model.walk, (math.inf,) * 3)):
            if any(sigma):
                self._add(Processes(seed, run, f'{name}.{term}', sigma, time, dt_s))
        if any(model.flicker):
            sigma = np.multiply.outer([FLICKER_SIGMA] * len(FLICKER_TIMES), model.flicker)
            time = np.repeat(FLICKER_TIMES, 3)
            self._add(Processes(seed, run, f'{name}.flicker', sigma.ravel(), time, dt_s))

    def _add(self, made):
        """Add Processes whose columns belong to the axes x, y, z, x, y, z and so on."""
        self.processes.append(lambda first, count: made.sums(first, count, 3))

    def __call__(self, first, count):
        """Return the errors (n, 3) of ``count`` blocks of samples, the first being ``first``."""
        total = np.empty((count * BLOCK, 3))
        total[:] = self.fixed
        if self.white is not None:
            total += self.white * self.stream.normal_blocks(first, count)
        for process in self.processes:
            total += process(first, count)
        return total

    def bias(self, index):
        """Return the errors (3,) of a sample, without the white noise."""
        block, row = divmod(index, BLOCK)
        total = self.fixed.copy()
        for process in self.processes:
            total += process(block, 1)[row]
        return total


def make_noise(model, seed, run, name, dt_s):
    """Return the AdditiveNoise of a triad, or None if all its terms are zero."""
    noise = AdditiveNoise(model, seed, run, name, dt_s)
    if noise.white is None and not noise.processes and not noise.fixed.any():
        return None
    return noise
