"""The command and the function on runs, bags and CSV files: equal results, one message if bad."""

from dataclasses import replace
import json

import numpy as np
import pytest

import ins_sim
from ins_sim.cli.main import main
from ins_sim.io import csv_writer
from ins_sim.io.published import read_imu
from support.readings.bench import DELAYS, DIAGONAL

WORDS = [w for name, value in {**DIAGONAL, **DELAYS}.items() for w in ('-p', f'{name}:={value}')]
MOTION = [w for name, value in DIAGONAL.items() for w in ('-p', f'{name}:={value}')]
FOG = ['--params-file', 'imu_tactical_fog']


@pytest.fixture(scope='module')
def made(tmp_path_factory):
    """Return a folder with a run of 30 s, its bag, and a CSV file of its IMU."""
    folder = tmp_path_factory.mktemp('bench')
    assert main(['simulate', *FOG, *WORDS, '-p', 'duration_s:=30.0', '--no-twin', '-o',
                 str(folder / 'run'), '--bag', str(folder / 'bag')]) == 0
    assert main(['convert', str(folder / 'bag'), str(folder / 'imu.csv'), '--topic',
                 'imu/data_raw']) == 0
    return folder


def test_a_run_a_bag_and_a_csv_file_have_one_answer(made, tmp_path, capsys):
    """
    A run, a bag and a CSV file give the same result.

    The bag contains the truth as samples, the CSV file relies on the motion of the parameters.
    Readings are the same; the motion of the bag ends 3 s earlier, which changes the used noise.
    """
    out = tmp_path / 'out'
    assert main(['estimate-delays', str(made / 'run'), '-o', str(out)]) == 0
    for name in ('delay_fit', 'delay_residuals', 'delay_sigma'):
        assert (out / f'{name}.png').read_bytes().startswith(b'\x89PNG')
    assert (out / 'report.html').stat().st_size > 1000
    said = capsys.readouterr().out
    for text in ('delay set', 'lag of the bandwidth', '361.50',
                 'are computed from the angle',
                 '"delay and lag" is the sum of the delay of the channel and the lag of the '
                 'instrument'):
        assert text in said
    run = {row['axis']: row for row in json.loads((out / 'estimate.json').read_text())['values']
           if row['name'] == 'delay and lag'}
    csv = ins_sim.estimate_delays(made / 'imu.csv', DIAGONAL, 'imu_tactical_fog')
    bag = ins_sim.estimate_delays(made / 'bag', names='imu_tactical_fog')
    blind = ins_sim.estimate_delays(made / 'bag')
    for found, text in ((csv, 'motion time zero is the stamp 1735689600'),
                        (bag, 'the motion is the truth in the bag'),
                        (bag, 'outside the known motion'), (blind, 'scatter of the residuals')):
        assert any(text in note for note in found.notes), text
    for k, (axis, known) in enumerate(zip('xyz', (2.0, 1.0, 3.0))):
        value, sigma = run[axis]['value'], run[axis]['sigma']
        assert abs(value - 361.503 - known) < 4.0 * sigma
        assert run[axis]['known'] == pytest.approx(361.503 + known, abs=1e-3)
        assert 1e6 * csv.delays[k] == pytest.approx(value, abs=1e-3)
        assert 1e6 * csv.delay_sigmas[k] == pytest.approx(sigma, rel=1e-6)
        for other in (bag, blind):
            # 24 of 30 s: the difference is within half a sigma of the missing part.
            assert abs(1e6 * other.delays[k] - value) < 4.0 * 0.5 * sigma
            assert 1e6 * other.delay_sigmas[k] == pytest.approx(sigma * np.sqrt(30.0 / 24.0),
                                                                rel=0.35)


def test_an_ins_log_with_its_reference(made, tmp_path):
    """Readings in one CSV file, and the attitude in another, give the result on one clock."""
    reference = tmp_path / 'reference.csv'
    assert main(['convert', str(made / 'bag'), str(reference)]) == 0
    found = ins_sim.estimate_delays(made / 'imu.csv', {
        'motion.kind': 'recording', 'motion.recording.path': str(reference)}, 'imu_tactical_fog')
    assert any('on the clock of' in note for note in found.notes)
    assert np.abs(1e6 * (found.delays - found.lags) - [2.0, 1.0, 3.0]).max() < (
        4e6 * found.delay_sigmas.max())


def test_from_python(made):
    """Python accepts one or several paths and returns records for data frames and xarray."""
    found = ins_sim.estimate_delays(made / 'run')
    again = ins_sim.estimate_delays([made / 'run', made / 'bag'], topic=None)
    assert found.delays - found.lags == pytest.approx([2e-6, 1e-6, 3e-6],
                                                      abs=4.0 * found.delay_sigmas.max())
    assert (again.delay_sigmas < found.delay_sigmas).all()
    assert any('cannot be distinguished' in note for note in found.notes)
    pytest.importorskip('pandas', reason='pandas is not installed')
    table = found.to_dataframe()
    assert list(table.columns) == ['axis', 'name', 'unit', 'value', 'sigma', 'told']
    rows = table[table.name == 'delay and lag']
    assert rows.value.to_numpy() == pytest.approx(1e6 * found.delays)
    assert rows.told.all() and not table[table.name == 'scale factor'].told.any()
    pytest.importorskip('xarray', reason='xarray is not installed')
    data = again.to_xarray()
    assert dict(data.sizes) == {'body_axis': 3, 'towards': 3, 'record': 2}
    assert data.delay.values == pytest.approx(again.delays)
    assert float(data.misalignment.sel(body_axis='x', towards='x')) == 0.0


