"""Warnings: every verb and node warns about a recorded motion; no warning comes from NumPy."""

import warnings

import numpy as np
import pytest
from support.recorded_flights import write

from ins_sim import parameter_files
from ins_sim.cli.main import main
from ins_sim.core.numerics.sentences import tell_warnings
from ins_sim.io.motion import read_motion

ROUNDED = 'differentiated twice at 10 Hz put'
SCATTER = 'second differences of its positions scatter'


@pytest.fixture
def rounded(tmp_path):
    """Return the arguments for a recording with positions rounded to 1e-6 degrees, 10 Hz."""
    t = np.arange(200) * 0.1
    path = write(tmp_path / 'rounded.csv', t, lat=55.0 + 1e-5 * t ** 1.3, lon=37.0 + 2e-5 * t,
                 digits='.6f')
    return ['motion.kind:=recording', f'motion.recording.path:={path}', 'duration_s:=5.0',
            'rate_hz:=10.0']


@pytest.mark.parametrize('verb', ['simulate', 'predict', 'convert'])
def test_every_verb_says_what_is_wrong_with_a_recording(verb, rounded, tmp_path, capsys):
    """Each verb that uses the recording prints one warning."""
    words = [word for a in rounded for word in ('-p', a)]
    more = {'simulate': ['-o', str(tmp_path / 'run')], 'predict': [],
            'convert': [str(tmp_path / 'rounded.csv'), str(tmp_path / 'bag')]}[verb]
    assert main([verb, *more, *words]) == 0
    said = capsys.readouterr()
    text = ' '.join((said.out + said.err).split())
    assert text.count(ROUNDED) == 1 and text.count(SCATTER) == 1


def test_a_node_that_flies_a_recording_says_it(rounded):
    """The generator logs the warning, as does an IMU with source motion that reads the file."""
    from ins_sim.ros.lock_step.truth_source import TruthSource
    chosen = parameter_files.read([], rounded)
    for fly in (lambda: TruthSource(chosen.motion_generator),
                lambda: read_motion(chosen.imu_sensor)):
        with pytest.warns(UserWarning, match=ROUNDED):
            fly()


def test_what_numpy_says_never_reaches_a_user(capsys, monkeypatch):
    """Warnings of NumPy such as "invalid value encountered" are not printed; our messages are."""
    told = []
    with warnings.catch_warnings():
        warnings.simplefilter('always')
        monkeypatch.setattr(warnings, 'showwarning', warnings.showwarning)
        tell_warnings(told.append)
        np.array([0.0]) / np.array([0.0])
        np.array([np.inf]) - np.inf
        np.array([1e300]) * 1e300
        warnings.warn('of a library', DeprecationWarning)
        warnings.warn('a sentence')
    assert told == ['a sentence']
    assert capsys.readouterr() == ('', '')
