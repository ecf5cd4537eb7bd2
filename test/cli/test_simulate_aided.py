"""The verb simulate --aided: output and refusals."""

import json

from support.aided.runs import command, FLIGHT, flown, settings
from ins_sim import parameter_files
from ins_sim.cli.main import main
from ins_sim.core.aiding.navigator import GNSS, METER
from ins_sim.core.simulation.aided_run import navigate_aided, Reported, with_truth
from ins_sim.report import aided
from ins_sim.report.charts.chart import Curve, Stretch
from ins_sim.report.runs import aided_charts, page
import numpy as np
import pytest
from scipy.stats import chi2


@pytest.fixture(scope='module')
def run():
    """Return AidedSimulationSettings, motion, Run and AidedResult of the flight."""
    chosen = settings()
    return chosen, *flown(chosen)


@pytest.fixture(scope='module')
def rows(run):
    """Return {name: Row} of the flight."""
    chosen, _, free, solution = run
    return {row.name: row for row in aided.aided_rows(chosen, solution, free.states, free.errors)}


def test_the_command_writes_the_run(run, rows, tmp_path, capsys):
    """The run has arrays, rows, figures, track, page and parameters, which reproduce the run."""
    chosen, _, free, solution = run
    assert command(tmp_path) == 0
    shown = ' '.join(capsys.readouterr().out.split())
    for words in ('mean drift east', 'aided by eskf: velocity meter (surrogate), N 100, GNSS at 1 '
                  'Hz', 'NIS of gnss', 'gnss fixes: 91 reported, 60 taken, 31 refused: '
                  'invalid fix: outage (31)',
                  'velocity_meter fixes: 90 reported, 90 taken, 0 refused'):
        assert words in shown
    folder = tmp_path / 'run'
    assert {path.name for path in folder.iterdir()} == {
        '.ins_sim', 'run.npz', 'summary.json',
        'parameters.yaml', 'manifest.yaml', 'errors.png', 'aided.png', 'track.png', 'track.kml',
        'report.html'}
    for name in ('errors.png', 'aided.png', 'track.png'):
        assert (folder / name).read_bytes().startswith(b'\x89PNG')
    with np.load(folder / 'run.npz') as arrays:
        assert np.array_equal(arrays['errors_position'], free.errors.position)
        for name in ('truth', 'states', 'errors'):
            for field, values in getattr(solution, name).arrays().items():
                assert np.array_equal(arrays[f'aided_{name}_{field}'], values)
        assert arrays['velocity_meter_velocity'].tolist() == [
            list(fix.velocity) for fix in solution.velocity_fixes]
        assert arrays['gnss_t_ns'].tolist() == [fix.t_ns for fix in solution.gnss_fixes]
        assert arrays['gnss_status'].tolist() == ['valid'] * 60 + ['outage'] * 31
        meter = arrays['judged_source'] == METER
        assert np.array_equal(arrays['judged_nis'][meter], [
            t.outcome.nis for t in solution.judged if t.source == METER])
        assert np.isnan(arrays['judged_nis'][~meter & ~arrays['judged_taken']]).all()
    told = json.loads((folder / 'summary.json').read_text())
    assert told[0]['name'] == 'mean drift east'
    assert {row['name']: row['measured'] for row in told if row['name'] in rows} == {
        name: row.measured for name, row in rows.items()}
    file = folder / 'parameters.yaml'
    assert parameter_files.read_aided([file]) == chosen
    assert parameter_files.read([file]) == chosen.simulation
    text = file.read_text()
    assert all(f'/**/{node}:' in text for node in (
        'motion_generator', 'imu_sensor', 'strapdown', 'velocity_meter', 'gnss',
        'aided_navigator'))


def test_without_aided_the_run_is_as_before(run, tmp_path, capsys):
    """Without --aided: the same free solution, parameters of three nodes, no fixes."""
    arguments = [w for text in FLIGHT for w in ('-p', text)]
    assert main(['simulate', '--params-file', 'gnss_outage_flight', '--params-file', 'grade_mid',
                 *arguments, '-o', str(tmp_path / 'run')]) == 0
    assert 'fixes' not in capsys.readouterr().out
    with np.load(tmp_path / 'run' / 'run.npz') as arrays:
        assert np.array_equal(arrays['errors_position'], run[2].errors.position)
        assert not [name for name in arrays if 'aided' in name or 'fix' in name]
    assert 'velocity_meter:\n' not in (tmp_path / 'run' / 'parameters.yaml').read_text()
    assert not (tmp_path / 'run' / 'aided.png').exists()


