"""The command budget and its folder, and the same from Python."""

import json

import numpy as np
import pytest

import ins_sim
from ins_sim.cli.main import main
from ins_sim.report.studies import budget as report

FILES = ['--params-file', 'racetrack', '--params-file', 'imu_tactical_fog', '-p',
         'duration_s:=60.0']
FIGURES = ('budget_position', 'budget_total', 'budget_sources', 'budget_ranking',
           'budget_velocity', 'budget_attitude')


@pytest.fixture(scope='module')
def study(tmp_path_factory):
    """Return the folder of an ensemble of 16 runs."""
    folder = tmp_path_factory.mktemp('study') / 'mc'
    assert main(['monte-carlo', *FILES, '--runs', '16', '--jobs', '1', '-o', str(folder)]) == 0
    return folder


@pytest.fixture(scope='module')
def written(study):
    """Return the folder of a budget with this comparison and two requirements."""
    folder = study.parent / 'budget'
    assert main(['budget', *FILES, '--require', 'horizontal rms 1 m at 60 s', '--require',
                 'horizontal cep95 8 m at 1 min', '--beside', str(study), '-o',
                 str(folder)]) == 0
    return folder


def test_what_is_written(written):
    """Figures, page, numbers and parameters are written; the page has the answers and is small."""
    names = {path.name for path in written.iterdir()}
    assert names >= {*(f'{name}.png' for name in (*FIGURES, 'budget_beside')), report.MARK,
                     report.ARRAYS, report.SETTINGS, 'report.html'}
    page = (written / 'report.html').read_text(encoding='utf-8')
    assert len(page) < 5_000_000 and 'no single source suffices' in page
    found = json.loads((written / report.MARK).read_text())
    assert found['answer'].startswith('After 1 min the horizontal position error is ')
    assert [r['met'] for r in found['requirements']] == [False, False]
    assert 'inside their 99.9 % interval' in found['notes'][-1]
    with np.load(written / report.ARRAYS) as arrays:
        assert arrays['covariance'].shape[1:] == (361, 9, 9)
        assert len(arrays['random']) == len(arrays['covariance'])
    again = ins_sim.read_settings(written / report.SETTINGS)
    assert again == ins_sim.read_settings(['racetrack', 'imu_tactical_fog'],
                                          {'duration_s': 60.0})


@pytest.mark.slow
def test_python_says_the_same(study, tmp_path):
    """``ins_sim.budget`` gives tables for pandas and xarray, and the same folder as the verb."""
    pandas, xarray = pytest.importorskip('pandas'), pytest.importorskip('xarray')
    settings = ins_sim.read_settings(['racetrack', 'imu_tactical_fog'], {'duration_s': 60.0})
    found = ins_sim.budget(settings, [33.3], beside=study)
    frame = found.to_dataframe('azimuth')
    assert isinstance(frame, pandas.DataFrame) and len(frame) == 362
    assert frame.index[-1] == 60_000_000_000
    assert frame['rms'].to_numpy() == pytest.approx(found.rms('azimuth'))
    data = found.to_xarray()
    assert isinstance(data, xarray.Dataset)
    one = data.covariance.sel(source='gyro.errors.turn_on_bias_sigma_deg_h', error='position_east',
                              error_2='position_east', time=33.3)
    assert float(one) == pytest.approx(found.contributions('east')[
        'gyro.errors.turn_on_bias_sigma_deg_h'][found.linear.at(33.3)] ** 2)
    assert [q.name for q in found.compared()] == ['horizontal', 'east', 'north', 'velocity',
                                                  'tilt', 'azimuth']
    assert found.error_circle(0.95)[-1] > found.error_circle(0.5)[-1] > 0.0
    found.save(tmp_path / 'b', requirements=['tilt rms 1 arcsec at 60 s'])
    with pytest.raises(ValueError, match='exists'):
        found.save(tmp_path / 'b')
    found.save(tmp_path / 'b', overwrite=True)
    assert repr(found).startswith('<ErrorBudget: ')


def refused(capsys, *words):
    """Return the message with which the command refuses, exit code 2."""
    assert main(['budget', *words]) == 2
    captured = capsys.readouterr()
    assert captured.err.count('\n') == 1 and captured.err.startswith('ins_sim budget: ')
    return captured.err


