"""The public functions refuse what the command line refuses, with the same messages."""

import ins_sim
from ins_sim.cli.main import main
from ins_sim.core.timeseries import histories
import numpy as np
import pytest
from support.readings.imu_records import record_at_rest

SHORT = {'duration_s': 2.0}
AIDED = {'duration_s': 3.0, 'window.cycles': 100}


@pytest.mark.parametrize('word, value', [
    ('gyro.delay_us.w', 1.0), ('duration_s', -1.0), ('duration_s', float('nan')),
    ('motion.kind', 'rockin'), ('strapdown:output_every', 1.5), ('gyro.delay_us.y', 'late'),
    ('gyro.errors.bias_deg_h', [1.0, 2.0]), ('rate_hz', True)])
def test_values_are_refused_in_the_words_of_the_command_line(word, value, tmp_path, capsys):
    """An invalid value gives the message of option -p of the command line."""
    with pytest.raises(ValueError) as refused:
        ins_sim.read_settings('motion_2', {word: value})
    text = {True: 'true', 'nan': '.nan'}.get(value if value is True else str(value), str(value))
    assert main(['simulate', '--params-file', 'motion_2', '-p', f'{word}:={text}', '-o',
                 str(tmp_path / 'run')]) != 0
    said = ' '.join(capsys.readouterr().err.split())
    sentence = str(refused.value).replace('values: ', '-p: ', 1)
    assert sentence in said


@pytest.mark.parametrize('values, said', [
    (['duration_s:=1'], 'values are'), ({1: 2.0}, 'values are')])
def test_values_that_are_no_mapping(values, said):
    """Values that are not a mapping are refused; the message states what is expected."""
    with pytest.raises(ValueError, match=said):
        ins_sim.read_settings('motion_2', values)


def test_an_unknown_file_names_those_there_are():
    """An unknown parameter file is refused with the names of the existing ones."""
    with pytest.raises(FileNotFoundError, match="no config named 'motion_3'; expected one of"):
        ins_sim.read_settings('motion_3')


@pytest.mark.parametrize('names', [None, 3, b'motion_2', {'duration_s': 1.0}, [None]])
def test_names_that_are_no_paths(names):
    """Parameter files given as something other than a path are refused with the expectation."""
    with pytest.raises(ValueError, match='^names is .*expected'):
        ins_sim.read_settings(names)


def test_paths_and_presets_of_a_wrong_type(tmp_path, monkeypatch):
    """Paths and presets of a wrong type raise ValueError, not TypeError."""
    monkeypatch.chdir(tmp_path)
    run = ins_sim.simulate(ins_sim.read_settings('motion_2', SHORT))
    for function, argument in ((ins_sim.open_bag, 'path'), (run.save, 'folder'),
                               (ins_sim.presets, 'name')):
        for value in (3, ['tactical_fog']):
            with pytest.raises(ValueError, match=f'^{argument} is '):
                function(value)


@pytest.mark.parametrize('function', [ins_sim.navigate, ins_sim.open_motion, ins_sim.open_bag])
@pytest.mark.parametrize('name', ['nowhere.csv', 'nowhere', 'nowhere.csv.gz'])
def test_what_does_not_exist_is_not_found(function, name):
    """A missing file raises FileNotFoundError."""
    with pytest.raises(FileNotFoundError, match=f'^{name} does not exist; expected'):
        function(name)


def test_settings_of_the_wrong_function_are_refused():
    """simulate and predict refuse aided settings, simulate_aided those of other functions."""
    aided = ins_sim.read_settings(['route_flight', 'grade_mid'], AIDED, aided=True)
    for function in (ins_sim.simulate, ins_sim.predict):
        with pytest.raises(ValueError, match=r'expected SimulationSettings of read_settings'):
            function(aided)
    with pytest.raises(ValueError, match=r'expected AidedSimulationSettings of .*aided=True'):
        ins_sim.simulate_aided(ins_sim.read_settings('motion_2', SHORT))


