"""The command monte-carlo --aided: equal numbers for any number of workers, and the worst run."""

import json
import re

from ins_sim.cli.main import main
import numpy as np
import pytest

WORDS = ['monte-carlo', '--aided', '--params-file', 'gnss_outage_flight', '--params-file',
         'grade_mid', '-p', 'duration_s:=20.0', '-p', 'window.cycles:=100', '--instants', '5']


def ensemble(folder, *words, runs=4):
    """Run the command; return its summary and arrays."""
    assert main([*WORDS, '--runs', str(runs), '-o', str(folder), *words]) == 0
    with np.load(folder / 'ensemble.npz') as arrays:
        return json.loads((folder / 'summary.json').read_text()), dict(arrays)


def test_jobs_change_no_bit_and_the_worst_run_flies_alone(tmp_path, capsys, monkeypatch):
    """
    One and two processes give one digest; the command of the worst run gives its end.

    The end agrees to the bit.
    """
    monkeypatch.chdir(tmp_path)
    gnss = ['-p', 'gnss_model.use:=true']
    summary, arrays = ensemble(tmp_path / 'a', *gnss, '--jobs', '1')
    text = capsys.readouterr().out
    other, _ = ensemble(tmp_path / 'b', *gnss, '--jobs', '2')
    assert other['digest'] == summary['digest'] and summary['digest'] in text
    told = ' '.join(text.split())
    assert 'filter eskf, 4 runs: consistency of the filter' in told
    for quantity in ('position', 'velocity', 'attitude', 'all states that are estimated'):
        assert f'NEES of {quantity}' in told
    assert 'NIS of velocity meter' in told and 'NIS of GNSS' in told
    assert arrays['nees_count'].tolist() == [[0] * 4] + [[4] * 4] * 4
    assert arrays['velocity_meter_nis_freedom'].tolist() == [8] * 20
    assert (tmp_path / 'a' / 'consistency.png').stat().st_size > 20000
    page = (tmp_path / 'a' / 'report.html').read_text()
    assert summary['digest'] in page and 'consistency of the filter' in page
    capsys.readouterr()
    worst = int(re.search(r'The worst is run (\d+)', told)[1])
    command = re.search(r'ins_sim (simulate --aided --params-file .* -p run:=\d+ -o run_\d+)',
                        told)[1].split()
    assert main(command) == 0
    with np.load(tmp_path / f'run_{worst}' / 'run.npz') as run:
        for name in ('attitude', 'velocity', 'position'):
            np.testing.assert_array_equal(run[f'aided_errors_{name}'][-1],
                                          arrays[f'final_{name}_error'][worst])


def test_a_filter_without_a_covariance(tmp_path, capsys):
    """A filter without covariance has errors but no NEES, and a message states this."""
    summary, arrays = ensemble(tmp_path / 'a', '-p', 'filter:=conventional', '--jobs', '1',
                               runs=2)
    told = ' '.join(capsys.readouterr().out.split())
    assert 'The filter has no covariance, hence neither NEES nor NIS.' in told
    assert [table['title'] for table in summary['tables']] == [
        'errors at 20 s', 'horizontal position error against time']
    assert not arrays['nees_count'].any() and arrays['count'].tolist() == [2] * 5
    assert not (tmp_path / 'a' / 'consistency.png').exists()


def test_a_run_that_is_refused_is_named(tmp_path, capsys):
    """With on_fault stop a gap ends the solution: the run is named with the reason."""
    gaps = ['-p', 'sampling.drop_out_probability:=0.0005', '-p', 'aided_navigator:on_fault:=stop',
            '-p', 'velocity_meter:attack_angle:=none']
    summary, arrays = ensemble(tmp_path / 'a', *gaps, '--jobs', '1')
    told = ' '.join(capsys.readouterr().out.split())
    # In 2000 samples there is a loss in two runs of three.
    assert 0 < len(summary['diverged']) < 4
    first = summary['diverged'][0]
    lost = len(summary['diverged'])
    assert f'{lost} of 4 runs were refused or diverged and are excluded' in told
    assert f'run {first}: imu has a gap' in told
    assert np.isnan(arrays['final_position_error'][first]).all()
    assert arrays['count'].tolist() == [4 - lost] * 5


@pytest.mark.parametrize('words, sentence', [
    (['-p', 'aided_navigator:initial.after_s:=30.0'],
     'aided_navigator: initial.after_s is 30 s; expected at most duration_s, 20 s'),
    (['-p', 'gnss.rate_hz:=30.0'], 'expected a multiple of the period of rate_hz'),
    (['--runs', '0'], 'runs is 0; expected a whole number from 1 to 10000000')])
def test_bad_input_is_one_sentence(tmp_path, capsys, words, sentence):
    """Invalid input gives exit code 2 before a worker starts, and nothing is written."""
    assert main([*WORDS, '-o', str(tmp_path / 'out'), *words]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1 and not list(tmp_path.iterdir())


def test_each_run_steers_its_own_guided_flight(tmp_path):
    """The runs of a guided flight end like single runs, to the bit, and differ in their motion."""
    words = ['--params-file', 'guided_flight', '--params-file', 'imu_tactical_mems', '-p',
             'duration_s:=5.0', '-p', 'motion.guided.offset_m:=1.0', '-p',
             'window.cycles:=100']
    assert main(['monte-carlo', '--aided', *words, '--runs', '2', '--jobs', '1', '-o',
                 str(tmp_path / 'study')]) == 0
    flown = []
    with np.load(tmp_path / 'study' / 'ensemble.npz') as arrays:
        for k in range(2):
            folder = tmp_path / f'run_{k}'
            assert main(['simulate', '--aided', *words, '-p', f'run:={k}', '-o',
                         str(folder)]) == 0
            with np.load(folder / 'run.npz') as run:
                for name in ('attitude', 'velocity', 'position'):
                    np.testing.assert_array_equal(run[f'aided_errors_{name}'][-1],
                                                  arrays[f'final_{name}_error'][k])
                flown.append(run['truth_lat'][-1])
    assert flown[0] != flown[1]