def test_a_motion_of_the_caller(made):
    """A run object carries a user's motion; its folder does not."""
    chosen = ins_sim.read_settings('imu_tactical_fog', {**DIAGONAL, **DELAYS, 'duration_s': 20.0})
    run = ins_sim.simulate(chosen, twin=False)
    own = replace(run, own_motion=True)
    found = ins_sim.estimate_delays(own)
    assert 1e6 * (found.delays - found.lags) == pytest.approx(
        [2.0, 1.0, 3.0], abs=4e6 * found.delay_sigmas.max())
    own.save(made / 'own')
    with pytest.raises(ValueError, match='given as an object'):
        ins_sim.estimate_delays(made / 'own')


def refused(words, capsys):
    """Return the message with which the command refuses."""
    capsys.readouterr()
    assert main(['estimate-delays', *map(str, words)]) == 2
    error = capsys.readouterr().err.strip()
    sentence = [line for line in error.splitlines() if line.startswith('ins_sim estimate-delays')]
    assert len(sentence) == 1 and 'Traceback' not in error
    return sentence[0]


def test_bad_input_is_one_sentence(made, tmp_path, capsys):
    """Invalid input gives a message with fault and expectation, and nothing is written."""
    out = ['-o', tmp_path / 'out']
    csv, run, bag = made / 'imu.csv', made / 'run', made / 'bag'
    cases = [
        ([csv], 'does not contain the motion of the bench'),
        ([csv, *MOTION, '-p', 'rate_hz:=200.0'], '100 readings a second'),
        ([run, '-p', 'rate_hz:=200.0'], '100 readings a second'),
        ([csv, *MOTION, '-p', 'motion.rocking.frequency_hz:=1.3'],
         'do not belong to the given motion'),
        ([csv, '-p', 'motion.kind:=static'], 'not observable'),
        ([csv, *MOTION, '-p', 'time.epoch:=fixed', '-p', 'time.epoch_s:=5'],
         'from motion time zero'),
        ([csv, '-p', 'motion.kind:=guided'], 'steered during the run'),
        ([csv, *MOTION, '--topic', 'imu'], 'not a bag'),
        ([run, '--topic', 'imu'], 'is a run'),
        ([bag, '--topic', 'truth/odom'], 'no topic'),
        ([run, '--duration', '60'], 'but a SOURCE is given'),
        ([tmp_path / 'nix'], 'does not exist'),
        ([tmp_path], 'is not a bag'),
        (['--topic', 'imu'], 'expected a bag'),
        (['--duration', '-1'], '--duration is -1'),
        (['--duration', '1'], 'expected at least 640'),
        (['--params-file', 'motion_2'], 'no white noise')]
    for words, text in cases:
        assert text in refused([*words, *out], capsys), words
        assert not (tmp_path / 'out').exists()


def test_records_that_do_not_serve(made, tmp_path, capsys):
    """Records that are too short, at rest, or bags without truth are refused."""
    imu = read_imu(made / 'bag', 'imu/data_raw')
    short = tmp_path / 'short.csv'
    csv_writer.write_imu(short, imu[:500])
    out = ['-o', tmp_path / 'out']
    assert 'too short: 499 readings' in refused([short, *MOTION, *out], capsys)
    still = tmp_path / 'still'
    assert main(['simulate', *FOG, '-p', 'motion.kind:=static', '-p', 'duration_s:=30.0',
                 '--no-twin', '-o', str(still)]) == 0
    sentence = refused([still, *out], capsys)
    assert 'not observable' in sentence and 'changes by at most' in sentence
    assert main(['convert', str(made / 'imu.csv'), str(tmp_path / 'blind')]) == 0
    sentence = refused([tmp_path / 'blind', *out], capsys)
    assert 'truth/odometry' in sentence and 'motion.kind' in sentence


def test_without_a_source_motions_are_compared(tmp_path, capsys):
    """
    Without a source motions are compared; bars, map and speed are written.

    A motion of the parameters is among those compared.
    """
    out = tmp_path / 'plan'
    assert main(['estimate-delays', *FOG, *MOTION, '-p', 'motion.rocking.frequency_hz:=2.0',
                 '--duration', '100', '-o', str(out)]) == 0
    for name in ('bench_motions', 'bench_directions', 'bench_speed'):
        assert (out / f'{name}.png').read_bytes().startswith(b'\x89PNG')
    motions = json.loads((out / 'motions.json').read_text())['motions']
    named = {m['motion']: m for m in motions}
    own = named['rocking of the parameters']
    base = named['rocking about the diagonal, 5 deg, 1 Hz']
    # Twice the frequency, four times the angular acceleration.
    assert np.array(own['sigma_us']) == pytest.approx(np.array(base['sigma_us']) / 4.0, rel=0.01)
    said = capsys.readouterr().out
    assert 'Of the motions compared, rocking of the parameters determines delays best' in said
    assert 'as fast as the bench allows' in said


@pytest.mark.parametrize('duration', ['0', '-5', 'nan'])
def test_a_motion_of_no_length_is_refused(duration, tmp_path, capsys):
    """A motion of zero duration is refused; 0 s is not replaced by the default."""
    assert main(['estimate-delays', '--duration', duration, '-o', str(tmp_path / 'e')]) == 2
    assert f'--duration is {duration} s; expected more than 0' in capsys.readouterr().err
    assert not (tmp_path / 'e').exists()
