"""Records as xarray Datasets keep the arrays, with dimensions, labels and units."""

import sys

import ins_sim
from ins_sim.api.datasets import dataset, DIMENSIONS
from ins_sim.core.timeseries.named_columns import COLUMNS, ENU, UNITS
import numpy as np
import pytest
from support.readings.imu_records import record_at_rest
from support.studies import LATE_MOTION_2

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


def check(found, history):
    """Assert that a Dataset holds the arrays of a History."""
    fields = history.arrays()
    np.testing.assert_array_equal(found['time'], fields.pop('t_ns'))
    assert found['time'].dtype == np.int64 and found['time'].attrs == {'units': 'ns'}
    assert set(found.data_vars) == set(fields)
    for name, values in fields.items():
        components, unit = COLUMNS[name]
        np.testing.assert_array_equal(found[name], values)
        assert found[name].attrs == {'units': UNITS[unit]}
        dims = ('time', DIMENSIONS[components]) if components else ('time',)
        assert found[name].dims == dims
        for dim in dims[1:]:
            assert tuple(found[dim].values) == components


def test_records_of_runs(run, aided):
    """Every record of a run becomes a Dataset, and the Datasets of a run can be merged."""
    xarray = pytest.importorskip('xarray', reason='xarray is not installed')
    for record in ('errors', 'states', 'truth', 'imu', 'twin'):
        found = run.to_xarray(record)
        check(found, getattr(run, record))
        assert found.attrs == {'record': record}
    for record in ('errors', 'states', 'truth'):
        check(aided.to_xarray(record), getattr(aided, record))
    north = run.to_xarray()['position'].sel(axis='north')
    np.testing.assert_array_equal(north, run.errors.position[:, 1])
    both = xarray.merge([run.to_xarray(), run.to_xarray('imu')], combine_attrs='drop')
    assert dict(both.sizes) == {'time': 201, 'axis': 3, 'body_axis': 3}
    with pytest.raises(ValueError, match="record is 'error'; expected one of errors, states"):
        run.to_xarray('error')


def test_records_of_a_navigation(tmp_path):
    """A Navigation gives Datasets of the solution and of its errors against a reference."""
    pytest.importorskip('xarray', reason='xarray is not installed')
    (tmp_path / 'track.csv').write_text('t_s,lat_deg,lon_deg,height_m\n' + ''.join(
        f'{k},45.0,0.0,0.0\n' for k in range(4)))
    found = ins_sim.navigate(record_at_rest(300), {
        **AT_REST, 'reference.path': str(tmp_path / 'track.csv')})
    check(found.to_xarray(), found.segments[0])
    position = found.to_xarray('position')
    assert position['position'].dims == ('time', 'axis')
    np.testing.assert_array_equal(position['position'], found.comparisons[0].position.values)
    for call in (found.to_xarray, found.to_dataframe):
        with pytest.raises(ValueError, match='reference is 1; the navigation was compared with 1'):
            call('position', 1)
        with pytest.raises(ValueError, match='has no velocity; expected another record'):
            call('velocity')


def test_a_dataset_of_many_runs():
    """Dimensions have the given names; a quantity without unit has no attribute units."""
    pytest.importorskip('xarray', reason='xarray is not installed')
    values = np.arange(24.0).reshape(2, 4, 3)
    found = dataset({'run': ((3, 7), ''), 'time': (np.arange(4), 'ns'), 'axis': (ENU, '')},
                    {'position': (('run', 'time', 'axis'), values, 'm'),
                     'nees': (('run',), values[:, 0, 0], '')}, {'seed': 1})
    assert found['position'].sel(run=7, axis='up').values.tolist() == [14.0, 17.0, 20.0, 23.0]
    assert found['position'].attrs == {'units': 'm'} and found['nees'].attrs == {}
    assert found['run'].attrs == {} and found.attrs == {'seed': 1}


def test_without_xarray(run, monkeypatch):
    """Without xarray, to_xarray names the package to install."""
    monkeypatch.setitem(sys.modules, 'xarray', None)
    with pytest.raises(ImportError, match=r"expected pip install 'ins_sim\[xarray\]'"):
        run.to_xarray()
