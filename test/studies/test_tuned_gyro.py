"""The study of Sapegin et al. (2016): both tables, both stability limits, and their files."""

import math

import numpy as np
import pytest

from ins_sim import parameter_files
from ins_sim.cli.main import main
from ins_sim.core.numerics import compilation
from ins_sim.core.sensors.tuned_gyro.pair import GyroPair
from ins_sim.studies.tuned_gyro import (gyro_at, half_peak_to_peak, rocking_amplitudes,
                                        stability_limits, study_curve, study_table)
from ins_sim.settings.tuned_gyro import TunedGyroStudySettings
from ins_sim.core.sensors.tuned_gyro.rotor import PRESETS
from ins_sim.core.sensors.tuned_gyro.report import tuned_gyro_report
from support.places import ROOT

CONFIG = ROOT / 'config'
FILES = sorted(CONFIG.glob('dtg_study_*.yaml'))

# Values of the `sapegin_2016` preset in the specification, deg.
SPECIFIED = {0.5: 9.978, 1.0: 9.912, 2.0: 9.661, 4.0: 8.819, 8.0: 6.831,
             130.0: 9.972, 143.0: 9.966, 170.0: 9.952, 200.0: 9.933, 250.0: 9.896, 270.0: 9.879,
             320.0: 9.832, 337.0: 9.814}


def read(name, *assignments):
    """Return the TunedGyroStudySettings of config/dtg_study_<name>.yaml."""
    return parameter_files.read_nodes([CONFIG / f'dtg_study_{name}.yaml'], assignments,
                                      {'dtg_study': TunedGyroStudySettings})['dtg_study']


@pytest.fixture(scope='module')
def tables():
    """Return both tables of the paper, RK4 at 0.75 ms."""
    return {name: study_table(read(name)) for name in ('frequency', 'speed')}


def show(cells, unit):
    """Print a table."""
    print()
    for c in cells:
        print(f'{c.value:6g} {unit}: {c.poisson_deg:.4f} deg, paper {c.paper_deg:g}, '
              f'Poisson - Euler vector {c.poisson_deg - c.euler_vector_deg:.1e}')


def record(figures, tables, name):
    """Record the cells of a table."""
    figures.record(f'tuned_gyro.study.{name}', [c.poisson_deg for c in tables[name]], 'deg',
                   [c.paper_deg for c in tables[name]], 'published')


def test_table_of_frequencies(tables, figures):
    """The table over frequencies agrees to 0.012 deg (two-decimal cells) and 0.05 deg."""
    show(tables['frequency'], 'rad/s')
    record(figures, tables, 'frequency')
    assert [c.value for c in tables['frequency']] == [0.5, 1.0, 2.0, 4.0, 8.0]
    for c in tables['frequency']:
        bound = 0.05 if c.value in (0.5, 8.0) else 0.012
        assert abs(c.poisson_deg - c.paper_deg) <= bound


def test_table_of_speeds(tables, figures):
    """All eight cells of the table over rotor speeds agree to 0.01 deg."""
    show(tables['speed'], 'Hz')
    record(figures, tables, 'speed')
    assert len(tables['speed']) == 8
    for c in tables['speed']:
        assert abs(c.poisson_deg - c.paper_deg) <= 0.01


def test_both_algorithms_agree(tables):
    """Both algorithms agree to 1e-11 deg in every cell, and with the reference values."""
    for c in (*tables['frequency'], *tables['speed']):
        assert abs(c.poisson_deg - c.euler_vector_deg) <= 1e-11
        assert c.poisson_deg == pytest.approx(SPECIFIED[c.value], abs=6e-4)


def test_amplitudes_are_those_of_a_first_order_lag(tables):
    """
    Amplitudes are 10 / sqrt(1 + (w T)^2) to 1e-3 deg, those of a first-order lag.

    A is small, and the gyro settles within 20 s.
    """
    lag = tuned_gyro_report(PRESETS['sapegin_2016']).time_constant_s
    for c in tables['frequency']:
        assert c.poisson_deg == pytest.approx(10.0 / math.hypot(1.0, c.value * lag), abs=1e-3)


def test_exact_propagation_of_the_damped_preset(tables):
    """`sapegin_2016_damped`, physically stable, gives the same tables to 1e-4 deg."""
    cells = [c for name in tables
             for c in study_table(read(name, 'preset:=sapegin_2016_damped', 'method:=exact'))]
    off = max(abs(a.poisson_deg - b.poisson_deg)
              for a, b in zip(cells, (*tables['frequency'], *tables['speed'])))
    print(f'\nexact, sapegin_2016_damped: off by {off:.1e} deg')
    assert off <= 1e-4


def test_stability_limits(figures):
    """The limits at 0.75 ms are 129.4 and 337.4 Hz, found by search; published are 130 and 337."""
    settings = read('speed')
    assert settings.paper_limits_hz == (130.0, 337.0)
    step_s = 1e-3 * settings.step_ms
    low, high = stability_limits(gyro_at(settings), step_s)
    print(f'\nRK4 at 0.75 ms is stable from {low:.4f} to {high:.4f} Hz; paper '
          f'{settings.paper_limits_hz}')
    figures.record('tuned_gyro.study.limits', (low, high), 'Hz', (129.4, 337.4), 'specification')
    assert abs(low - 129.4) <= 0.1 and abs(high - 337.4) <= 0.1
    assert stability_limits(gyro_at(settings), step_s, 200.0, 300.0) == (None, None)


