"""
From the ideal IMU to the instrument: the errors of both triads, applied to its readings.

Errors act on the mean rate and the mean specific force of a sampling interval.  They are a
function of seed, run and instant: the index of a sample is its motion time over the period.
"""

from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.settings.instrument_errors import AccelerometerErrors, GyroErrors
from ..sensor import Sensor
from .sampling import consecutive


def with_errors(settings):
    """
    Return the InstrumentErrors of ImuSensorSettings, or None where nothing is left to them.

    Raises ValueError where the error terms do not fit together.
    """
    gyro = outer_gyro_errors(settings)
    if gyro == GyroErrors() and settings.accelerometer.errors == AccelerometerErrors():
        return None
    return InstrumentErrors(settings, gyro)


def outer_gyro_errors(settings):
    """Return the GyroErrors to apply to body rates: tuned gyros have theirs by channel, inside."""
    return GyroErrors() if settings.gyro.model == 'dtg' else settings.gyro.errors


def reported_variances(settings):
    """
    Return the variances of a sample of ImuSensorSettings by axis, (rad/s)^2 and (m/s^2)^2.

    Those of white noise and pulses, or what the settings report in their place.
    """
    from .triad_model import white_variance
    dt = period_ns(settings.rate_hz) * 1e-9
    force = white_variance(settings.accelerometer.errors, dt, 'accelerometer.errors')
    if settings.gyro.model == 'dtg':
        from ..tuned_gyro.instrument import PairInstrument
        return PairInstrument(settings).variances, force
    return white_variance(settings.gyro.errors, dt, 'gyro.errors'), force


class InstrumentErrors:
    """The errors of gyros (GyroErrors) and accelerometers of one IMU in one run."""

    def __init__(self, settings, gyro_errors):
        # NumPy's generators cost a perfect node's start nothing
        from .triad_errors import TriadErrors
        self._dt_ns = period_ns(settings.rate_hz)
        dt = self._dt_ns * 1e-9
        triads = ((gyro_errors, 'gyro.errors'),
                  (settings.accelerometer.errors, 'accelerometer.errors'))
        self.gyro, self.accelerometer = (
            TriadErrors(errors, settings.seed, settings.run, name, dt, settings.temperature)
            for errors, name in triads)

    def take_over(self, before):
        """Go on where other InstrumentErrors are: from their lags and remainders of pulses."""
        self.gyro.state, self.accelerometer.state = before.gyro.state, before.accelerometer.state

    def step(self, t_ns, omega, f):
        """Return omega, f of the instrument for those of the ideal IMU at motion time t_ns."""
        index, t_s = t_ns // self._dt_ns, t_ns * 1e-9
        return (self.gyro.step(index, omega, f, t_s),
                self.accelerometer.step(index, f, f, t_s))

    def advance(self, imu):
        """Return the ImuSamples of the instrument; any cutting gives the bits of step."""
        t_s, omega, f = imu.t_ns * 1e-9, imu.omega.copy(), imu.f.copy()
        for part in consecutive(imu.t_ns // self._dt_ns):
            first = int(imu.t_ns[part.start]) // self._dt_ns
            force, when = imu.f[part], t_s[part]
            omega[part] = self.gyro.advance(first, imu.omega[part], force, when)
            f[part] = self.accelerometer.advance(first, force, force, when)
        return ImuSamples(imu.t_ns, omega, f, imu.parity)


def changed(imu, settings):
    """
    Return the IMU with the biases and the fault of other ImuSensorSettings, from now on.

    imu: of ``stream.make_imu``; its readings go on where they are, with what it carries, and are
    those of an IMU that had these settings from the start as far as nothing is carried.
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
    """An IMU, ``ideal``, with push and reset whose readings pass through InstrumentErrors."""

    def __init__(self, imu, errors):
        self.ideal, self.errors = imu, errors
        self.reset, self.pair, self.samples = imu.reset, imu.pair, imu.samples

    @property
    def next_made_ns(self):
        """Motion time of the next reading that is not made yet, of the ideal IMU."""
        return self.ideal.next_made_ns

    def push(self, *sample):
        """Return the readings that a truth sample completes, as the ideal IMU does."""
        return [(t_ns, *self.errors.step(t_ns, omega, f), parity)
                for t_ns, omega, f, parity in self.ideal.push(*sample)]

    def advance(self, truth):
        """Return the ImuSamples of a Truth record or of a part of one, those of single pushes."""
        try:
            ideal = self.ideal.advance(truth)
        except StreamFault as fault:
            fault.readings = self.errors.advance(fault.readings)
            raise
        return self.errors.advance(ideal)
