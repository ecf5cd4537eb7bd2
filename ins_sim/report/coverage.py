"""Decide whether the prediction covers all errors of a run, so that both can be compared."""

from dataclasses import replace

from ins_sim.core.numerics.units import DEG_PER_HOUR
from ins_sim.settings.instrument_errors import AccelerometerErrors, GyroErrors, Sampling
from ins_sim.settings.strapdown import Initial
from ins_sim.settings.tuned_gyro import TunedGyroErrors, TunedGyroFault


def instrument_errors(settings):
    """Return the names of the IMU errors that are enabled in SimulationSettings."""
    sensor = settings.imu_sensor
    groups = {'accelerometer.errors': (sensor.accelerometer.errors, AccelerometerErrors()),
              'sampling': (sensor.sampling, Sampling())}
    if sensor.gyro.model == 'ideal':
        groups['gyro.errors'] = sensor.gyro.errors, GyroErrors()
    else:
        groups['gyro.dtg.errors'] = sensor.gyro.dtg.errors, TunedGyroErrors()
        groups['gyro.dtg.fault'] = sensor.gyro.dtg.fault, TunedGyroFault()
    return sorted(name for name, (given, none) in groups.items() if given != none)


def comparable(settings, prediction):
    """Return the prediction if it covers all error sources of the run, else None."""
    return None if instrument_errors(settings) else prediction


def comparable_with_twin(settings, prediction):
    """
    Return the prediction if it equals that of the run minus its zero-delay twin, else None.

    The twin has the same instrument errors, tuned gyros and initial errors as the run.
    """
    initial = replace(settings.strapdown.initial, after_s=0.0)
    delays_alone = settings.imu_sensor.gyro.model == 'ideal' and initial == Initial()
    return prediction if delays_alone and instrument_errors(settings) else None


def coverage_lines(settings, prediction):
    """Return the lines about what a prediction covers and how exact it is."""
    if prediction is None:
        return []
    lines = ['the prediction covers delays, tuned gyros and initial errors, linear in the errors; '
             f'second-order effects are at most {prediction.position_bound:.3g} m and '
             f'{prediction.drift_bound * DEG_PER_HOUR:.3g} deg/h (largest attitude error '
             f'{prediction.turned:.3g} rad)']
    names = instrument_errors(settings)
    if names:
        north, east = prediction.largest[1], prediction.largest[0]
        lines.append(f'errors of the instruments are enabled ({", ".join(names)}), which the '
                     f'prediction does not cover: its {north:.3g} m North and {east:.3g} m East '
                     'are the error without them and are not compared with measured errors')
    return lines
