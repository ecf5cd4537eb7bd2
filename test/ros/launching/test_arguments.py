"""The arguments of the launch files: names, values, presets and files, without ROS."""

import pytest
import yaml

from ins_sim import resources
from ins_sim.launching import arguments
from support.places import ROOT

CONFIG = {path.stem: yaml.safe_load(path.read_text(encoding='utf-8'))
          for path in (ROOT / 'config').glob('*.yaml') if '_study_' not in path.stem}


def shared(name):
    """Return the values of a shipped file for all nodes."""
    return CONFIG[name].get('/**', {'ros__parameters': {}})['ros__parameters']


def test_motions_hold_a_motion_and_nothing_of_instruments():
    """Every shipped motion is in the table; none contains delays or errors."""
    moving = {name for name in CONFIG if 'motion' in shared(name)} - {'default'}
    # This file uses tuned gyros, as its name states.
    assert set(arguments.MOTIONS) == moving - {'dtg_motion_2'}
    for name in arguments.MOTIONS:
        assert not {'gyro', 'accelerometer', 'sampling', 'output'} & set(shared(name))
        assert set(CONFIG[name]) <= {'/**', '/**/aided_navigator'}


def test_instruments_are_those_shipped():
    """The instruments are the files imu_*, each with one section, which a later /** overrides."""
    assert set(arguments.INSTRUMENTS) == {name for name in CONFIG if name.startswith('imu_')}
    assert all(set(CONFIG[name]) == {'/**'} for name in arguments.INSTRUMENTS)


@pytest.mark.parametrize('known, name, near', [
    (arguments.SIMULATION, 'moton', 'motion'), (arguments.SIMULATION, 'rate', 'rate_hz'),
    (arguments.SIMULATION, 'param_file', 'params_file'), (arguments.REPLAY, 'sorce', 'source')])
def test_a_misspelt_argument_names_the_nearest(known, name, near):
    """A misspelt argument gives one message with the nearest name."""
    with pytest.raises(ValueError) as refused:
        arguments.check_names([known[0].name, 'launch-prefix', name], known)
    assert str(refused.value) == (f"unknown launch argument '{name}'; the nearest known one is "
                                  f"'{near}'")


@pytest.mark.parametrize('name, text, says', [
    ('aided', 'yes', "aided is 'yes'; expected true or false"),
    ('rate_hz', 'fast', "rate_hz is 'fast'; expected a number"),
    ('tf', 'in', "tf is 'in'; expected one of none, truth, ins, aided (nearest: ins)")])
def test_bad_values(name, text, says):
    """An invalid value gives a message with argument, value and expectation."""
    texts = {one.name: one.default for one in arguments.SIMULATION}
    with pytest.raises(ValueError) as refused:
        arguments.read_values({**texts, name: text}, arguments.SIMULATION)
    assert str(refused.value) == says


def test_values():
    """Arguments that are not given are '' or None; True may be capitalised, as ROS writes it."""
    texts = {one.name: one.default for one in arguments.SIMULATION}
    value = arguments.read_values({**texts, 'use_sim_time': 'True', 'rate_hz': '200'},
                                  arguments.SIMULATION)
    assert value['use_sim_time'] is True and value['rate_hz'] == 200.0
    assert value['lock_step'] is None and value['motion'] == '' and value['aided'] is False


@pytest.mark.parametrize('text, names', [
    ('', []), ('motion_2', ['motion_2']), ('motion_2,imu_tactical_fog', None),
    ('motion_2 imu_tactical_fog', None), (' motion_2 ,  imu_tactical_fog', None)])
def test_several_parameter_files(text, names):
    """Parameter files are separated by commas or spaces and keep their order."""
    names = ['motion_2', 'imu_tactical_fog'] if names is None else names
    assert arguments.parameter_files(text) == [str(resources.config(name)) for name in names]


def test_a_file_with_a_space_in_its_name(tmp_path):
    """A text that is the name of an existing file is one path; a missing file is named."""
    path = tmp_path / 'my own, really.yaml'
    path.write_text('')
    assert arguments.parameter_files(str(path)) == [str(path)]
    with pytest.raises(FileNotFoundError, match='the parameter file .*mine.yaml does not exist'):
        arguments.parameter_files(f'motion_2 {tmp_path}/mine.yaml')


def test_presets(tmp_path, monkeypatch):
    """
    A preset is found by name or path; other files and misspelt names are refused.

    The message has the nearest name.
    """
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'own.yaml').write_text('')
    assert arguments.preset_file('motion', 'racetrack', arguments.MOTIONS) == str(
        resources.config('racetrack'))
    assert arguments.preset_file('motion', 'own.yaml', arguments.MOTIONS) == 'own.yaml'
    for name, near in (('racetrak', 'racetrack'), ('imu_tactical_mems', 'motion_2')):
        with pytest.raises(ValueError) as refused:
            arguments.preset_file('motion', name, arguments.MOTIONS)
        assert str(refused.value).startswith(f"motion is '{name}'; expected a path or one of ")
        assert str(refused.value).endswith(f'(nearest: {near})')
