"""The offline verbs: outputs, exit codes, messages, and complete files only."""

import json

import numpy as np
import pytest
from support.studies import LATE_MOTION_2_WORDS

from ins_sim.cli.main import main
from ins_sim.own_folders import own_folder
from ins_sim.report.runs import page


def test_simulate_writes_a_run(tmp_path, capsys):
    """Arrays, parameters, summary and a figure; the parameters can be used again."""
    out = tmp_path / 'run'
    arguments = ['simulate', *LATE_MOTION_2_WORDS, '-p', 'duration_s:=5.0']
    assert main([*arguments, '-o', str(out)]) == 0
    shown = capsys.readouterr().out
    assert 'mean drift east' in shown and 'predicted' in shown and 'zero-delay twin' in shown
    assert (out / 'errors.png').read_bytes().startswith(b'\x89PNG')
    rows = json.loads((out / 'summary.json').read_text())
    assert rows[0]['name'] == 'mean drift east'
    with np.load(out / 'run.npz') as run:
        assert run['errors_position'].shape == (501, 3)
        assert run['imu_omega'].shape == (501, 3)
        first = run['errors_position']
    again = tmp_path / 'again'
    assert main(['simulate', '--params-file', str(out / 'parameters.yaml'), '-o',
                 str(again)]) == 0
    with np.load(again / 'run.npz') as run:
        assert np.array_equal(run['errors_position'], first)


def test_simulate_shows_published_figures_only_for_their_study(tmp_path, capsys):
    """Published values are shown only for the study they belong to, the hour of motion 2."""
    assert main(['simulate', *LATE_MOTION_2_WORDS, '-p', 'duration_s:=5.0', '-o',
                 str(tmp_path / 'run'), '--no-twin']) == 0
    assert 're-derived' not in capsys.readouterr().out
    assert main(['predict', *LATE_MOTION_2_WORDS]) == 0
    shown = capsys.readouterr().out
    assert '4472.1' in shown and '0.0334932' in shown and "psi' = -2 gamma'" in shown


def test_notes_on_the_prediction_come_with_its_column(tmp_path, capsys):
    """
    simulate describes the prediction only where it applies.

    With instrument errors as the only errors there is no predicted column, and no note on it;
    with delays in addition the difference from the zero-delay run is predicted.
    """
    words = ['simulate', '--params-file', 'motion_2', '--params-file', 'imu_tactical_fog', '-p',
             'duration_s:=5.0', '-o']
    assert main([*words, str(tmp_path / 'run')]) == 0
    shown = capsys.readouterr().out
    assert 'measured' in shown and 'predicted' not in shown and 'the prediction' not in shown
    assert main([*words, str(tmp_path / 'late'), '-p', 'gyro.delay_us.y:=1.0']) == 0
    shown = ' '.join(capsys.readouterr().out.split())
    assert 'predicted' in shown and 'the prediction covers' in shown


def test_a_run_is_never_overwritten_without_force(tmp_path, capsys):
    """An existing run is kept with exit code 2; --force replaces a run, and only a run."""
    out = tmp_path / 'run'
    arguments = ['simulate', '-p', 'duration_s:=1.0', '-o', str(out)]
    assert main(arguments) == 0
    before = (out / 'run.npz').read_bytes()
    assert main(arguments) == 2
    assert 'exists; expected a new folder' in capsys.readouterr().err
    assert (out / 'run.npz').read_bytes() == before
    assert main([*arguments, '--force']) == 0
    other = tmp_path / 'other'
    other.mkdir()
    (other / 'precious').write_text('x')
    assert main(['simulate', '-p', 'duration_s:=1.0', '-o', str(other), '--force']) == 2
    assert (other / 'precious').exists()


def test_a_failed_write_leaves_nothing(tmp_path, monkeypatch):
    """A failure while writing leaves no folder that could be taken for a run."""
    def fail(*arguments):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(page, 'save_chart', fail)
    assert main(['simulate', '-p', 'duration_s:=1.0', '-o', str(tmp_path / 'run')]) == 2
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(ValueError, match='exists'):
        own_folder.check_free(tmp_path)


