"""The command monte-carlo and ins_sim.monte_carlo: their output, and what they refuse."""

import json
import shlex

import ins_sim
from ins_sim.cli.main import main
from ins_sim.core.ensemble.many_runs import simulate_runs
from ins_sim.core.ensemble.result import ErrorTally
from ins_sim.io.motion import read_motion
from ins_sim.report.studies import ensemble
from ins_sim.settings.simulation import AidedSimulationSettings
import numpy as np
import pytest

NAMES = ['racetrack', 'imu_tactical_fog']
WORDS = ['monte-carlo', '--params-file', 'racetrack', '--params-file', 'imu_tactical_fog', '-p',
         'duration_s:=3.0', '--instants', '4', '--jobs', '1']


@pytest.fixture(scope='module')
def study():
    """Return an ensemble of 20 runs of 3 s, starting with run 5."""
    settings = ins_sim.read_settings(NAMES, {'duration_s': 3.0, 'run': 5})
    seen = []
    made = ins_sim.monte_carlo(settings, runs=20, instants=4, jobs=1, progress=seen.append)
    assert seen == [0.5, 1.0]
    return made


def test_the_verb_writes_what_python_returns(tmp_path, monkeypatch, capsys, study):
    """The command writes what Python returns; ``simulate`` repeats the worst run to the bit."""
    monkeypatch.chdir(tmp_path)
    assert main([*WORDS, '--runs', '20', '-p', 'run:=5', '-o', 'study']) == 0
    said = capsys.readouterr().out
    assert study.digest in said
    number, metres = study.worst
    command = f'ins_sim simulate --params-file study/parameters.yaml -p run:={number} -o run_'
    assert command in said
    names = {path.name for path in (tmp_path / 'study').iterdir()}
    assert {'ensemble.npz', 'summary.json', 'parameters.yaml', 'manifest.yaml', 'report.html',
            'horizontal.png', 'position.png', 'velocity.png', 'attitude.png', 'ends.png',
            'histogram.png'} <= names and not (tmp_path / 'study.blocks').exists()
    summary = json.loads((tmp_path / 'study' / 'summary.json').read_text())
    assert (summary['worst_run'], summary['digest']) == (number, study.digest)
    with np.load(tmp_path / 'study' / 'ensemble.npz') as found:
        assert found['runs'].tolist() == list(range(5, 25)) == list(study.runs)
        np.testing.assert_array_equal(found['position_sigma'], study.errors.sigma['position'])
        ends = found['final_position_error']
        assert number == 5 + int(np.argmax(np.hypot(ends[:, 0], ends[:, 1])))
        assert metres == pytest.approx(np.hypot(*ends[number - 5, :2]), rel=1e-15)
    assert main(['simulate', '--params-file', 'study/parameters.yaml', '-p', f'run:={number}',
                 '-o', 'alone']) == 0
    with np.load(tmp_path / 'alone' / 'run.npz') as alone:
        np.testing.assert_array_equal(alone['errors_position'][-1], ends[number - 5])


def test_statistics_are_those_of_the_ends(study):
    """At the last instant mean, sigma and rms are those of the final errors."""
    for name, ends in study.final_errors.items():
        errors = study.errors
        np.testing.assert_allclose(errors.mean[name][-1], ends.mean(axis=0), rtol=1e-9,
                                   atol=1e-15)
        np.testing.assert_allclose(errors.sigma[name][-1], ends.std(axis=0, ddof=1), rtol=1e-9,
                                   atol=1e-15)
        np.testing.assert_allclose(errors.rms[name][-1], np.sqrt(np.mean(ends ** 2, axis=0)),
                                   rtol=1e-9, atol=1e-15)
    assert (errors.cep[50][1:] < errors.cep[95][1:]).all()


def test_tables_for_others(study):
    """Data frames by instant and by run, and an xarray with named dimensions and units."""
    pytest.importorskip('pandas')
    table, ends = study.to_dataframe(), study.to_dataframe('final')
    assert table.index.tolist() == study.errors.t_ns.tolist() and ends.index.name == 'run'
    assert table['position_sigma_north_m'].iloc[-1] == study.errors.sigma['position'][-1, 1]
    assert table['position_cep95_m'].iloc[-1] == study.errors.cep[95][-1]
    assert ends.loc[7, 'velocity_east_m_s'] == study.final_errors['velocity'][2, 0]
    with pytest.raises(ValueError, match="record is 'imu'; expected errors or final"):
        study.to_dataframe('imu')
    pytest.importorskip('xarray')
    data = study.to_xarray()
    assert dict(data.sizes) == {'run': 20, 'time': 4, 'axis': 3, 'percent': 5}
    assert float(data.final_position.sel(run=7, axis='up')) == study.final_errors['position'][2, 2]
    assert data.attitude_rms.attrs['units'] == 'rad' and data.attrs['digest'] == study.digest


