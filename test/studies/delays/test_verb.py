"""The command delay-study and its Python function: output and refusals."""

import csv
import json

import numpy as np
import pytest
from support.places import ROOT
from support.studies import delay_figure as figure, delay_results as results_of

import ins_sim
from ins_sim.cli.main import main
from ins_sim.report.charts.chart import Curve, Map
from ins_sim.report.studies.delay_charts import figure_charts
from ins_sim.report.studies.delays import answer, study_notes, study_tables
from ins_sim.studies.delays.figure import FIGURES, RECORDED, SHIPPED

SHORT = ['-p', 'duration_s:=20.0', '--jobs', '1']
NAMES = ('figure_1', 'figure_3', 'rates', 'rocking')
STEMS = ('delay_study_figure_1', 'delay_study_figure_3', 'delay_study_figure_3_by_channel',
         'delay_study_rates', 'delay_study_rates_across', 'delay_study_rocking',
         'delay_study_rocking_directions')


@pytest.fixture(scope='module')
def study(tmp_path_factory):
    """Return a study of four figures over 20 s, written by the command."""
    folder = tmp_path_factory.mktemp('delays') / 'study'
    words = [word for name in NAMES for word in ('--params-file', f'delay_study_{name}')]
    assert main(['delay-study', *words, *SHORT, '-o', str(folder)]) == 0
    return folder


def test_files_are_those_of_the_house():
    """Every figure, and the recordings, have one shipped file; every kind of figure has one."""
    files = {path.stem for path in (ROOT / 'config').glob('delay_study_*.yaml')}
    assert files == {*SHIPPED, RECORDED}
    kinds = {figure(name.removeprefix('delay_study_')).shows.figure for name in SHIPPED}
    assert kinds == set(FIGURES)


def test_every_figure_is_a_picture_and_in_the_report(study):
    """Every figure is a picture of some size; the report has its title, tables and the answer."""
    pictures = {path.stem for path in study.glob('*.png')}
    assert pictures == set(STEMS)
    assert all((study / f'{stem}.png').stat().st_size > 10000 for stem in STEMS)
    page = (study / 'report.html').read_text(encoding='utf-8')
    for text in ('Latitude error of motion 2 at theta -30 deg', 'Largest position error',
                 'One microsecond of delay of one gyro: cruise', 'gives no data for its curves'):
        assert text in page
    assert '<name>cruise</name>' in (study / 'track.kml').read_text(encoding='utf-8')
    assert len(page) <= 5e6


def test_the_numbers_are_beside_them(study):
    """CSV files have named columns of finite numbers; one summary has all runs."""
    tables = {}
    for path in study.glob('*.csv'):
        with path.open(encoding='utf-8') as stream:
            heads = next(csv.reader(stream))
        tables[path.stem] = heads
        assert np.isfinite(np.loadtxt(path, delimiter=',', skiprows=1)).all()
    assert tables['delay_study_figure_1'][:3] == [
        't_s', 'psi_rate_1_latitude_arcmin', 'psi_rate_1_longitude_arcmin']
    assert 'north_m_per_us_z' in tables['delay_study_figure_3']
    assert tables['delay_study_rates'] == ['psi_rate_rad_s', 'gamma_rate_rad_s', 'drift_deg_h']
    numbers = json.loads((study / 'delay_study.json').read_text(encoding='utf-8'))
    assert [one['figure'] for one in numbers['figures']] == [f'delay_study_{n}' for n in NAMES]
    # Motion 2 is simulated once for both of its figures.
    assert len(numbers['runs']) == 4 + 1 + 9
    flight = numbers['runs'][4]
    end = np.dot(flight['per_us_xyz']['north_at_end_m'], (2.0, 1.0, 3.0))
    assert abs(end) == pytest.approx(flight['predicted']['largest_north_east_m'][0], rel=1e-3)


def test_a_study_is_replaced_only_on_request(study, capsys):
    """Without --force an existing study is kept with exit code 2."""
    assert main(['delay-study', '--params-file', 'delay_study_figure_1', *SHORT, '-o',
                 str(study)]) == 2
    said = capsys.readouterr().err
    assert 'exists; expected a new folder (or --force)' in said and said.count('\n') == 1


def test_published_numbers_stand_beside_ours():
    """Published numbers are shown for runs of the paper; no published curve is drawn."""
    results = results_of(figure('figure_1', detunings_rad_s=[0.0]))
    drift, place = study_tables(results)[:2]
    assert drift.rows[0][-1] == '0.0334932' and place.rows[0][-1] == '4472.1 / 623.94'
    assert drift.rows[0][2] == '0.0334936'
    other = study_tables(results_of(figure('figure_1', detunings_rad_s=[0.0], duration_s=20.0)))
    assert all(table.rows[0][-1] == '-' for table in other[:2])
    labels = [mark.label for chart in figure_charts(results[0]) for panel in chart.panels
              for mark in panel.marks]
    assert labels == ["psi' = 1 rad/s, tuned", None]
    assert 'reaches 4515 m in an hour' in answer(results)
    assert any('gives no data for its curves' in note for note in study_notes(results))