@pytest.mark.parametrize('arguments, sentence', [
    (['-p', 'gyro.delay.x:=1'], "nearest known one is 'gyro.delay_us.x'"),
    (['--params-file', 'motion_3'], "no config named 'motion_3'; expected one of aggressive"),
    (['--params-file', 'absent.yaml'], 'absent.yaml'),
    (['--params-file', '/dev/zero'], '/dev/zero is a device; expected a YAML file'),
    (['-p', 'motion.kind:=recording', '-p', 'motion.recording.path:=absent.csv'], 'absent.csv'),
    (['-p', 'duration_s:=0.0'], 'duration_s is 0'),
    (['-p', 'initial.after_s:=10.0', '-p', 'duration_s:=5.0'], 'the run navigates for'),
])
@pytest.mark.parametrize('verb', ['simulate', 'predict'])
def test_bad_input_is_one_sentence_and_exit_code_2(verb, arguments, sentence, tmp_path, capsys,
                                                   monkeypatch):
    """Invalid input gives one message and exit code 2, and nothing is written."""
    monkeypatch.chdir(tmp_path)
    assert main([verb, *arguments]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.startswith(f'ins_sim {verb}: ')
    assert error.count('\n') == 1
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_verb_is_exit_code_2(capsys):
    """argparse lists the known verbs."""
    with pytest.raises(SystemExit) as exit_:
        main(['simulat'])
    assert exit_.value.code == 2
    assert 'simulate' in capsys.readouterr().err


@pytest.mark.parametrize('verb', ['simulate', 'allan', 'demo'])
def test_a_wrong_option_shows_the_usage_of_its_verb(verb, capsys):
    """A wrong option shows the usage of the verb, not that of the command without verbs."""
    with pytest.raises(SystemExit) as stopped:
        main([verb, '--colour'])
    said = capsys.readouterr().err
    assert stopped.value.code == 2
    assert f'usage: ins_sim {verb} ' in said and 'unrecognized arguments: --colour' in said


def test_dtg_study_shows_both_tables_and_saves_both_figures(tmp_path, capsys):
    """dtg-study prints both tables and saves both figures; test_tuned_gyro checks the values."""
    assert main(['dtg-study', '-o', str(tmp_path / 'study')]) == 0
    shown = capsys.readouterr().out
    for text in ('9.9777', '9.8140', '129.4 to 337.4 Hz', '9.65', '[rad/s]'):
        assert text in shown
    for name in ('frequency', 'speed'):
        path = tmp_path / 'study' / f'dtg_study_{name}.png'
        assert path.read_bytes().startswith(b'\x89PNG')


def test_dtg_report(capsys):
    """dtg-report prints roots, bandwidth and step limits of the gyros of the parameters."""
    assert main(['dtg-report', '-p', 'gyro.dtg.errors.speed_ppm:=[100.0, 0.0]']) == 0
    text = capsys.readouterr().out
    assert 'tuned gyro tactical, closed loop, rotor at 230 Hz' in text and 'stable' in text
    assert '-3 dB at 86.75 Hz' in text and 'gyro 1, 100 ppm off: roots' in text
    assert main(['dtg-report', '-p', 'gyro.dtg.preset:=sapegin_2016']) == 0
    text = capsys.readouterr().out
    assert 'UNSTABLE' in text and 'time constant 0.133652 s' in text
    assert 'RK4 is stable for steps of 0.3322 to 1.099 ms' in text
    bad = ['-p', 'gyro.dtg.preset:=custom', '-p', 'gyro.dtg.custom.rotor_axial_kg_m2:=1.0']
    assert main(['dtg-report', *bad]) == 2
    assert 'no rigid body has more' in capsys.readouterr().err


def test_compare_orientation(capsys):
    """compare-orientation prints one table of the three algorithms."""
    assert main(['compare-orientation', *LATE_MOTION_2_WORDS, '-p',
                 'duration_s:=20.0']) == 0
    text = capsys.readouterr().out
    assert all(word in text for word in ('quaternion', 'poisson', 'euler_vector',
                                         'angle from the quaternion', 'max |dN|'))


def test_simulate_tells_of_gaps_and_of_the_parity(tmp_path, capsys):
    """simulate reports a faulty gyro channel, lost samples, and a gyro without a prediction."""
    dtg = ['simulate', '--params-file', 'dtg_motion_2', '-p', 'duration_s:=20.0']
    fault = ['-p', 'gyro.dtg.fault.channel:=gyro_1_y', '-p', 'gyro.dtg.fault.bias_deg_h:=9000.0',
             '-p', 'gyro.dtg.fault.start_s:=10.0', '-p', 'sampling.drop_out_probability:=0.005']
    assert main([*dtg, *fault, '-o', str(tmp_path / 'a')]) == 0
    text = ' '.join(capsys.readouterr().out.split())
    assert 'beyond the threshold in' in text and 'the strapdown started anew' in text
    arrays = np.load(tmp_path / 'a' / 'run.npz')
    assert arrays['imu_parity'].shape == arrays['imu_t_ns'].shape
    paper = ['-p', 'gyro.dtg.preset:=sapegin_2016', '-p', 'gyro.dtg.method:=rk4', '-p',
             'gyro.dtg.steps_per_sample:=13']
    assert main([*dtg, *paper, '-o', str(tmp_path / 'b')]) == 0
    text = ' '.join(capsys.readouterr().out.split())
    assert 'no prediction: the gyro is unstable' in text and 'at most' in text
    assert 'predicted_t_s' not in np.load(tmp_path / 'b' / 'run.npz')


def test_tables_show_their_units(capsys, tmp_path):
    """Units in brackets are printed, not interpreted as markup."""
    assert main(['predict', *LATE_MOTION_2_WORDS, '-p', 'duration_s:=10.0']) == 0
    text = ' '.join(capsys.readouterr().out.split())
    assert "psi' [rad/s]" in text and 'drift north [deg/h]' in text
