"""Titles of runs."""

from ins_sim import parameter_files, resources
from ins_sim.report.titles import length_words, title
import pytest


@pytest.mark.parametrize('files, assignments, words', [
    (('racetrack', 'imu_tactical_fog'), (), 'Racetrack flight, tactical FOG, 100 Hz, 1 h'),
    (('cruise', 'imu_tactical_mems'), ('duration_s:=600.0',),
     'Cruise flight, tactical MEMS, 100 Hz, 10 min'),
    (('racetrack', 'imu_tactical_dtg'), (), 'Racetrack flight, tactical DTG, 100 Hz, 1 h'),
    (('motion_2', 'delay_y_1us'), ('duration_s:=90.0',),
     'Two-axis rotation (motion 2), ideal IMU, gyro delay y 1 us, 100 Hz, 1.5 min'),
    (('motion_1', 'delays_2_1_3us'), (),
     'Rocking about north (motion 1), ideal IMU, gyro delays x 2, y 1, z 3 us, 100 Hz, 1 h'),
    (('racetrack', 'imu_tactical_fog'), ('gyro.errors.bandwidth_hz:=[100.0, 100.0, 100.0]',),
     'Racetrack flight, tactical FOG with other bandwidth hz, 100 Hz, 1 h'),
    (('racetrack',), ('gyro.errors.bias_deg_h:=[1.0, 0.0, 0.0]',),
     'Racetrack flight, IMU with gyro errors, 100 Hz, 1 h'),
])
def test_a_title_names_motion_instrument_and_rate(files, assignments, words):
    """A title names motion, instrument and rate; a preset is named even if errors are changed."""
    settings = parameter_files.read([resources.config(name) for name in files], assignments)
    assert title(settings) == words


@pytest.mark.parametrize('seconds, words', [
    (3600.0, '1 h'), (5400.0, '1.5 h'), (3000.0, '50 min'), (59.99999999999999, '1 min'),
    (60.00000000000001, '1 min'), (100.0, '100 s'), (0.5, '0.5 s'), (7201.0, '7201 s')])
def test_lengths(seconds, words):
    """A length is stated in the largest unit in which it is a round number."""
    assert length_words(seconds) == words