@pytest.mark.parametrize('preset, method', [('sapegin_2016', 'rk4'), ('tactical', 'rk4'),
                                            ('sapegin_2016_damped', 'exact')])
def test_compiled_rocking_is_the_plain_one(preset, method, monkeypatch):
    """The compiled oscillation equals the plain one, bit for bit."""
    pytest.importorskip('numba')
    found = []
    for samples in (10**9, 0):
        monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', samples)
        pair = GyroPair(PRESETS[preset], 1e-3, method=method)
        found.append(rocking_amplitudes(pair, 10.0, 9.0, 1e-3, method))
    assert found[0] == found[1]


def test_unstable_speeds_are_refused():
    """Unstable speeds are refused in a table and in the search."""
    with pytest.raises(ValueError, match='RK4 step is 0.75 ms, at which the gyro is unstable'):
        study_curve(read('speed', 'curve_values:=[340.0]'))
    with pytest.raises(ValueError, match='speed_hz is 230 Hz, at which RK4 with a step of 2 ms'):
        stability_limits(PRESETS['sapegin_2016'], 2e-3)


def test_progress_is_told_and_the_amplitude_scales():
    """progress is called after each cell; a quarter of the motion gives a quarter amplitude."""
    told = []
    few = ('values:=[400.0]', 'paper_deg:=[]', 'step_ms:=1.0')
    (whole,) = study_table(read('frequency', *few), lambda: told.append(1))
    (quarter,) = study_table(read('frequency', *few, 'amplitude_deg:=2.5'), lambda: told.append(1))
    assert len(told) == 2 and whole.paper_deg is None
    assert whole.poisson_deg == pytest.approx(4.0 * quarter.poisson_deg, rel=1e-6)


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.stem)
def test_every_shipped_study_runs(path, tmp_path, capsys):
    """
    Each shipped file, shortened to one cell with a coarse step, saves its figure and no other.
    """
    settings = read(path.stem.removeprefix('dtg_study_'))
    assert len(settings.paper_deg) == len(settings.values)
    assert main(['dtg-study', '--params-file', path.stem, '-o', str(tmp_path),
                 '-p', 'step_ms:=1.0', '-p', 'values:=[230.0]', '-p', 'paper_deg:=[10.0]',
                 '-p', 'curve_values:=[220.0, 230.0]', '-p', 'base_rate_rad_s:=300.0']) == 0
    assert {p.name for p in tmp_path.iterdir()} == {
        '.ins_sim', 'report.html', f'{path.stem}.png'}
    assert '1 ms' in capsys.readouterr().out


@pytest.mark.parametrize('assignment, sentence', [
    ('sweep:=speed', "sweep is 'speed'; expected one of base_rate, rotor_speed"),
    ('valuess:=[1.0]', "unknown parameter 'valuess'; the nearest known one is 'values'"),
    ('values:=[1.0]', 'paper_deg has 5 entries; expected none or 1, one for each of values'),
    ('values:=[]', 'paper_deg has 5 entries; expected none or 0'),
    ('values:=[-1.0, 1.0, 2.0, 4.0, 8.0]', 'values is -1; expected 0.001 to 10000'),
    ('paper_limits_hz:=[130.0]', 'paper_limits_hz has 1 entries; expected none or 2'),
    ('preset:=sapegin', 'preset is \'sapegin\'; expected one of sapegin_2016, '
     'sapegin_2016_damped, tactical'),
    ('step_ms:=0.0', 'step_ms is 0 ms; expected 0.001 to 100 ms'),
])
def test_bad_settings_are_one_sentence(assignment, sentence, tmp_path, capsys):
    """Invalid settings give exit code 2 with one message, and nothing is written."""
    out = tmp_path / 'study'
    assert main(['dtg-study', '--params-file', 'dtg_study_frequency', '-p', assignment, '-o',
                 str(out)]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1 and not out.exists()


def test_files_of_another_kind_are_refused(tmp_path, capsys):
    """
    A file of a run is refused as a study and vice versa, and so are two files of one name.

    They would share a figure.
    """
    assert main(['dtg-study', '--params-file', 'other_simulator']) == 2
    assert "unknown section '/**/truth_adapter'; the nearest known one" in capsys.readouterr().err
    assert main(['dtg-study', '--params-file', 'imu_tactical_fog']) == 2
    assert "unknown parameter 'gyro.errors.turn_on_bias_sigma_deg_h'" in capsys.readouterr().err
    assert main(['predict', '--params-file', 'dtg_study_speed']) == 2
    assert "unknown section '/**/dtg_study'" in capsys.readouterr().err
    copy = tmp_path / 'dtg_study_speed.yaml'
    copy.write_text((CONFIG / copy.name).read_text())
    assert main(['dtg-study', '--params-file', str(copy), '--params-file', 'dtg_study_speed']) == 2
    assert 'two parameter files are named dtg_study_speed' in capsys.readouterr().err


def test_vertices_by_parabola():
    """The maximum between two samples is found to the fourth order of their spacing."""
    for phase in np.linspace(0.0, 1.0, 7):
        t = 0.02 * (np.arange(320) + phase)
        assert half_peak_to_peak((3.0 * np.sin(t)).tolist()) == pytest.approx(3.0, abs=1e-7)