def test_the_rows_are_the_errors(run, rows, capsys):
    """Each row equals a value computed independently; NIS is within chi-square (1 in 10^6)."""
    _, _, free, solution = run
    errors = solution.errors
    east, north = errors.position[:, 0], errors.position[:, 1]
    assert rows['aided max |dN|'].measured == np.abs(north).max()
    assert rows['aided max |dE|'].free == np.abs(free.errors.position[:, 0]).max()
    rms, end = rows['aided rms horizontal'], rows['aided horizontal at the end']
    assert rms.measured == pytest.approx(np.sqrt(np.mean(east ** 2 + north ** 2)), rel=1e-12)
    assert end.measured == np.hypot(east[-1], north[-1])
    assert end.sigma == np.hypot(*errors.position_sigma[-1, :2])
    sigma = errors.attitude_sigma
    assert rows['aided attitude in 3 sigma'].measured == 100.0 * np.mean(
        np.abs(errors.attitude) <= 3.0 * sigma)
    for source, freedom in ((METER, 2), (GNSS, 4)):
        row = rows[f'aided NIS of {source}']
        nis = [t.outcome.nis for t in solution.judged
               if t.source == source and t.outcome.nis is not None]
        low, high = chi2.interval(0.95, freedom * len(nis))
        assert (row.low * len(nis), row.high * len(nis)) == pytest.approx((low, high), rel=1e-9)
        assert row.measured == pytest.approx(np.mean(nis), rel=1e-12)
        low, high = chi2.interval(1.0 - 1e-6, freedom * len(nis))
        assert low < sum(nis) < high
    mounting = rows['aided mounting mu']
    assert mounting.true == pytest.approx(20.0, rel=1e-15)
    assert mounting.sigma == pytest.approx(
        np.degrees(solution.errors.estimates_sigma[-1, 0]) * 60.0, rel=1e-12)
    # Five sigmas of the filter.
    assert abs(mounting.measured - 20.0) < 5.0 * mounting.sigma < 5.0 * 30.0
    assert 'aided scale kx' not in rows
    with capsys.disabled():
        print(f'\n90 s, GNSS out for the last 30: aided rms {rms.measured:.3f} m (alone '
              f'{rms.free:.2f}), end {end.measured:.3f} m (alone {end.free:.2f}); NIS '
              + ', '.join(f'{s} {rows[f"aided NIS of {s}"].measured:.3f} '
                          f'({rows[f"aided NIS of {s}"].low:.2f} to '
                          f'{rows[f"aided NIS of {s}"].high:.2f})' for s in (METER, GNSS))
              + f'; mu {mounting.measured:.2f} +- {mounting.sigma:.2f} arcmin (true 20)')


def test_the_figure_shows_where_fixes_are_missing():
    """Outage and drop-outs are shaded in different colours, and no mean is drawn across them."""
    chosen = settings('drop_outs.start_s:=[20.0,70.0]', 'drop_outs.end_s:=[40.0,75.0]',
                      'outages.start_s:=[30.0]', 'outages.end_s:=[60.0]')
    flight = flown(chosen)[-1]
    chart = aided_charts.aided_chart('title', flight, (METER, GNSS), 0.0)
    start_s = flight.errors.t_ns[0] * 1e-9
    for panel in chart.panels:
        assert panel.x_label == 'time [s]'
        spans = {mark.label: np.transpose([mark.first, mark.last]) + start_s
                 for mark in panel.marks if isinstance(mark, Stretch)}
        # Windows of one second, stamped at their ends, that overlap the drop-outs.
        assert np.allclose(spans['no velocity meter'], [(21.0, 41.0), (71.0, 76.0)])
        assert np.allclose(spans['no GNSS'], [(30.0, 60.0)])
        assert len({mark.colour for mark in panel.marks if isinstance(mark, Stretch)}) == 2
    for source, first, last in ((METER, 20.5, 40.5), (GNSS, 29.5, 59.5)):
        means = [mark.x + start_s for mark in chart.panels[-1].marks if isinstance(mark, Curve)
                 and mark.colour == aided_charts.SOURCES[source][0]]
        assert len(means) == 2 - (source == METER)
        for mean in means:
            assert mean[-1] < first or mean[0] > last


