"""Ensembles of the aided simulation and the comparison of filters from Python."""

import ins_sim
import numpy as np
import pytest

VALUES = {'duration_s': 10.0, 'window.cycles': 100, 'gnss_model.use': True}


@pytest.fixture(scope='module')
def settings():
    """Return the settings of a short flight."""
    return ins_sim.read_settings(['gnss_outage_flight', 'grade_mid'], VALUES, aided=True)


@pytest.fixture(scope='module')
def ensemble(settings):
    """Return three runs, the first of which is run 2."""
    return ins_sim.monte_carlo(settings.with_run(2), runs=3, instants=3, jobs=1)


def test_a_run_of_the_ensemble_flies_alone(settings, ensemble):
    """A run of the ensemble equals to the bit the single simulation with its run number."""
    alone = ins_sim.simulate_aided(settings.with_run(3), twin=False)
    np.testing.assert_array_equal(ensemble.final_errors['position'][1], alone.errors.position[-1])
    assert ensemble.runs == range(2, 5) and ensemble.diverged == ()


def test_nees_and_nis_are_columns(ensemble):
    """NEES columns accompany the error statistics, with intervals; NIS has one row per fix."""
    pytest.importorskip('pandas')
    table = ensemble.to_dataframe()
    assert table['nees_state_expected'].tolist()[1:] == [13.0, 13.0]
    assert table['nees_position_low'].iloc[-1] < 2.0 < table['nees_position_high'].iloc[-1]
    assert len(table['position_sigma_north_m']) == 3
    fixes = ensemble.to_dataframe('velocity_meter')
    assert fixes.index.tolist() == [k * 10 ** 9 for k in range(1, 11)]
    assert fixes['taken'].tolist() == [3] * 10 and (fixes['nis_expected'] == 2.0).all()
    with pytest.raises(ValueError, match="record is 'imu'; expected errors, final or "):
        ensemble.to_dataframe('imu')


def test_nees_and_nis_are_variables(ensemble):
    """NEES has the dimensions time and block, NIS the instants of the fixes."""
    pytest.importorskip('xarray')
    found = ensemble.to_xarray()
    assert found['nees'].sel(block='attitude').shape == (3,)
    assert found['gnss_nis'].dims == ('gnss_time',) and found.sizes['gnss_time'] == 11
    assert found.attrs['digest'] == ensemble.digest


def test_the_comparison(settings, tmp_path):
    """A comparison has a row per filter, arrays by filter, flight and time, and can be saved."""
    with pytest.raises(ValueError, match='gnss_model.use'):
        ins_sim.read_settings(['route_flight'], {**VALUES, 'filter': 'free'}, aided=True)
    study = ins_sim.compare_filters(settings, runs=2, filters=['free', 'eskf'], jobs=1)
    assert study.best == 'eskf, N 100'
    study.save(tmp_path / 'study')
    assert {'comparison.json', 'comparison.png', 'report.html'} <= {
        path.name for path in (tmp_path / 'study').iterdir()}
    pytest.importorskip('pandas')
    table = study.to_dataframe()
    assert table['filter'].tolist() == ['free', 'eskf'] and np.isnan(table['nis'][0])
    assert table['consistency'].tolist()[0] == ''
    pytest.importorskip('xarray')
    found = study.to_xarray()
    assert dict(found.sizes) == {'case': 2, 'run': 2, 'time': 3, 'axis': 3, 'block': 4}
    assert np.isnan(found['nees'].sel(case='free, N 100')).all()
    end = found['position'].sel(case='eskf, N 100', axis='east').values[:, -1]
    assert end.tolist() == [f.error[-1, 0] for f in study.found.flown[1]]


@pytest.mark.parametrize('call, sentence', [
    (lambda s: ins_sim.monte_carlo(3), 'settings are int; expected SimulationSettings or '),
    (lambda s: ins_sim.compare_filters(s.simulation), 'settings are SimulationSettings; expected'),
    (lambda s: ins_sim.compare_filters(s, filters='eskf'), "filters is 'eskf'; expected a list"),
    (lambda s: ins_sim.compare_filters(s, runs=0), 'runs is 0; expected a whole number from 1')])
def test_refusals(settings, call, sentence):
    """Invalid arguments are refused with one message each."""
    with pytest.raises(ValueError, match=sentence):
        call(settings)
