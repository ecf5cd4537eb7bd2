"""
Write the imu.yaml of Kalibr for the simulated IMU.

Kalibr models white noise and a random walk of the bias, each given by its density in SI units,
which must not be zero.  For the other errors see docs/how_to/recipes/kalibr.md.
"""

import math

from ins_sim.core.sensors.imu.triad_model import FLICKER_FLOOR, triad_model
from ins_sim.settings.shown import listed
from .whole_file import check_file, write_whole

# Typical length of a recording for Kalibr, s, over which walk and bias must agree.
RECORDING_S = 60.0
# A Gauss-Markov process of infinite correlation time walks by its sigma in this time, s.
HOUR_S = 3600.0
TRIADS = {'gyroscope': ('gyro', 'rad/s'), 'accelerometer': ('accelerometer', 'm/s^2')}
FIELDS = (('noise_density', 'white', '{}/sqrt(Hz)'),
          ('random_walk', 'bias', '{}/s/sqrt(Hz)'))


def bias_walk(model):
    """
    Return the densities, by axis, of the random walks that approximate the bias of a TriadModel.

    The unit is U/s/sqrt(Hz), where U is the unit of the model.  At RECORDING_S their Allan
    deviation equals that of random walk, K sqrt(t/3), and flicker noise, 0.664 B, together; a
    Gauss-Markov process contributes the random walk of its initial growth.
    """
    found = []
    for k in range(3):
        floor, time_s = FLICKER_FLOOR * model.flicker[k], model.gauss_markov_time[k]
        sigma = model.gauss_markov_sigma[k]
        markov = sigma * sigma * (2.0 / time_s if math.isfinite(time_s) else 1.0 / HOUR_S)
        found.append(math.sqrt(model.walk[k] ** 2 + 3.0 * floor * floor / RECORDING_S + markov))
    return tuple(found)


def export_kalibr(path, settings, topic, force=False):
    """
    Write an imu.yaml; return sentences about its content and about axes that differ.

    Parameters
    ----------
    path : file to write
    settings : ImuSensorSettings
    topic : topic of the Imu messages in the bags
    force : replace an existing file

    Raises
    ------
    ValueError, OSError
        If the instrument has no noise, or the file cannot be written.
    """
    check_file(path, force)
    if settings.gyro.model != 'ideal':
        raise ValueError(f'gyro.model is {settings.gyro.model}; expected ideal with gyro.errors: '
                         'imu.yaml cannot describe the noise of a tuned gyro')
    lines, differing = [], []
    for triad, (name, unit) in TRIADS.items():
        model = triad_model(getattr(settings, name).errors, 1.0 / settings.rate_hz,
                            f'{name}.errors')
        densities = {'white': model.white, 'bias': bias_walk(model)}
        for field, process, text in FIELDS:
            values, key = densities[process], f'{triad}_{field}'
            if max(values) <= 0.0:
                raise ValueError(f'{key} would be 0, because {name}.errors has no '
                                 f'{"white noise" if process == "white" else "drifting bias"}; '
                                 'expected more than 0 for Kalibr: give an instrument, such as '
                                 '--params-file imu_tactical_mems')
            if len(set(values)) > 1:
                differing.append(key)
            lines.append(f'{key}: {max(values):.6e}  # {text.format(unit)}')
    content = ['# IMU of ins_sim for Kalibr: continuous-time densities, SI units.', *lines,
               f'rostopic: {topic}', f'update_rate: {settings.rate_hz!r}  # Hz', '']
    write_whole(path, '\n'.join(content).encode())
    said = [f'written: {path}']
    if differing:
        said.append(f'the axes differ in {listed(differing)}; Kalibr has one value for all three '
                    'axes, so the value of the worst axis is used')
    return said
