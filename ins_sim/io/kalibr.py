"""
The imu.yaml of Kalibr, of the instrument that an IMU is simulated with.

Kalibr knows two processes of a channel, white noise and a random walk of the bias, each by its
density in SI units; it refuses zero.  docs/how_to/recipes/kalibr.md says what becomes of the
others.
"""

import math

from ins_sim.core.sensors.imu.triad_model import FLICKER_FLOOR, triad_model
from ins_sim.settings.shown import listed
from .whole_file import check_file, write_whole

# About the length of a recording for Kalibr, s: over it a walk has to grow as the bias does.
RECORDING_S = 60.0
# A Gauss-Markov process without correlation time is a walk by its sigma in an hour, s.
HOUR_S = 3600.0
TRIADS = {'gyroscope': ('gyro', 'rad/s'), 'accelerometer': ('accelerometer', 'm/s^2')}
FIELDS = (('noise_density', 'white', '{}/sqrt(Hz)'),
          ('random_walk', 'bias', '{}/s/sqrt(Hz)'))


def bias_walk(model):
    """
    Return the densities by axis of the random walks nearest to the bias of a TriadModel.

    They are in U/s/sqrt(Hz), U of the model.  Over RECORDING_S they have the Allan deviation of
    walk and flicker noise together, K sqrt(t/3) and 0.664 B; a Gauss-Markov process adds the walk
    that it begins as.
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
    Write an imu.yaml; return sentences on what was written and which axes differ.

    settings: ImuSensorSettings; topic: of the Imu in the bags; force: replace a file that is
    there.  Raises ValueError or OSError, one sentence, where the instrument has no noise, or
    path will not do.
    """
    check_file(path, force)
    if settings.gyro.model != 'ideal':
        raise ValueError(f'gyro.model is {settings.gyro.model}; expected ideal with gyro.errors: '
                         'the noise of a tuned gyro has no place in imu.yaml')
    lines, differing = [], []
    for triad, (name, unit) in TRIADS.items():
        model = triad_model(getattr(settings, name).errors, 1.0 / settings.rate_hz,
                            f'{name}.errors')
        densities = {'white': model.white, 'bias': bias_walk(model)}
        for field, process, text in FIELDS:
            values, key = densities[process], f'{triad}_{field}'
            if max(values) <= 0.0:
                raise ValueError(f'{key} would be 0, since {name}.errors has no '
                                 f'{"white noise" if process == "white" else "drifting bias"}; '
                                 'Kalibr expects more: give an instrument, such as '
                                 '--params-file imu_tactical_mems')
            if len(set(values)) > 1:
                differing.append(key)
            lines.append(f'{key}: {max(values):.6e}  # {text.format(unit)}')
    content = ['# IMU of ins_sim for Kalibr: continuous-time densities, SI units.', *lines,
               f'rostopic: {topic}', f'update_rate: {settings.rate_hz!r}  # Hz', '']
    write_whole(path, '\n'.join(content).encode())
    said = [f'written: {path}']
    if differing:
        said.append(f'the axes differ in {listed(differing)}; Kalibr knows one figure for all '
                    'three, so that of the worst axis was taken')
    return said