@pytest.mark.parametrize('text', [
    'horizonal rms 1852 m at 60 s', 'horizontal rms 1852 at 60 s', 'horizontal rms -1 m at 60 s',
    'horizontal rms nan m at 60 s', 'azimuth cep50 1 deg at 60 s', 'azimuth rms 3 m at 60 s', '',
    'horizontal rms 1 m at 60 s please', 'horizontal rms 1e400 m at 60 s', 'x' * 5000])
def test_a_misspelt_requirement_gets_the_grammar(text, tmp_path, capsys):
    """A misspelt requirement is answered by the grammar before anything is computed."""
    said = refused(capsys, *FILES, '--require', text, '-o', str(tmp_path / 'b'))
    assert 'QUANTITY STATISTIC NUMBER UNIT at NUMBER TIME' in said and len(said) < 800
    assert not (tmp_path / 'b').exists()


def test_what_cannot_be_answered_is_refused(study, tmp_path, capsys):
    """A late requirement, one run, other settings, no study, and tuned gyros are refused."""
    out = ['-o', str(tmp_path / 'b')]
    assert 'at most 60 s' in refused(
        capsys, *FILES, '--require', 'horizontal rms 1 m at 61 s', *out)
    assert 'expected at least 2' in refused(capsys, *FILES, '--runs', '1', *out)
    assert 'expected at least 2' in refused(capsys, *FILES, '--runs', '-3', *out)
    assert 'the settings of imu_sensor' in refused(
        capsys, *FILES, '-p', 'gyro.errors.bias_deg_h:=[1.0, 0.0, 0.0]', '--beside', str(study),
        *out)
    assert 'holds no ensemble.npz' in refused(capsys, *FILES, '--beside', str(tmp_path), *out)
    assert 'gyro.model is dtg in a budget' in refused(
        capsys, '--params-file', 'dtg_motion_2', *out)
    assert 'expected less than duration_s' in refused(
        capsys, *FILES, '-p', 'initial.after_s:=60.0', *out)
    assert not (tmp_path / 'b').exists()


def test_damaged_studies_are_refused(study, tmp_path, capsys):
    """An invalid ensemble.npz and one with missing arrays are refused."""
    for content in (b'', b'PK\x03\x04 nothing', None):
        folder = tmp_path / 'study'
        folder.mkdir(exist_ok=True)
        (folder / 'parameters.yaml').write_text((study / 'parameters.yaml').read_text())
        if content is None:
            np.savez(folder / 'ensemble.npz', t_ns=np.arange(3))
        else:
            (folder / 'ensemble.npz').write_bytes(content)
        assert 'expected the arrays of ins_sim monte-carlo' in refused(
            capsys, *FILES, '--beside', str(folder), '-o', str(tmp_path / 'b'))


def test_a_requirement_that_is_met_is_said(capsys, tmp_path):
    """A requirement that is met is stated; instruments without errors have a budget of zero."""
    assert main(['budget', '--params-file', 'racetrack', '-p', 'duration_s:=10.0', '--require',
                 'horizontal cep50 1 m at 10 s', '-o', str(tmp_path / 'b')]) == 0
    said = capsys.readouterr().out
    assert 'which meets it' in said and 'no error that affects the position' in said


@pytest.mark.slow
def test_what_linear_theory_does_not_cover_is_said(capsys, tmp_path):
    """Limits of linear theory are stated: an azimuth sigma of 20 deg, and rates out of range."""
    assert main(['budget', '--params-file', 'motion_2', '-p', 'duration_s:=10.0', '-p',
                 'initial.azimuth_sigma_mrad:=350.0', '-p',
                 'gyro.errors.saturation_deg_s:=[40.0, 40.0, 40.0]', '--runs', '16', '-p',
                 'gyro.errors.turn_on_bias_sigma_deg_h:=[1.0, 1.0, 1.0]', '-o',
                 str(tmp_path / 'b')]) == 0
    said = capsys.readouterr().out
    assert 'Linear theory holds until 0 s' in said
    assert 'the input of the gyros exceeds their range' in said
    assert 'The runs have no random initial errors' in said


