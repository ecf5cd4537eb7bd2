"""One number for three equal axes, and white noise as a random walk or a density."""

import math

import numpy as np
import pytest

from ins_sim import parameter_files
from ins_sim.api.inputs import read_settings
from ins_sim.core.sensors.imu.error_sigmas import fixed_errors, triad_sigmas
from ins_sim.core.sensors.imu.triad_errors import TriadErrors
from ins_sim.core.sensors.imu.triad_model import triad_model, white_variance
from ins_sim.report.noise_terms import TRIADS
from ins_sim.settings.catalogue import build, flatten
from ins_sim.settings.by_node import ALL_NODES
from ins_sim.settings.gnss import GnssSettings
from ins_sim.settings.instrument_errors import AccelerometerErrors, GyroErrors

DT = 0.01
WALK, DENSITY = 'angle_random_walk_deg_sqrt_h', 'noise_density_rad_s_sqrt_hz'
# White noise of an IMU in both units, converted as users do it.
PAIRS = [(GyroErrors, WALK, DENSITY, math.radians(1.0) / 60.0),
         (AccelerometerErrors, 'velocity_random_walk_m_s_sqrt_h', 'noise_density_m_s2_sqrt_hz',
          1.0 / 60.0)]
FILE = """/**:
  ros__parameters:
    gyro: {errors: {angle_random_walk_deg_sqrt_h: 0.09, bias_deg_h: 3}}
"""


def test_a_number_in_a_file_in_an_assignment_and_in_python_is_three(tmp_path):
    """
    One number, also an integer, stands for three axes in files, assignments and Python.

    Strapdown and IMU then have equal triads.
    """
    path = tmp_path / 'scalars.yaml'
    path.write_text(FILE)
    for read in (parameter_files.read([path], ['accelerometer.errors.scale_factor_ppm:=-2.5']),
                 read_settings(str(path), {'accelerometer.errors.scale_factor_ppm': -2.5})):
        for node in (read.imu_sensor, read.strapdown):
            gyro = node.gyro.errors
            assert gyro.angle_random_walk_deg_sqrt_h == (0.09,) * 3
            assert gyro.bias_deg_h == (3.0,) * 3
            assert all(isinstance(value, float) for value in gyro.bias_deg_h)
            assert node.accelerometer.errors.scale_factor_ppm == (-2.5,) * 3
    assert GyroErrors(bias_deg_h=3.0) == GyroErrors(bias_deg_h=(3.0,) * 3)
    gnss = build(GnssSettings, {'errors.position_noise_m': 2})
    assert gnss.errors.position_noise_m == (2.0,) * 3
    assert 'angle_random_walk_deg_sqrt_h:\n        - 0.09\n        - 0.09\n        - 0.09' in \
        parameter_files.dump(read)


def test_places_and_rotations_take_no_single_number():
    """Positions and rotations need a list, and texts are refused for them and for axes."""
    names = {name for cls in ALL_NODES.values() for name, f in flatten(cls).items()
             if f.metadata['size'] == 3 and not f.metadata['equal_axes']}
    assert {'lever_arm_m', 'jump.offset_m'} <= names and not any('errors' in n for n in names)
    with pytest.raises(ValueError, match=r'^lever_arm_m is 2\.0; expected a list$'):
        build(GnssSettings, {'lever_arm_m': 2.0})
    for value in ('2', True, None):
        with pytest.raises(ValueError, match=f'^bias_deg_h is {value!r}; expected 3 numbers, or '
                           'one for all$'):
            build(GyroErrors, {'bias_deg_h': value})
    with pytest.raises(ValueError, match='^bias_deg_h is nan; expected a finite number$'):
        build(GyroErrors, {'bias_deg_h': math.nan})


@pytest.mark.parametrize('cls, walk, density, one', PAIRS)
def test_a_density_is_the_random_walk_in_other_units(cls, walk, density, one):
    """
    1 deg/sqrt(h) is pi/180/60 rad/s/sqrt(Hz): all quantities derived from N are the same.

    They agree to rounding.
    """
    given, same = cls(**{walk: 0.3}), cls(**{density: 0.3 * one})
    a, b = triad_model(given, DT), triad_model(same, DT)
    assert b.white == pytest.approx(a.white, rel=4e-16) and b.white == (0.3 * one,) * 3
    assert white_variance(same, DT) == pytest.approx(((0.3 * one) ** 2 / DT,) * 3, rel=1e-15)
    assert triad_sigmas(same, DT).white == pytest.approx(triad_sigmas(given, DT).white)
    zeros = np.zeros((1000, 3))
    noise = [TriadErrors(errors, 5, 0, 'gyro.errors', DT).advance(0, zeros, zeros, zeros[:, 0])
             for errors in (given, same)]
    assert noise[1] == pytest.approx(noise[0], rel=1e-14) and noise[0].std() > 0.0
    # Of a perfect mean nothing remains.
    assert fixed_errors(same) is None
    assert TRIADS['gyro'][1].unit == 'deg/sqrt(h)'


@pytest.mark.parametrize('cls, walk, density, one', PAIRS)
def test_both_are_refused(cls, walk, density, one):
    """Random walk and density together are refused with one message; a zero does not count."""
    with pytest.raises(ValueError) as raised:
        cls(**{walk: (0.0, 0.1, 0.0), density: 1e-4})
    assert str(raised.value) == (
        f'{cls.NAME}.{walk} is [0.0, 0.1, 0.0] and {cls.NAME}.{density} is [0.0001, 0.0001, '
        '0.0001]; expected one of them, and 0 for the other: both are the white noise')
    assert triad_model(cls(**{walk: 0.0, density: 1e-4}), DT).white == (1e-4,) * 3
    with pytest.raises(ValueError, match='noise_density_rad_s_sqrt_hz is -0.1 rad/s/sqrt'):
        triad_model(GyroErrors(noise_density_rad_s_sqrt_hz=-0.1), DT)


def test_a_range_below_the_noise_names_what_was_given():
    """The message about a range below the noise names the key that was set."""
    with pytest.raises(ValueError, match=r'white noise \(noise_density_rad_s_sqrt_hz\)'):
        triad_model(GyroErrors(saturation_deg_s=4.0, noise_density_rad_s_sqrt_hz=0.1), DT)