def test_small_curves_are_drawn_once_more():
    """
    Curves below a twentieth of the largest are drawn again, enlarged.

    The last panel is run minus prediction.
    """
    chart, = figure_charts(results_of(figure('theta_0', duration_s=600.0))[0])
    assert chart.columns == 2 and len(chart.panels) == 6
    for whole, small, residual in (chart.panels[0::2], chart.panels[1::2]):
        largest, others = ([np.abs(mark.y).max() for mark in panel.marks]
                           for panel in (whole, small))
        expected = [size for size in largest if size < 0.05 * max(largest)]
        assert others == pytest.approx([60.0 * size for size in expected])
        assert small.note == ('' if expected else 'no small ones')
        assert residual.title == 'run less prediction' and len(residual.marks) == 4
    assert any(panel.marks for panel in chart.panels[2:4])
    chart, = figure_charts(results_of(figure('theta_0', duration_s=60.0,
                                             detunings_rad_s=[0.0]))[0])
    assert len(chart.panels) == 4


def test_maps_name_their_lines():
    """The map over the rates has both resonance lines, drawn and named."""
    results = results_of(figure('rates', duration_s=60.0, detunings_rad_s=[0.0, 0.05]))
    charts = figure_charts(results[0])
    whole = charts[0].panels[0]
    assert isinstance(whole.marks[0], Map) and whole.x_label == "psi' [rad/s]"
    assert "dashed: psi' = 2 gamma'" in whole.title and "dotted: psi' = -2 gamma'" in whole.title
    for k, line in zip((2.0, -2.0), whole.marks[1:]):
        assert isinstance(line, Curve) and line.x == pytest.approx(k * line.y)
    runs, = (mark for mark in charts[1].panels[0].marks if mark.label == 'runs')
    curve = charts[1].panels[0].marks[0]
    # The map neglects the initial shift due to a delay: the rotation in 1 us, over a minute.
    shift = 3600.0 * np.degrees(2e-6) / 60.0
    assert runs.y == pytest.approx(np.interp(runs.x, curve.x, curve.y), abs=shift)


def test_from_python(tmp_path):
    """From Python the numbers are those of the command, as frames, datasets, and a folder."""
    found = ins_sim.delay_study(
        ['delay_study_figure_2', 'delay_study_figure_4', 'delay_study_rates',
         'delay_study_rocking'],
        {'duration_s': 10.0, 'detunings_rad_s': [0.0, 0.1], 'rocking_psi_deg': [45.0]}, jobs=1)
    assert repr(found).startswith('<DelayStudy: delay_study_figure_2, delay_study_figure_4')
    pytest.importorskip('pandas')
    frame = found.to_dataframe('delay_study_figure_2')
    assert frame.index.name == 't_s' and frame.shape == (101, 8)
    assert found.to_dataframe('delay_study_rates').shape == (91 * 91, 2)
    pytest.importorskip('xarray')
    errors = found.to_xarray('delay_study_figure_2')
    assert dict(errors.sizes) == {'run': 2, 'time': 101, 'axis': 3, 'coordinate': 2}
    north = errors['position'].sel(run="psi' = 1 rad/s, tuned", axis='north')
    run = found.result('delay_study_figure_2').runs[0]
    assert (north.values == run.apart[:, 1]).all()
    flight = found.to_xarray('delay_study_figure_4')
    delays = 1e-6 * np.array((2.0, 1.0, 3.0))
    summed = (flight['position_per_delay'] * delays).sum('body_axis')
    assert summed.values == pytest.approx(flight['predicted_position'].values[..., :2], abs=1e-12)
    assert found.to_xarray('delay_study_rates')['drift'].dims == ('gamma_rate', 'psi_rate')
    assert found.to_xarray('delay_study_rocking')['size'].dims == ('elevation', 'azimuth')
    with pytest.raises(ValueError, match="name is 'figure_9'; expected one of delay_study_figure"):
        found.to_dataframe('figure_9')
    found.save(tmp_path / 'study')
    assert (tmp_path / 'study' / 'report.html').is_file()
    with pytest.raises(ValueError, match='expected a new folder'):
        found.save(tmp_path / 'study')


