"""The files of a run: thinned arrays, CSV tables and trajectories have the bits of the arrays."""

import csv

import ins_sim
from ins_sim.cli.main import main
from ins_sim.core.attitude import quaternion
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.timeseries.named_columns import history_columns
from ins_sim.io.csv_imu import read_imu
from ins_sim.report.files.wanted import WantedFiles
import numpy as np
import pytest
from support.readings.imu_records import record_at_rest
from support.studies import LATE_MOTION_2, LATE_MOTION_2_WORDS

SHORT = ('-p', 'duration_s:=2.0')
RECORDS = ('truth', 'imu', 'states', 'errors', 'twin')
AT_REST = {'initial.position': 'given', 'initial.latitude_deg': 45.0,
           'initial.attitude': 'given', 'initial.velocity': 'given'}


@pytest.fixture(scope='module')
def run():
    """Return two seconds of motion 2."""
    return ins_sim.simulate(ins_sim.read_settings(LATE_MOTION_2, {'duration_s': 2.0}))


@pytest.fixture(scope='module')
def aided():
    """Return three seconds of the aided flight."""
    return ins_sim.simulate_aided(ins_sim.read_settings(
        ['route_flight', 'grade_mid'], {'duration_s': 3.0, 'window.cycles': 100}, aided=True))


def table(path):
    """Return {name of a column: its texts} of a CSV file."""
    with open(path, newline='', encoding='utf-8') as file:
        head, *rows = csv.reader(file)
    return dict(zip(head, zip(*rows)))


def check_table(path, history):
    """Compare names and bits of a CSV file with a History."""
    found, expected = table(path), history_columns(history)
    assert list(found) == ['t_ns', *expected]
    assert [int(text) for text in found['t_ns']] == history.t_ns.tolist()
    for name, values in expected.items():
        assert np.array(found[name], dtype=float).tobytes() == values.tobytes(), name


def check_trajectory(path, settings, history):
    """Compare a TUM file with a PlacedHistory."""
    frame = MapFrame(settings.motion_generator.datum, settings.motion_generator.earth.rotation)
    rows = [line.split(' ') for line in path.read_text().splitlines() if line[0] != '#']
    assert {len(row) for row in rows} == {8}
    stamps = [row[0].replace('.', '') for row in rows]
    assert [int(text) for text in stamps] == history.t_ns.tolist()
    position, attitude, _ = frame.pose(history.lat, history.lon, history.height, history.v_n,
                                       history.q_nb)
    found = np.array([row[1:] for row in rows], dtype=float)
    assert found.tobytes() == np.concatenate([position, attitude], axis=1).tobytes()


def test_tables_and_trajectories_of_the_verb(run, tmp_path):
    """simulate --csv --tum writes each record; without the options these files are absent."""
    assert main(['simulate', *LATE_MOTION_2_WORDS, *SHORT, '-o', str(tmp_path / 'plain')]) == 0
    assert main(['simulate', *LATE_MOTION_2_WORDS, *SHORT, '--csv', '--tum', '-o',
                 str(tmp_path / 'run')]) == 0
    more = {f'{name}.csv' for name in RECORDS} | {'truth.tum', 'ins.tum'}
    assert {p.name for p in (tmp_path / 'run').iterdir()} == more | {
        p.name for p in (tmp_path / 'plain').iterdir()}
    for name in RECORDS:
        check_table(tmp_path / 'run' / f'{name}.csv', getattr(run, name))
    check_trajectory(tmp_path / 'run' / 'truth.tum', run.settings, run.truth)
    check_trajectory(tmp_path / 'run' / 'ins.tum', run.settings, run.states)
    assert (tmp_path / 'run' / 'run.npz').read_bytes() == (
        tmp_path / 'plain' / 'run.npz').read_bytes()


@pytest.mark.filterwarnings("ignore:The 'float_precision' argument is deprecated")
def test_a_dataframe_is_what_pandas_reads_from_the_table(run, tmp_path):
    """A dataframe has the names, index and bits that pandas reads from the CSV table."""
    pandas = pytest.importorskip('pandas', reason='pandas is not installed')
    run.save(tmp_path / 'run', csv=True)
    for name in RECORDS:
        read = pandas.read_csv(tmp_path / 'run' / f'{name}.csv', index_col='t_ns',
                               float_precision='round_trip')
        pandas.testing.assert_frame_equal(read, run.to_dataframe(name), check_exact=True)


def test_the_table_of_the_imu_is_navigated_as_it_is(run, tmp_path):
    """navigate recognises the names, units and stamps of the CSV table of the IMU."""
    run.save(tmp_path / 'run', csv=True)
    read, notes = read_imu(tmp_path / 'run' / 'imu.csv')
    assert len(notes) == 1 and 't_s from t_ns times 1e-09' in notes[0]
    assert np.array_equal(read.t_ns, run.imu.t_ns)
    assert read.omega.tobytes() == run.imu.omega.tobytes()
    assert read.f.tobytes() == run.imu.f.tobytes()


def test_evo_reads_the_trajectories(run, tmp_path):
    """The position error computed by evo equals ours at the stamps it matches."""
    file_interface = pytest.importorskip('evo.tools.file_interface',
                                         reason='evo is not installed (PyPI)')
    from support.bags.bag_tools import evo_position_rms
    run.save(tmp_path / 'run', tum=True)
    truth, ins = (file_interface.read_tum_trajectory_file(tmp_path / 'run' / f'{name}.tum')
                  for name in ('truth', 'ins'))
    for trajectory in (truth, ins):
        valid, details = trajectory.check()
        assert valid, details
    rms = np.sqrt((run.errors.position ** 2).sum(axis=1).mean())
    # A difference of positions 6400 km from the centre of the Earth: 1e-9 m each.
    assert evo_position_rms(truth, ins) == pytest.approx(rms, rel=1e-3, abs=1e-8)


