"""A wrong entry in the table of motions or filters is reported in one message."""

import ins_sim
from ins_sim.cli.main import main
from ins_sim.settings.aided_navigator import FilterEntry, FILTERS
from ins_sim.settings.motion import MOTIONS
import pytest

WRONG = [
    ('nowhere_made:mine', 'there is no module nowhere_made; expected its file in a folder of'),
    ('ins_sim.resources:mine', 'has no mine; expected module:name'),
    ('math', "is at 'math' in its table; expected module:name"),
    (':mine', "is at ':mine' in its table; expected module:name")]


@pytest.mark.parametrize('location, said', WRONG)
def test_a_motion_that_is_not_there(location, said, monkeypatch, capsys, tmp_path):
    """A motion whose location is wrong is reported from Python and on the command line."""
    monkeypatch.setitem(MOTIONS, 'mine', location)
    settings = ins_sim.read_settings('motion_2', {'motion.kind': 'mine', 'duration_s': 1.0})
    with pytest.raises(ValueError, match=said) as refused:
        ins_sim.simulate(settings)
    assert '\n' not in str(refused.value)
    assert main(['simulate', '--params-file', 'motion_2', '-p', 'motion.kind:=mine',
                 '-o', str(tmp_path / 'run')]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize('location, said', WRONG)
def test_a_filter_that_is_not_there(location, said, monkeypatch):
    """A filter whose location is wrong is reported by the message used for motions."""
    monkeypatch.setitem(FILTERS, 'mine', FilterEntry(location))
    settings = ins_sim.read_settings(['route_flight', 'grade_mid'],
                                     {'duration_s': 1.0, 'filter': 'mine'}, aided=True)
    with pytest.raises(ValueError, match=f'filter mine .*{said}'):
        ins_sim.simulate_aided(settings)


def test_a_maker_that_returns_no_motion(monkeypatch, tmp_path):
    """A function of the table of motions that returns no motion is reported."""
    (tmp_path / 'forgetful.py').write_text('def make(motion, datum, earth):\n    pass\n')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setitem(MOTIONS, 'mine', 'forgetful:make')
    settings = ins_sim.read_settings('motion_2', {'motion.kind': 'mine', 'duration_s': 1.0})
    with pytest.raises(ValueError, match='returns NoneType; expected an object of a subclass'):
        ins_sim.simulate(settings)


def test_an_error_inside_a_module_is_its_own(monkeypatch, tmp_path):
    """A library that the user's module lacks is reported as such, not as an error of the table."""
    (tmp_path / 'needy.py').write_text('import a_library_that_is_missing\n')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setitem(MOTIONS, 'mine', 'needy:make')
    settings = ins_sim.read_settings('motion_2', {'motion.kind': 'mine', 'duration_s': 1.0})
    with pytest.raises(ModuleNotFoundError, match='a_library_that_is_missing'):
        ins_sim.simulate(settings)
