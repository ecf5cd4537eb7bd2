"""The manifest of a run names its noise and the machines that give the same bits."""

from ins_sim import parameter_files
from ins_sim.api.inputs import files
from ins_sim.cli.main import main
from ins_sim.core.numerics.noise import NOISE
from ins_sim.report import manifest
import pytest
import yaml


@pytest.fixture(autouse=True)
def promised_machine(monkeypatch):
    """Pretend to be a machine for which equal bits are guaranteed."""
    monkeypatch.setattr(manifest.platform, 'machine', lambda: 'x86_64')


def told(*texts, names=(), aided=False, own_motion=False):
    """Return the manifest of settings as a mapping."""
    read = parameter_files.read_aided if aided else parameter_files.read
    settings = read(files(names), texts)
    return yaml.safe_load(manifest.manifest(
        settings.simulation if aided else settings, settings if aided else None, own_motion))


def test_a_written_run_has_it(tmp_path):
    """The manifest names the noise generator with its version, and every x86-64 machine."""
    out = tmp_path / 'run'
    assert main(['simulate', '-p', 'duration_s:=1.0', '-o', str(out)]) == 0
    text = (out / 'manifest.yaml').read_text(encoding='utf-8')
    assert text == f'noise: {NOISE}\nbits: every x86-64 machine\n'.replace(
        NOISE, yaml.safe_dump(NOISE, width=200).splitlines()[0])
    assert 'philox4x64' in NOISE and 'box-muller, version 2' in NOISE


def test_what_is_the_same_on_one_machine_only(tmp_path, monkeypatch):
    """Recorded motions, meter signals, a user's motion, other processors limit the promise."""
    recording = ('motion.kind:=recording', 'motion.recording.path:=somewhere.csv')
    flight = {'names': ['gnss_outage_flight', 'grade_mid'], 'aided': True}
    assert told(**flight) == {'noise': NOISE, 'bits': 'every x86-64 machine'}
    for found, reason in ((told(*recording), manifest.RECORDING),
                          (told('velocity_meter:mode:=signal', **flight), manifest.SIGNAL),
                          (told(own_motion=True), manifest.OBJECT)):
        assert found == {'noise': NOISE, 'bits': 'this machine', 'bits_reason': reason}
    monkeypatch.setattr(manifest.platform, 'machine', lambda: 'aarch64')
    assert told()['bits_reason'] == 'it was made on aarch64'