@pytest.mark.parametrize('thin', [1, 7, 200, 201, 10 ** 6])
def test_every_nth_instant(run, thin, tmp_path):
    """Truth, solution, errors and twin are thinned by the verb and by a run; the IMU is not."""
    assert main(['simulate', *LATE_MOTION_2_WORDS, *SHORT, '--csv', '--thin', str(thin), '-o',
                 str(tmp_path / 'verb')]) == 0
    run.save(tmp_path / 'api', thin=thin, csv=True, tum=True)
    for folder in ('verb', 'api'):
        with np.load(tmp_path / folder / 'run.npz') as found:
            for name in RECORDS:
                record = getattr(run, name)
                kept = record if name == 'imu' else record[::thin]
                for field, values in kept.arrays().items():
                    assert found[f'{name}_{field}'].tobytes() == values.tobytes()
                check_table(tmp_path / folder / f'{name}.csv', kept)
        told = (tmp_path / folder / 'manifest.yaml').read_text()
        assert ('thin' in told) == (thin > 1)
    check_trajectory(tmp_path / 'api' / 'ins.tum', run.settings, run.states[::thin])
    # The summary of the run does not depend on thinning.
    run.save(tmp_path / 'whole')
    assert (tmp_path / 'whole' / 'summary.json').read_text() == (
        tmp_path / 'verb' / 'summary.json').read_text()


def test_what_is_left_out_is_said_once(tmp_path, capsys):
    """Thinning is reported once with its count, and not if nothing is left out."""
    for thin, sentence in ((1, None), (10, 'the files hold 21 of 201 output instants (thin 10)')):
        assert main(['simulate', *LATE_MOTION_2_WORDS, *SHORT, '--thin', str(thin), '--force',
                     '-o', str(tmp_path / 'run')]) == 0
        said = capsys.readouterr().out
        assert said.count('output instants') == (sentence is not None)
        assert sentence is None or sentence in said


@pytest.mark.parametrize('thin', [0, -3, 2.5, '2', True, None])
def test_thin_is_a_whole_number(run, thin, tmp_path):
    """Invalid values of thin are refused with one message, and nothing is written."""
    with pytest.raises(ValueError, match='^thin is .*; expected a whole number of at least 1$'):
        run.save(tmp_path / 'run', thin=thin)
    assert not (tmp_path / 'run').exists()


def test_the_verb_refuses_thin_0_before_the_run(tmp_path, capsys):
    """Option thin 0 is refused with exit code 2 before the run."""
    assert main(['simulate', *LATE_MOTION_2_WORDS, '--thin', '0', '-o', str(tmp_path / 'x')]) == 2
    assert 'thin is 0; expected a whole number of at least 1' in capsys.readouterr().err
    assert not (tmp_path / 'x').exists()


def test_an_aided_run(aided, tmp_path):
    """Records of the aided solution are written like those of the strapdown, thinned alike."""
    aided.save(tmp_path / 'run', thin=5, csv=True, tum=True)
    for name in ('truth', 'states', 'errors'):
        check_table(tmp_path / 'run' / f'aided_{name}.csv', getattr(aided, name)[::5])
        check_table(tmp_path / 'run' / f'{name}.csv', getattr(aided.run, name)[::5])
    check_trajectory(tmp_path / 'run' / 'aided.tum', aided.run.settings, aided.states[::5])
    with np.load(tmp_path / 'run' / 'run.npz') as found:
        assert found['aided_errors_t_ns'].tolist() == aided.errors.t_ns[::5].tolist()
        assert len(found['judged_t_ns']) == len(aided.judged)


def test_a_navigation(tmp_path):
    """Verb and function write solution and errors; the map origin is at the start."""
    (tmp_path / 'track.csv').write_text('t_s,lat_deg,lon_deg,height_m\n' + ''.join(
        f'{k},45.0,0.0,0.0\n' for k in range(4)))
    record = record_at_rest(300)
    found = ins_sim.navigate(record, {**AT_REST, 'reference.path': str(tmp_path / 'track.csv')})
    found.save(tmp_path / 'nav', csv=True, tum=True)
    states, position = found.segments[0], found.comparisons[0].position
    check_table(tmp_path / 'nav' / 'states.csv', states)
    read = table(tmp_path / 'nav' / 'error_0_position.csv')
    assert list(read) == ['t_ns', 'position_east_m', 'position_north_m', 'position_up_m']
    assert np.array(list(read.values())[1:], dtype=float).tobytes() == (
        np.ascontiguousarray(position.values.T).tobytes())
    rows = np.loadtxt(tmp_path / 'nav' / 'ins.tum')
    assert rows.shape == (len(states), 8) and np.abs(rows[0, 1:4]).max() < 1e-8
    np.testing.assert_allclose(rows[0, 4:], states.q_nb[0], atol=1e-15)


def test_kept_is_the_result_itself_where_nothing_is_left_out(run):
    """Without thinning no copy of the result is made."""
    assert WantedFiles().kept(run.result) is run.result
    assert WantedFiles(3).kept(run.result).imu is run.result.imu


def test_attitudes_are_in_the_axes_of_the_map(run, tmp_path):
    """At the datum n and map coincide, so that the quaternion is that of the truth."""
    run.save(tmp_path / 'run', tum=True)
    first = np.loadtxt(tmp_path / 'run' / 'truth.tum')[0]
    turn = quaternion.multiply(quaternion.conjugate(tuple(run.truth.q_nb[0])), tuple(first[4:]))
    assert np.abs(turn[:3]).max() < 1e-15
    assert np.abs(first[1:4]).max() < 1e-8