def test_runs_that_diverge_are_counted_named_and_left_out():
    """Of three runs one diverges: it is excluded and counted, and a note names it."""
    errors = np.arange(27.0).reshape(1, 3, 9)
    errors[0, 1, 4] = np.nan
    tally = ErrorTally(1)
    tally.add(0, errors)
    final = np.zeros((3, 10))
    settings = ins_sim.read_settings(NAMES, {'duration_s': 3.0})
    result = tally.result(range(3), [3_000_000_000], [final], [errors[0]], [1], [(2, 4)])
    report = ensemble.ensemble_report('three runs', settings, result)
    assert report.errors.count.tolist() == [2] and report.worst[0] == 2
    assert ensemble.notes(report)[0] == ('1 of 3 runs diverged and are excluded from then on: 1')
    assert 'restarted from the truth 4 times, after gaps, in 1 of 3 runs' in (
        ensemble.notes(report)[1])
    assert 'over 2 runs' in ensemble.answer(report)


def test_an_ensemble_of_which_all_have_diverged(tmp_path):
    """An ensemble whose runs all diverge is written with a note, without NaN in the summary."""
    tally = ErrorTally(2)
    tally.add(0, np.full((2, 2, 9), np.nan))
    settings = ins_sim.read_settings(NAMES, {'duration_s': 3.0})
    result = tally.result(range(2), [0, 3_000_000_000], [np.full((2, 10), np.nan)],
                          [np.full((2, 9), np.nan)], [0, 1])
    report = ensemble.ensemble_report('two runs', settings, result)
    ensemble.write_ensemble(tmp_path, report)
    assert ensemble.answer(report) == 'All 2 runs diverged.'
    assert 'NaN' not in (tmp_path / 'summary.json').read_text()


@pytest.mark.parametrize('words, reason', [
    (['--runs', '0'], 'runs is 0; expected a whole number from 1'),
    (['--instants', '1'], 'instants is 1; expected a whole number from 2'),
    (['--jobs', '-1'], 'jobs is -1; expected 0'),
    (['-p', 'run:=2147483647', '--runs', '2'], 'run is 2147483647 with 2 runs'),
    (['-p', 'run:=-1'], 'run is -1'), (['-p', 'duration_s:=0'], 'duration_s is 0, endless'),
    (['-p', 'initial.after_s:=9.0'], 'no navigation output'),
    (['--scheduler', 'tcp://host:1'], 'a scheduler is given; expected only one of them'),
    (['-o', '/dev/null/study'], '/dev/null/study cannot be made')])
def test_what_is_no_ensemble_is_refused(words, reason, tmp_path, monkeypatch, capsys):
    """Invalid ensembles are refused with one message, and nothing is written."""
    monkeypatch.chdir(tmp_path)
    assert main([*WORDS, *words]) == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1 and reason in said[0]
    assert list(tmp_path.iterdir()) == []


def test_python_refuses_other_settings():
    """Python refuses settings that are not those of a simulation."""
    with pytest.raises(ValueError, match='settings are dict; expected SimulationSettings or'):
        ins_sim.monte_carlo({'duration_s': 1.0})


def test_nodes_fly_one_run():
    """The nodes of a simulation must agree on the number of the run; runs share one truth."""
    with pytest.raises(ValueError, match='^gnss: run is 3; expected the value of imu_sensor, 0, '):
        ins_sim.read_settings(['route_flight'], {'gnss:run': 3}, aided=True)
    settings = ins_sim.read_settings(['route_flight'], {'run': 3}, aided=True)
    assert isinstance(settings, AidedSimulationSettings) and settings.run == 3
    assert settings.with_run(0) == ins_sim.read_settings(['route_flight'], aided=True)
    gusts = ins_sim.read_settings(['route_flight'], {'duration_s': 1.0})
    motions = [read_motion(gusts.with_run(run).motion_generator) for run in (0, 3)]
    one, other = (motion.at(np.array([10 ** 9])) for motion in motions)
    np.testing.assert_array_equal(one.q_nb, other.q_nb)


def test_an_ensemble_of_no_runs_has_no_statistics():
    """An ensemble without runs has an empty result, in which only percentiles are NaN."""
    settings = ins_sim.read_settings(NAMES, {'duration_s': 1.0})
    found = simulate_runs(settings, read_motion(settings.motion_generator), range(0), [1.0])
    assert found.statistics.count.tolist() == [0] and found.final.shape == (0, 10)


def test_the_command_of_the_worst_run_can_be_pasted(tmp_path, monkeypatch, capsys):
    """The command for the worst run can be pasted into a shell: the folder stays one word."""
    monkeypatch.chdir(tmp_path)
    folder = 'a b <script> & "q"'
    assert main([*WORDS, '--runs', '2', '-o', folder]) == 0
    command, = (line for line in capsys.readouterr().out.splitlines()
                if line.startswith('ins_sim simulate'))
    assert f'{folder}/parameters.yaml' in shlex.split(command)