@pytest.mark.parametrize('names, more, sentence', [
    ('figure_1', {'motion.kind': 'cruise'}, 'delay_study_figure_1: motion.kind is cruise with '
     'figure errors; expected two_axis'),
    ('figure_3', {'motion.kind': 'guided'}, 'motion.kind is guided with figure flight; expected '
     'cruise or racetrack'),
    ('rocking', {'motion.rocking.axis': 'x'}, 'motion.rocking.axis is x with figure rocking; '
     'expected north or east'),
    ('rocking', {'motion.rocking.frequency_hz': 0.0}, 'frequency_hz is 0 with figure rocking'),
    ('figure_1', {'figure': 'figure_1'}, "figure is 'figure_1'; expected one of errors, rates"),
    ('figure_1', {'gyro.delay_us.y': 0.0}, 'gyro.delay_us is 0 on every axis; expected a delay'),
    ('figure_1', {'detunings_rad_s': []}, 'detunings_rad_s is empty; expected at least one'),
    ('figure_1', {'detunings_rad_s': [0.1, 0.1]}, 'detunings_rad_s has a value twice'),
    ('rates', {'motion.two_axis.psi_rate_rad_s': 0.0, 'motion.two_axis.gamma_rate_rad_s': 0.0,
               'duration_s': 2.0}, 'are 0 with figure rates; expected at least one'),
    ('figure_3', {'accelerometer.delay_us.x': 1.0}, 'accelerometer.delay_us is not the default'),
    ('figure_3', {'gyro.errors.bias_deg_h': [1.0, 0.0, 0.0]}, 'gyro.errors is not the default; '
     'the study of delays expects instruments and a start without other errors'),
    ('figure_3', {'duration_s': 0.0}, 'duration_s is 0, endless'),
    ('figure_3', {'detuning_rad_s': 0.0}, "unknown parameter 'detuning_rad_s'"),
    ('figure_1', {'output_every': 1000, 'duration_s': 5.0}, 'output_every is 1000, which leaves '
     'one instant of the run; expected at least two'),
    ('recorded', {}, 'motion.recording.path is empty'),
    ('recorded', {'motion.recording.path': 'absent.csv'}, 'absent.csv'),
    ('figure_9', {}, "no config named 'delay_study_figure_9'")])
def test_bad_input_is_one_sentence(names, more, sentence, tmp_path, capsys, monkeypatch):
    """Invalid input gives exit code 2 and writes nothing; Python raises the same message."""
    monkeypatch.chdir(tmp_path)
    words = [word for key, value in more.items() for word in ('-p', f'{key}:={json.dumps(value)}')]
    assert main(['delay-study', '--params-file', f'delay_study_{names}', *words, '--jobs', '1',
                 '-o', 'out']) == 2
    said = capsys.readouterr().err
    assert sentence in said and said.count('\n') == 1 and list(tmp_path.iterdir()) == []
    with pytest.raises((ValueError, OSError)) as error:
        ins_sim.delay_study(f'delay_study_{names}', more, jobs=1)
    assert sentence in str(error.value) and '\n' not in str(error.value)


@pytest.mark.parametrize('words, sentence', [
    (['--recording', 'absent.csv'], 'absent.csv'), (['--jobs', '-1'], 'jobs is -1; expected 0'),
    (['--params-file', 'delay_study_rates', '--params-file', 'delay_study_rates'],
     'two figures are named delay_study_rates'),
    (['--params-file', 'motion_2'], 'motion_2: gyro.delay_us is 0 on every axis')])
def test_bad_words_are_one_sentence(words, sentence, tmp_path, capsys, monkeypatch):
    """Invalid arguments of the command line give one message."""
    monkeypatch.chdir(tmp_path)
    assert main(['delay-study', *words, '-p', 'duration_s:=2.0', '-o', 'out']) == 2
    said = capsys.readouterr().err
    assert sentence in said and said.count('\n') == 1 and list(tmp_path.iterdir()) == []


def test_names_that_are_none():
    """Empty and invalid names are refused from Python."""
    with pytest.raises(ValueError, match='names and recordings are empty; expected at least one'):
        ins_sim.delay_study([])
    with pytest.raises(ValueError, match='recordings is 3; expected a path or a list of paths'):
        ins_sim.delay_study([], recordings=3)


@pytest.mark.slow
@pytest.mark.filterwarnings('ignore::UserWarning')
def test_a_recorded_flight_is_one_more_figure(shared_data, tmp_path):
    """With a recording the run ends with it, with a note; delays cause less than 5 m."""
    path = shared_data / 'flights' / 'uavcircuit_umn_thor_fl75.csv.gz'
    found = ins_sim.delay_study([], {'motion.recording.smoothing_s': 1.0}, path, jobs=1)
    result, = found.results
    assert result.figure.name == 'recorded_uavcircuit_umn_thor_fl75'
    run, = result.runs
    assert 600.0 < run.t_s[-1] < 670.0
    assert any(f'ends after {run.t_s[-1]:.0f} s' in note for note in study_notes(found.results))
    far = np.abs(run.apart).max()
    assert 0.0 < far < 5.0
    assert np.abs(run.apart - run.predicted).max() <= 1e-2 * far
    rough = ins_sim.delay_study([], {'duration_s': 100.0}, [path], jobs=1)
    assert any('expected a higher rate_hz, or motion.recording.smoothing_s' in note
               for note in study_notes(rough.results))
