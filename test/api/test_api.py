"""The public functions: examples, types, and what they return."""

import doctest
from importlib import import_module
import subprocess
import sys

import ins_sim
from ins_sim.cli.main import main
from ins_sim.core.timeseries import histories
from ins_sim.core.timeseries.named_columns import COLUMNS, columns
import numpy as np
import pytest
from support.readings.imu_records import record_at_rest
from support.places import ROOT
from support.studies import LATE_MOTION_2, LATE_MOTION_2_WORDS

FUNCTIONS = ('read_settings', 'simulate', 'predict', 'simulate_aided', 'navigate', 'open_motion',
             'open_bag', 'presets')
SHORT = {'duration_s': 2.0}
AIDED = {'duration_s': 3.0, 'window.cycles': 100}


@pytest.fixture(scope='module')
def run():
    """Return two seconds of motion 2."""
    return ins_sim.simulate(ins_sim.read_settings(LATE_MOTION_2, SHORT))


@pytest.fixture(scope='module')
def aided():
    """Return three seconds of the aided flight."""
    return ins_sim.simulate_aided(
        ins_sim.read_settings(['route_flight', 'grade_mid'], AIDED, aided=True))


def test_import_loads_neither_numpy_nor_yaml():
    """Importing ins_sim loads neither NumPy nor YAML."""
    code = ('import sys, ins_sim; print(sorted({"numpy", "yaml", "scipy", "ins_sim.api"} '
            '& set(sys.modules))); print("simulate" in dir(ins_sim)); ins_sim.simulate; '
            'print("numpy" in sys.modules, "matplotlib" in sys.modules, "pandas" in sys.modules)')
    result = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True,
                            check=True)
    assert result.stdout.split('\n')[:3] == ['[]', 'True', 'True False False']


@pytest.mark.parametrize('name', ins_sim.__all__)
def test_every_public_name_can_be_imported_and_is_described(name):
    """Each public name has a docstring; an unknown name raises AttributeError."""
    assert getattr(ins_sim, name).__doc__
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        ins_sim.simulat


@pytest.mark.parametrize('name', FUNCTIONS)
def test_examples_of_the_docstring(name, tmp_path, monkeypatch):
    """Each function has an Examples section that runs."""
    monkeypatch.chdir(tmp_path)
    if name == 'open_bag':
        assert main(['simulate', *LATE_MOTION_2_WORDS, '-p', 'duration_s:=2.0', '-o', 'run',
                     '--bag', 'motion_2_bag']) == 0
    function = getattr(ins_sim, name)
    assert 'Examples\n' in function.__doc__
    module = import_module(function.__module__)
    tests = doctest.DocTestFinder(recurse=False).find(function, name, module)
    runner = doctest.DocTestRunner()
    for test in tests:
        runner.run(test)
    assert runner.summarize().failed == 0 < runner.tries


