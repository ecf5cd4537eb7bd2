"""NEES of an aided run: errors of the solution and of the other estimates of the filter."""

import numpy as np

from ins_sim.core.aiding.consistency import nees, TrueValues
from ins_sim.core.numerics.units import DEG

UNBIASED = (0.0, 0.0, 0.0)


class ErrorNormaliser:
    """
    Normalises the errors of runs of AidedSimulationSettings by the covariance of the filter.

    errors: InstrumentErrors of the run, None for a perfect instrument.
    """

    def __init__(self, settings, errors):
        self._errors = errors
        self._has_gyro_biases = settings.simulation.imu_sensor.gyro.model == 'ideal'
        meter = settings.velocity_meter
        ratio = meter.beam.sigma_theta_z_rad / meter.beam.sigma_theta_x_rad
        self._meter = (meter.antennas.mounting_yaw_arcmin / 60.0 * DEG, meter.surrogate.k_x,
                       (1.0 + meter.surrogate.k_z) * (ratio * ratio) - 1.0)

    def true_values(self, t_ns):
        """Return the TrueValues at an instant."""
        gyro = accelerometer = UNBIASED
        if self._errors is not None:
            gyro, accelerometer = self._errors.biases(t_ns)
        return TrueValues(gyro if self._has_gyro_biases else None, accelerometer, self._meter)

    def of(self, result):
        """
        Return NEES and degrees of freedom, (n, BLOCKS), at the output instants of an AidedResult.

        Its notes must be FilterNotes. At the first instant the errors are the drawn initial
        errors, which are not evaluated (NaN, 0).
        """
        errors = result.errors
        columns = (errors.attitude.tolist(), errors.velocity.tolist(), errors.position.tolist())
        found = [nees(note, level, self.true_values(t_ns)) for t_ns, note, *level in zip(
            errors.t_ns.tolist(), result.notes, *columns)]
        squares, freedoms = (np.array(part) for part in zip(*found))
        squares[0], freedoms[0] = np.nan, 0
        return squares, freedoms