def test_what_is_not_known_is_not_shown(tmp_path, capsys):
    """Without covariance no sigma, NIS or estimates are shown; without GNSS no outages."""
    assert command(tmp_path, flight=('duration_s:=30.0', 'filter:=conventional')) == 0
    shown = ' '.join(capsys.readouterr().out.split())
    assert 'aided by conventional: velocity meter (surrogate), N 1000' in shown
    assert '3 sigma' not in shown and 'NIS of' not in shown and 'gnss' not in shown
    names = [row['name'] for row in json.loads((tmp_path / 'run' / 'summary.json').read_text())]
    assert 'aided velocity_meter fixes taken' in names and 'aided gnss fixes taken' not in names
    assert command(tmp_path, '--force', flight=('duration_s:=5.0', 'filter:=free')) == 0
    assert 'not aided by any fix' in capsys.readouterr().out
    assert np.isnan(np.load(tmp_path / 'run' / 'run.npz')['aided_errors_position_sigma']).all()


def test_reasons_of_refusals_are_counted():
    """Rejected fixes are counted by reason: the meter cannot measure the speed of the flight."""
    chosen = settings('limits.speed_min_m_s:=390.0', 'duration_s:=10.0')
    _, free, solution = flown(chosen)
    rows = {r.name: r for r in aided.aided_rows(chosen, solution, free.states, free.errors)}
    refused = rows['aided velocity_meter fixes refused']
    assert refused.measured == 10
    assert refused.note == 'invalid fix: speed outside the limits (10)'
    assert 'aided NIS of velocity_meter' not in rows


def test_lost_samples_leave_the_instruments_alone(tmp_path, capsys):
    """Lost IMU samples do not change the fixes; the navigator starts anew and logs it."""
    chosen = settings('duration_s:=20.0', 'attack_angle:=none')
    _, _, whole = flown(chosen)
    lost = settings('duration_s:=20.0', 'attack_angle:=none',
                    'sampling.drop_out_probability:=0.005')
    _, run, solution = flown(lost)
    assert len(run.imu) < 2001 and solution.faults
    assert solution.velocity_fixes == whole.velocity_fixes
    assert solution.gnss_fixes == whole.gnss_fixes
    assert command(tmp_path, assignments=('duration_s:=20.0',
                                          'sampling.drop_out_probability:=0.005')) == 0
    shown = ' '.join(capsys.readouterr().out.split())
    assert f'{len(solution.faults)} faults of the aided navigator; the first: imu has a gap' \
        in shown


@pytest.mark.parametrize('length', [4096, 333, 1])
def test_fixes_of_several_latencies_come_in_the_order_of_arrival(length):
    """For any block length a late fix of one sensor does not delay those of the other."""
    # In ROS an empty list does not replace a list.
    flight = [text for text in FLIGHT if not text.startswith('outages.')]
    chosen = settings('duration_s:=20.0', 'window.latency_ms:=2500.0', 'gnss.latency_ms:=120.0',
                      flight=flight)
    motion, run, solution = flown(chosen)
    arrivals = [(t.t_ns + (2_500_000_000 if t.source == METER else 120_000_000))
                for t in solution.judged]
    assert arrivals == sorted(arrivals) and len(arrivals) == 17 + 20
    cut = (run.imu[k:k + length] for k in range(0, len(run.imu), length))
    again = navigate_aided(chosen.aided_navigator, with_truth(motion, cut),
                           Reported(list(solution.velocity_fixes)),
                           Reported(list(solution.gnss_fixes)))
    assert [(t.source, t.t_ns) for t in again.judged] == [
        (t.source, t.t_ns) for t in solution.judged]
    assert np.array_equal(again.errors.position, solution.errors.position)