@pytest.mark.slow
def test_types():
    """The type checker mypy finds nothing in the public functions."""
    pytest.importorskip('mypy', reason='mypy is not installed')
    result = subprocess.run([sys.executable, '-m', 'mypy'], cwd=ROOT, capture_output=True,
                            text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def test_values_are_taken_bit_by_bit():
    """Floats, NumPy numbers and arrays are passed with all their bits, not through text."""
    third = 1.0 / 3.0
    settings = ins_sim.read_settings(LATE_MOTION_2, {
        'gyro.delay_us.y': third, 'gyro.delay_us.x': np.float64(third),
        'strapdown:output_every': np.int64(10),
        'gyro.errors.bias_deg_h': np.array([third, 0.0, 1e-17])})
    gyro = settings.imu_sensor.gyro
    assert (gyro.delay_us.x, gyro.delay_us.y) == (third, third)
    assert gyro.errors.bias_deg_h == (third, 0.0, 1e-17)
    assert settings.strapdown.output_every == 10


def test_a_saved_run_is_that_of_the_command_line(run, tmp_path):
    """A saved run equals that of the command; without overwrite an existing folder is kept."""
    assert main(['simulate', *LATE_MOTION_2_WORDS, '-p', 'duration_s:=2.0', '-o',
                 str(tmp_path / 'verb')]) == 0
    run.save(tmp_path / 'api')
    same_folders(tmp_path / 'verb', tmp_path / 'api')
    with pytest.raises(ValueError, match=r'exists; expected a new folder \(or overwrite=True\)'):
        run.save(tmp_path / 'api')
    run.save(tmp_path / 'api', overwrite=True)
    (tmp_path / 'other').mkdir()
    (tmp_path / 'other' / 'file').touch()
    with pytest.raises(ValueError, match='it has no marker .ins_sim of ins_sim; overwrite=True '
                                         'replaces only'):
        run.save(tmp_path / 'other', overwrite=True)


def test_a_saved_aided_run_is_that_of_the_command_line(aided, tmp_path):
    """A saved aided run has the arrays, parameters and summary of the command."""
    assert main(['simulate', '--aided', '--params-file', 'route_flight', '--params-file',
                 'grade_mid', '-p', 'duration_s:=3.0', '-p', 'window.cycles:=100', '-o',
                 str(tmp_path / 'verb')]) == 0
    aided.save(tmp_path / 'api')
    same_folders(tmp_path / 'verb', tmp_path / 'api')


def same_folders(one, other):
    """Assert that two folders of runs are equal, except for their pictures."""
    assert {p.name for p in one.iterdir()} == {p.name for p in other.iterdir()}
    for name in ('parameters.yaml', 'manifest.yaml', 'summary.json'):
        assert (one / name).read_text() == (other / name).read_text()
    for name in {p.name for p in one.glob('*.npz')}:
        with np.load(one / name) as a, np.load(other / name) as b:
            assert set(a) == set(b)
            for key in a:
                np.testing.assert_array_equal(a[key], b[key])


def test_every_field_of_a_history_has_its_columns():
    """The table of columns knows every array of every history."""
    for cls in (histories.Truth, histories.ImuSamples, histories.NavStates, histories.NavErrors,
                histories.AidedErrors):
        assert set(cls.__dataclass_fields__) - {'t_ns'} <= set(COLUMNS)
    assert list(columns('v_n', np.zeros((2, 3)))) == ['v_n_east_m_s', 'v_n_north_m_s',
                                                      'v_n_up_m_s']


def test_tables(run, aided):
    """The index of a table is time in ns; columns are named by field, component and unit."""
    pytest.importorskip('pandas', reason='pandas is not installed')
    table = run.to_dataframe()
    assert table.index.name == 't_ns' and table.index.dtype == np.int64
    np.testing.assert_array_equal(table['position_north_m'], run.errors.position[:, 1])
    assert {'truth', 'imu', 'states', 'twin'} == {
        name for name in ('truth', 'imu', 'states', 'twin') if len(run.to_dataframe(name))}
    assert list(aided.to_dataframe().columns)[-3:] == [
        'estimates_sigma_mounting_rad', 'estimates_sigma_scale_x', 'estimates_sigma_scale_z']
    with pytest.raises(ValueError, match="record is 'error'; expected one of errors, states"):
        run.to_dataframe('error')
    alone = ins_sim.simulate(run.settings, twin=False)
    with pytest.raises(ValueError, match="record is 'twin', which this run does not have"):
        alone.to_dataframe('twin')


def test_tables_without_pandas(run, monkeypatch):
    """Without pandas, to_dataframe names the package to install."""
    monkeypatch.setitem(sys.modules, 'pandas', None)
    with pytest.raises(ImportError, match=r"pip install 'ins_sim\[dataframe\]'"):
        run.to_dataframe()


def test_arrays_into_navigate(tmp_path):
    """The solution of arrays is that of the same samples in a CSV file, to the last bit."""
    start = {'initial.position': 'given', 'initial.latitude_deg': 45.0,
             'initial.attitude': 'given', 'initial.heading_deg': 90.0,
             'initial.velocity': 'given'}
    own = record_at_rest(500)
    names = 't_s,gx_rps,gy_rps,gz_rps,ax_mps2,ay_mps2,az_mps2'
    rows = [','.join([f'{t * 1e-9:.2f}', *map(repr, (*w, *f))]) for t, w, f in zip(
        own.t_ns.tolist(), own.omega.tolist(), own.f.tolist())]
    (tmp_path / 'imu.csv').write_text('\n'.join([names, *rows, '']))
    given = ins_sim.navigate(own, start)
    read = ins_sim.navigate(tmp_path / 'imu.csv', start)
    for name, values in given.segments[0].arrays().items():
        np.testing.assert_array_equal(values, read.segments[0].arrays()[name])
    assert given.figures['samples'] == 500
    given.save(tmp_path / 'nav')
    with pytest.raises(ValueError, match='overwrite=True'):
        given.save(tmp_path / 'nav')
    with pytest.raises(ValueError, match='reference is 0; the navigation was compared with 0'):
        given.to_dataframe('position')
    with pytest.raises(ValueError, match="record is 'place'; expected one of"):
        given.to_dataframe('place')


def test_a_motion_of_settings_and_of_a_bag(tmp_path):
    """The truth of a bag is that of the motion from which it was written."""
    settings = ins_sim.read_settings(LATE_MOTION_2, {'duration_s': 12.0})
    assert main(['simulate', *LATE_MOTION_2_WORDS, '-p', 'duration_s:=12.0', '-o',
                 str(tmp_path / 'run'), '--bag', str(tmp_path / 'bag')]) == 0
    recorded = ins_sim.open_motion(tmp_path / 'bag')
    t_ns = np.array([1_000_000_000])
    later = ins_sim.open_motion(settings).at(t_ns + 3_000_000_000)
    # 4 s is a knot of the spline, which carries the recorded rate to rounding.
    np.testing.assert_allclose(recorded.at(t_ns).omega_ib_b, later.omega_ib_b, rtol=0.0,
                               atol=1e-14)
    with ins_sim.open_bag(tmp_path / 'bag') as bag:
        assert '/imu/data_raw' in bag.topics
    with pytest.raises(ValueError, match='values are given with settings'):
        ins_sim.open_motion(settings, {})


def test_results_are_one_line_in_a_notebook(run, aided):
    """The repr of a result is one line without arrays."""
    start = {'initial.position': 'given', 'initial.latitude_deg': 45.0,
             'initial.attitude': 'given', 'initial.velocity': 'given'}
    record = record_at_rest(100)
    assert repr(run) == '<Run: 201 instants from 0 to 2 s>'
    assert repr(aided).startswith('<AidedRun: filter eskf, ') and len(repr(aided)) < 100
    assert repr(record) == '<ImuRecord: 100 samples>'
    assert repr(ins_sim.navigate(record, start)) == (
        '<Navigation: ImuRecord, 1 segments, compared with 0 references>')
