"""The verb export: the imu.yaml of Kalibr, with numbers computed by hand."""

import math

from ins_sim.cli.main import main
import pytest
import yaml

DEG = math.pi / 180.0
# Allan deviation of flicker noise divided by its coefficient, IEEE Std 952.
FLOOR = math.sqrt(2.0 * math.log(2.0) / math.pi)
KEYS = {'accelerometer_noise_density', 'accelerometer_random_walk', 'gyroscope_noise_density',
        'gyroscope_random_walk', 'rostopic', 'update_rate'}


def export(*words):
    """Return the exit code of the command."""
    return main(['export', 'kalibr', *map(str, words)])


def test_a_preset_by_hand(tmp_path, capsys):
    """
    The MEMS IMU: 0.04 deg/sqrt(h), 0.03 m/s/sqrt(h); walks of 2 deg/h/sqrt(h), 200 ug/sqrt(h).

    Its flicker noise, 0.38 deg/h and 38 ug, adds as much over 60 s. Six digits are written.
    """
    path = tmp_path / 'imu.yaml'
    assert export(path, '--params-file', 'imu_tactical_mems', '-p', 'rate_hz:=200.0') == 0
    assert capsys.readouterr().out.split() == ['written:', str(path)]
    found = yaml.safe_load(path.read_text())
    assert set(found) == KEYS
    assert found['rostopic'] == '/imu/data_raw' and found['update_rate'] == 200.0
    deg_h, ug = DEG / 3600.0, 9.80665e-6
    expected = {
        'gyroscope_noise_density': 0.04 * DEG / 60.0,
        'accelerometer_noise_density': 0.03 / 60.0,
        'gyroscope_random_walk': math.hypot(
            2.0 * deg_h / 60.0, FLOOR * 0.38 * deg_h * math.sqrt(3.0 / 60.0)),
        'accelerometer_random_walk': math.hypot(
            200.0 * ug / 60.0, FLOOR * 38.0 * ug * math.sqrt(3.0 / 60.0))}
    assert expected['gyroscope_noise_density'] == pytest.approx(1.1636e-5, rel=1e-4)
    assert {key: found[key] for key in expected} == pytest.approx(expected, rel=1e-6)


def test_a_walk_alone_and_a_gauss_markov_process(tmp_path):
    """K is exported as given; a Gauss-Markov process as sigma sqrt(2/T), or, endless, sigma/60."""
    path = tmp_path / 'imu.yaml'
    words = ['-p', 'gyro.errors.angle_random_walk_deg_sqrt_h:=[0.6, 0.6, 0.6]',
             '-p', 'accelerometer.errors.velocity_random_walk_m_s_sqrt_h:=[0.6, 0.6, 0.6]',
             '-p', 'gyro.errors.rate_random_walk_deg_h_sqrt_h:=[60.0, 60.0, 60.0]',
             '-p', 'accelerometer.errors.gauss_markov_sigma_ug:=[1000.0, 1000.0, 1000.0]']
    walks = {'200.0': 1e-3 * 9.80665 * 0.1, '.inf': 1e-3 * 9.80665 / 60.0}
    for time_s, walk in walks.items():
        assert export(path, *words, '--force', '-p',
                      f'accelerometer.errors.gauss_markov_time_s:=[{time_s}, 200.0, 200.0]') == 0
        found = yaml.safe_load(path.read_text())
        assert found['gyroscope_random_walk'] == pytest.approx(DEG / 3600.0, rel=1e-6)
        assert found['gyroscope_noise_density'] == pytest.approx(0.01 * DEG, rel=1e-6)
        # The values of the worst axis are exported.
        assert found['accelerometer_random_walk'] == pytest.approx(max(walk, walks['200.0']),
                                                                   rel=1e-6)


def test_axes_that_differ(tmp_path, capsys):
    """If the axes differ, the worst is used, and one note states this."""
    path = tmp_path / 'imu.yaml'
    assert export(path, '--params-file', 'imu_tactical_mems', '--topic', '/left/imu/data_raw',
                  '-p', 'imu_sensor:gyro.errors.angle_random_walk_deg_sqrt_h:=[0.1, 0.3, 0.2]'
                  ) == 0
    said = capsys.readouterr().out.replace('\n', ' ')
    assert 'the axes differ in gyroscope_noise_density; Kalibr has one value' in said
    found = yaml.safe_load(path.read_text())
    assert found['gyroscope_noise_density'] == pytest.approx(0.3 * DEG / 60.0, rel=1e-6)
    assert found['rostopic'] == '/left/imu/data_raw'


@pytest.mark.parametrize('words, said', [
    ([], 'gyroscope_noise_density would be 0, because gyro.errors has no white noise; expected '
         'more than 0'),
    (['-p', 'gyro.errors.angle_random_walk_deg_sqrt_h:=[0.1, 0.1, 0.1]'],
     'gyroscope_random_walk would be 0, because gyro.errors has no drifting bias'),
    (['--params-file', 'imu_tactical_dtg'], 'gyro.model is dtg; expected ideal'),
    (['--params-file', 'absent'], "no config named 'absent'")])
def test_refusals(words, said, tmp_path, capsys):
    """Settings that cannot be exported give one message and no file."""
    path = tmp_path / 'imu.yaml'
    assert export(path, *words) == 2
    error = capsys.readouterr().err
    assert said in error and error.count('\n') == 1 and error.startswith('ins_sim export: ')
    assert not path.exists()


def test_what_is_there_is_kept(tmp_path, capsys):
    """As in the other verbs, --force replaces a file, and never a folder."""
    path = tmp_path / 'imu.yaml'
    path.write_text('mine')
    instrument = ['--params-file', 'imu_tactical_fog']
    assert export(path, *instrument) == 2
    assert f'{path} exists; expected a new file (or --force)' in capsys.readouterr().err
    assert path.read_text() == 'mine'
    assert export(path, *instrument, '--force') == 0
    assert 'rostopic' in path.read_text()
    assert export(tmp_path, *instrument, '--force') == 2
    assert 'is not a file; --force replaces only files' in capsys.readouterr().err


@pytest.mark.parametrize('words', [
    '--params-file racetrack --params-file imu_tactical_fog',
    '--aided --params-file route_flight --params-file imu_tactical_fog -p window.cycles:=100'])
def test_the_instrument_of_a_run(words, tmp_path):
    """The parameters.yaml of a run, aided or not, gives the same file as its preset."""
    assert main(['simulate', *words.split(), '-p', 'duration_s:=2.0', '-o',
                 str(tmp_path / 'run')]) == 0
    settings = tmp_path / 'run' / 'parameters.yaml'
    assert export(tmp_path / 'run.yaml', '--params-file', settings) == 0
    assert export(tmp_path / 'preset.yaml', '--params-file', 'imu_tactical_fog') == 0
    assert (tmp_path / 'run.yaml').read_text() == (tmp_path / 'preset.yaml').read_text()