@pytest.mark.parametrize('assignments, sentence', [
    (['gnss_model.use:=true', 'filter:=window_kf'], 'expected a filter that processes GNSS: eskf'),
    (['outages.start_s:=[1.0]'], 'outages.start_s has 1 entries and outages.end_s 2'),
    (['motion.route.points.latitude_deg:=[55.0]'], 'motion_generator: motion.route.points: the '
     'route has 1 latitudes and 7 longitudes'),
    (['sampling.jitter_us:=5.0'], 'imu_sensor: sampling.jitter_us is 5 us; expected 0 with'),
    (['limits.speed_min_m_s:=400.0'], 'limits.speed_min_m_s is 400; expected less than'),
    (['gnss.rate_hz:=60.0'], 'gnss.rate_hz is 60 Hz, a period of'),
    (['initial.after_s:=20.0', 'duration_s:=10.0'], 'the run navigates for'),
    (['gnss_model.lever:=1.0'], "unknown parameter 'gnss_model.lever'")])
def test_bad_input_is_one_sentence(assignments, sentence, tmp_path, capsys):
    """Invalid input gives one message before the run, and nothing is written."""
    wanted = ('outages.end_s:=[300.0, 400.0]',) if 'outages.start_s:=[1.0]' in assignments else ()
    assert command(tmp_path, flight=wanted, assignments=assignments) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.startswith('ins_sim simulate: ')
    assert error.count('\n') == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize('node, parameters, sentence', [
    ('velocity_meter', 'window: {cycles: 50}', 'aided_navigator: window is Window(cycles=1000'),
    ('gnss', 'gnss: {rate_hz: 5.0}', 'aided_navigator: gnss is GnssTiming(rate_hz=1.0'),
    ('imu_sensor', 'rate_hz: 50.0', 'rate_hz is 100 Hz; expected the rate of imu_sensor, 50 Hz'),
    ('motion_generator', 'rate_hz: 200.0', 'velocity_meter: rate_hz is 100 Hz; expected the rate '
     'of motion_generator, 200 Hz'),
    ('aided_navigator', 'motion: {route: {points: {latitude_deg: [1.0, 2.0], longitude_deg: [1.0, '
     '2.0]}}}', 'aided_navigator: motion.route.points differ from those of motion_generator')])
def test_nodes_that_do_not_agree(node, parameters, sentence, tmp_path, capsys):
    """A file that sets a common parameter for one node only is refused before the run."""
    file = tmp_path / 'one.yaml'
    file.write_text(f'/**/{node}:\n  ros__parameters:\n    {parameters}\n')
    assert command(tmp_path, flight=(), files=('gnss_outage_flight', str(file))) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1
    assert list(tmp_path.iterdir()) == [file]


def test_an_aided_run_is_replaced_with_force_alone(tmp_path, capsys):
    """An aided run is replaced with --force only."""
    flight = ('duration_s:=5.0',)
    assert command(tmp_path, flight=flight) == 0
    before = (tmp_path / 'run' / 'run.npz').read_bytes()
    assert command(tmp_path, flight=flight) == 2
    assert 'exists; expected a new folder' in capsys.readouterr().err
    assert (tmp_path / 'run' / 'run.npz').read_bytes() == before
    assert command(tmp_path, '--force', flight=('duration_s:=4.0',)) == 0
    assert (tmp_path / 'run' / 'run.npz').read_bytes() != before


@pytest.mark.parametrize('where', ['aiding', 'writing'])
def test_an_interrupted_run_leaves_nothing(where, tmp_path, monkeypatch, capsys):
    """Ctrl-C during navigation or drawing keeps the old run."""
    flight = ('duration_s:=5.0',)
    assert command(tmp_path, flight=flight) == 0
    before = sorted((p.name, p.read_bytes()) for p in (tmp_path / 'run').iterdir())

    def interrupt(*arguments, **options):
        raise KeyboardInterrupt

    if where == 'aiding':
        monkeypatch.setattr('ins_sim.core.aiding.navigator.AidedNavigator.step', interrupt)
    else:
        monkeypatch.setattr(page, 'save_chart', interrupt)
    assert command(tmp_path, '--force', flight=flight) == 130
    assert 'interrupted' in capsys.readouterr().err
    assert sorted((p.name, p.read_bytes()) for p in (tmp_path / 'run').iterdir()) == before
    assert [p.name for p in tmp_path.iterdir()] == ['run']