BAD = [
    ({'t_ns': 0.01 * np.arange(100)}, 't_ns is an array of float64'),
    ({'t_ns': np.zeros((100, 1), dtype=int)}, r'shape \(100, 1\)'),
    ({'t_ns': np.r_[0:50, 49:99]}, r't_ns\[50\] is 49 after 49; expected increasing'),
    ({'t_ns': 10 * np.arange(100)}, 't_ns has a median step of 10 ns; expected at least 50000 ns'),
    ({'omega': np.zeros((99, 3))}, r'omega .*expected .* of shape \(100, 3\)'),
    ({'f': np.zeros((3, 100))}, r'f .*expected .* of shape \(100, 3\)'),
    ({'omega': np.full((100, 3), np.nan)}, r'omega\[0\] is \[nan, nan, nan\]; expected finite'),
    ({'f': [[0.0, 0.0, np.inf]] * 100}, r'f\[0\] is \[0.0, 0.0, inf\]'),
    ({'f': [[0.0, 0.0]] * 99 + [[0.0]]}, 'f has rows of different lengths'),
    ({'omega': [['a', 'b', 'c']] * 100}, 'omega is an array of <U1'),
    ({'f': None}, 'f is an array of object')]


@pytest.mark.parametrize('changed, said', BAD)
def test_bad_arrays_are_refused_in_one_sentence(changed, said):
    """Invalid arrays give a ValueError with our message, not an error of NumPy."""
    with pytest.raises(ValueError, match=said) as refused:
        record_at_rest(100, **changed)
    assert '\n' not in str(refused.value)


@pytest.mark.parametrize('function, given, said', [
    (ins_sim.navigate, np.zeros((3, 3)), 'source is ndarray; expected the path'),
    (ins_sim.open_motion, 3, 'source is int; expected the path'),
    (ins_sim.navigate, 'nowhere.bag', 'nowhere.bag does not exist'),
    (ins_sim.open_motion, 'nowhere.csv', 'nowhere.csv'),
    (ins_sim.open_bag, 'nowhere.mcap', 'nowhere.mcap')])
def test_bad_sources_are_refused(function, given, said):
    """A source that cannot be read is named in the message."""
    with pytest.raises((ValueError, OSError), match=said):
        function(given)


def test_an_empty_record_is_refused():
    """A record without samples is refused."""
    with pytest.raises(ValueError, match='the IMU has 0 samples'):
        ins_sim.navigate(record_at_rest(0, omega=np.zeros((0, 3)), f=np.zeros((0, 3))))


def test_a_standstill_that_fills_the_record_names_the_alignment():
    """If the alignment uses the whole record, the message names the settings of the alignment."""
    place = {'initial.position': 'given', 'initial.latitude_deg': 45.0,
             'initial.heading': 'given'}
    with pytest.raises(ValueError, match=r'expected .*alignment \(alignment.longest_s is 60 s\)'):
        ins_sim.navigate(record_at_rest(3000), place)
    shorter = {**place, 'alignment.longest_s': 10.0}
    assert ins_sim.navigate(record_at_rest(3000), shorter).segments


def test_an_own_motion_is_checked():
    """A user's motion that returns invalid arrays is refused before the run."""
    settings = ins_sim.read_settings('motion_2', SHORT)

    class Broken(ins_sim.Motion):
        """A motion with one array replaced."""

        def __init__(self, field, value):
            self._field, self._value = field, value

        def at(self, t_ns):
            """Return the truth of motion 2 with one array replaced."""
            arrays = ins_sim.open_motion(settings).at(t_ns).arrays()
            return histories.Truth(**{**arrays, self._field: self._value})

    with pytest.raises(ValueError, match=r'gives v_n of shape \(1, 2\) for one instant'):
        ins_sim.simulate(settings, motion=Broken('v_n', np.zeros((1, 2))))
    with pytest.raises(ValueError, match='gives lat nan at 0 s; expected finite'):
        ins_sim.simulate(settings, motion=Broken('lat', np.array([np.nan])))
    with pytest.raises(ValueError, match='motion is str; expected an object of a subclass of'):
        ins_sim.simulate(settings, motion='cruise')