def test_two_errors_that_cancel_need_both():
    """If fixed errors alone exceed a requirement, a message states that no random one helps."""
    settings = ins_sim.read_settings('racetrack', {
        'duration_s': 60.0, 'gyro.errors.bias_deg_h': 10.0,
        'gyro.errors.turn_on_bias_sigma_deg_h': 1.0})
    answer = ins_sim.budget(settings).requirement('horizontal rms 1 m at 60 s')
    assert answer.random is None and answer.everything == pytest.approx(1.0 / answer.found)
    assert 'as the fixed ones exceed it' in report.requirement_sentence(answer)


def test_sensitivities_are_derivatives():
    """
    Sensitivities equal differences of the rms for a random, a fixed and an inverse parameter.
    """
    values = {'duration_s': 200.0, 'gyro.errors.turn_on_bias_sigma_deg_h': [1.0, 2.0, 3.0],
              'gyro.errors.bias_deg_h': 2.0, 'gyro.errors.bandwidth_hz': 50.0}

    def rms(**changed):
        return ins_sim.budget(ins_sim.read_settings('racetrack', {**values, **changed})).rms()[-1]

    found = ins_sim.budget(ins_sim.read_settings('racetrack', values))
    slopes = {(s.source.key, s.axis): s.slope for s in found.sensitivities()}
    for key, axis, less, more, step in (
            ('gyro.errors.turn_on_bias_sigma_deg_h', 'y', [1.0, 1.99, 3.0], [1.0, 2.01, 3.0],
             0.02), ('gyro.errors.bias_deg_h', '', 1.99, 2.01, 0.02)):
        slope = (rms(**{key: more}) - rms(**{key: less})) / step
        assert slopes[key, axis] == pytest.approx(slope, rel=1e-3)
    # The discretisation of a lag changes with its bandwidth too.
    key = 'gyro.errors.bandwidth_hz'
    slope = (rms(**{key: 51.0}) - rms(**{key: 49.0})) / 2.0
    assert slopes[key, ''] == pytest.approx(slope, rel=0.1)


@pytest.mark.slow
def test_instants_that_are_not_compared_are_counted(tmp_path, capsys):
    """
    A budget of 360 intervals has all instants of 10 intervals, but only the last of 7.

    With one run nothing is compared.
    """
    said = []
    for instants, runs in ((11, 2), (8, 2), (11, 1)):
        study = tmp_path / f'mc_{instants}_{runs}'
        assert main(['monte-carlo', *FILES, '--runs', str(runs), '--jobs', '1', '--instants',
                     str(instants), '-o', str(study)]) == 0
        if runs == 2:
            assert main(['budget', *FILES, '--beside', str(study), '-o',
                         str(tmp_path / f'b_{instants}')]) == 0
            said.append(' '.join(capsys.readouterr().out.split()))
    assert 'instants of the ensemble are left out' not in said[0]
    assert '6 of the 8 instants of the ensemble are left out' in said[1]
    capsys.readouterr()
    assert 'has 1 run that has not diverged; expected at least 2' in refused(
        capsys, *FILES, '--beside', str(study), '-o', str(tmp_path / 'b'))


def test_ideal_instruments_are_not_said_to_agree(capsys, tmp_path):
    """Ideal instruments have no scatter, so nothing is compared."""
    assert main(['budget', '--params-file', 'racetrack', '-p', 'duration_s:=10.0', '--runs', '2',
                 '-o', str(tmp_path / 'b')]) == 0
    said = ' '.join(capsys.readouterr().out.split())
    assert 'is not compared, because no quantity' in said and 'inside its' not in said


def test_an_empty_name_of_a_study_is_refused(capsys, tmp_path):
    """An empty name of a study is refused."""
    assert 'holds no ensemble.npz' in refused(
        capsys, *FILES, '--beside', '', '-o', str(tmp_path / 'b'))


def test_a_factor_is_never_shown_as_zero(capsys, tmp_path):
    """The factor of a requirement that needs a billionth is not printed as zero."""
    assert main(['budget', *FILES, '--require', 'horizontal rms 1e-9 m at 60 s', '-o',
                 str(tmp_path / 'b')]) == 0
    assert 'all errors x 1.2' in ' '.join(capsys.readouterr().out.split())
