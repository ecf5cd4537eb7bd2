"""
The errors of both triads, applied to the readings of the ideal IMU.

Errors act on the mean rate and the mean specific force of a sampling interval. They are functions
of seed, run and instant: the index of a sample is its motion time divided by the period.
"""

from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.numerics.units import STANDARD_GRAVITY
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.settings.instrument_errors import AccelerometerErrors, GyroErrors
from ..sensor import Sensor
from .sampling import consecutive

# Angular rate, rad/s, and specific force, m/s^2, in level flight.
STILL, LEVEL = (0.0, 0.0, 0.0), (0.0, 0.0, STANDARD_GRAVITY)


def with_errors(settings):
    """
    Return the InstrumentErrors of ImuSensorSettings, or None if all of them are zero.

    Raises ValueError for error terms that are inconsistent.
    """
    gyro = outer_gyro_errors(settings)
    if gyro == GyroErrors() and settings.accelerometer.errors == AccelerometerErrors():
        return None
    return InstrumentErrors(settings, gyro)


def outer_gyro_errors(settings):
    """Return the GyroErrors acting on body rates; tuned gyros apply theirs to each channel."""
    return GyroErrors() if settings.gyro.model == 'dtg' else settings.gyro.errors


def reported_variances(settings):
    """
    Return the variances to publish with a sample, by axis, (rad/s)^2 and (m/s^2)^2.

    They are those of white noise and pulses, or the values that the settings give instead.
    """
    from .triad_model import white_variance
    dt = period_ns(settings.rate_hz) * 1e-9
    force = white_variance(settings.accelerometer.errors, dt, 'accelerometer.errors')
    if settings.gyro.model == 'dtg':
        from ..tuned_gyro.instrument import PairInstrument
        return PairInstrument(settings).variances, force
    return white_variance(settings.gyro.errors, dt, 'gyro.errors'), force


class InstrumentErrors:
    """
    The errors of the gyros and accelerometers of one IMU in one run.

    Parameters
    ----------
    settings : ImuSensorSettings
    gyro_errors : GyroErrors acting on the body rates
    """

    def __init__(self, settings, gyro_errors):
        # Imported only if needed: NumPy's generators would slow down the start of a node.
        from .triad_errors import TriadErrors
        self._dt_ns = period_ns(settings.rate_hz)
        dt = self._dt_ns * 1e-9
        triads = ((gyro_errors, 'gyro.errors'),
                  (settings.accelerometer.errors, 'accelerometer.errors'))
        self.gyro, self.accelerometer = (
            TriadErrors(errors, settings.seed, settings.run, name, dt, settings.temperature)
            for errors, name in triads)

    def take_over(self, before):
        """Continue from the lags and remainders of pulses of other InstrumentErrors."""
        self.gyro.state, self.accelerometer.state = before.gyro.state, before.accelerometer.state

    def step(self, t_ns, omega, f):
        """
        Return omega and f with errors.

        Parameters
        ----------
        t_ns : motion time, ns
        omega, f : reading of the ideal IMU, rad/s and m/s^2
        """
        index, t_s = t_ns // self._dt_ns, t_ns * 1e-9
        return (self.gyro.step(index, omega, f, t_s),
                self.accelerometer.step(index, f, f, t_s))

    def biases(self, t_ns):
        """
        Return the biases of gyros (rad/s) and accelerometers (m/s^2) of the sample at t_ns.

        They are evaluated in level unaccelerated flight, where errors of the scale factors and
        axes of the accelerometers are constant: a filter without states for these estimates them
        as part of the biases.
        """
        index = t_ns // self._dt_ns
        return (self.gyro.bias(index, STILL, LEVEL),
                self.accelerometer.bias(index, LEVEL, LEVEL))

    def advance(self, imu):
        """Return the ImuSamples of the instrument, same bits as ``step``, for any block length."""
        t_s, omega, f = imu.t_ns * 1e-9, imu.omega.copy(), imu.f.copy()
        for part in consecutive(imu.t_ns // self._dt_ns):
            first = int(imu.t_ns[part.start]) // self._dt_ns
            force, when = imu.f[part], t_s[part]
            omega[part] = self.gyro.advance(first, imu.omega[part], force, when)
            f[part] = self.accelerometer.advance(first, force, force, when)
        return ImuSamples(imu.t_ns, omega, f, imu.parity)


def changed(imu, settings):
    """
    Return the IMU with the biases and the fault of other ImuSensorSettings from now on.

    The lags, remainders and rotors carry on. Terms without such memory are the same as if the
    settings had applied from the start.

    Parameters
    ----------
    imu : as ``stream.make_imu`` returns it
    settings : ImuSensorSettings
    """
    before = None
    if isinstance(imu, ImuWithErrors):
        imu, before = imu.ideal, imu.errors
    if imu.pair is not None:
        imu.pair.change(settings)
    errors = with_errors(settings)
    if errors is None:
        return imu
    if before is not None:
        errors.take_over(before)
    return ImuWithErrors(imu, errors)


class ImuWithErrors(Sensor):
    """An IMU with errors: the readings of ``ideal`` pass through InstrumentErrors."""

    def __init__(self, imu, errors):
        self.ideal, self.errors = imu, errors
        self.reset, self.pair, self.samples = imu.reset, imu.pair, imu.samples

    @property
    def next_made_ns(self):
        """Motion time of the next reading that the ideal IMU has to compute, ns."""
        return self.ideal.next_made_ns

    def push(self, *sample):
        """Return the readings that a truth sample completes, see ``StreamImu.push``."""
        return [(t_ns, *self.errors.step(t_ns, omega, f), parity)
                for t_ns, omega, f, parity in self.ideal.push(*sample)]

    def advance(self, truth):
        """Return the ImuSamples of a Truth record or part of one; same bits as single pushes."""
        try:
            ideal = self.ideal.advance(truth)
        except StreamFault as fault:
            fault.readings = self.errors.advance(fault.readings)
            raise
        return self.errors.advance(ideal)
