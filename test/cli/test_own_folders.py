"""Folders of results are complete or absent, have one writer at a time, and keep foreign files."""

import fcntl
import os
import signal
import subprocess
import sys
import threading

from ins_sim.bags.bag_writer import BagWriter
from ins_sim.cli.main import main
from ins_sim.own_folders.marker import MARKER
from ins_sim.own_folders.own_folder import OwnFolder, whole_folder
import numpy as np
import pytest
from support.places import ROOT

RUN = ['simulate', '-p', 'duration_s:=1.0']
# Files of a folder made by an older version or by another program.
PRECIOUS = {'summary.json': '[]', 'main.c': 'int main;', 'bag_0.mcap': 'mine',
            'metadata.yaml': 'rosbag2_bagfile_information: {}', 'comparison.json': '[]',
            'allan.json': '[]', 'parameters.yaml': '', 'nav.npz': ''}
KILLED = """
import os
from pathlib import Path
import sys
from ins_sim.own_folders.own_folder import OwnFolder
folder = OwnFolder(sys.argv[1])
(folder.work / 'half').write_text('x')
(folder.work / 'more').mkdir()
os.kill(os.getpid(), 9)
"""


def contents(folder):
    """Return {name: bytes} of the files of a folder."""
    return {p.name: p.read_bytes() for p in folder.iterdir() if p.is_file()}


def imu_csv(path):
    """Write the readings of an IMU at rest."""
    rows = np.column_stack([np.arange(200) * 0.01, np.zeros((200, 5)), np.full(200, 9.8)])
    np.savetxt(path, rows, delimiter=',', comments='', header='t_s,gx_rps,gy_rps,gz_rps,ax_mps2,'
               'ay_mps2,az_mps2')
    return path


@pytest.mark.parametrize('words', [
    [*RUN, '-o', 'OUT', '--force'], [*RUN, '-o', 'run', '--bag', 'OUT', '--force'],
    ['allan', '--duration', '30', '-o', 'OUT', '--force', '--params-file', 'imu_tactical_fog'],
    ['compare-filters', '--runs', '1', '-p', 'duration_s:=10.0', '-o', 'OUT', '--force'],
    ['loop-study', '-o', 'OUT', '--force'],
    ['navigate', 'imu.csv', '-o', 'OUT', '--force'], ['dtg-study', '-o', 'OUT'],
    ['delay-study', '-o', 'OUT', '--force'],
    ['convert', 'imu.csv', 'OUT', '--force']])
def test_a_folder_of_others_stays(words, tmp_path, monkeypatch, capsys):
    """A folder with files of any other name is kept with exit code 2."""
    monkeypatch.chdir(tmp_path)
    imu_csv(tmp_path / 'imu.csv')
    (tmp_path / 'OUT').mkdir()
    for name, text in PRECIOUS.items():
        (tmp_path / 'OUT' / name).write_text(text)
    before = contents(tmp_path / 'OUT')
    assert main(words) == 2
    said = capsys.readouterr().err
    assert f'OUT: it has no marker {MARKER} of ins_sim; --force replaces only what the same ' \
        'command wrote' in said and said.count('\n') == 1
    assert contents(tmp_path / 'OUT') == before


@pytest.mark.parametrize('inner', [False, True])
def test_a_run_with_a_file_of_somebody_stays(inner, tmp_path, capsys):
    """A run with a foreign file next to its files, or in a subfolder, is kept."""
    out = tmp_path / 'run'
    assert main([*RUN, '-o', str(out)]) == 0
    mine = out / 'src' / 'main.c' if inner else out / 'main.c'
    mine.parent.mkdir(exist_ok=True)
    mine.write_text('int main;')
    before = contents(out)
    assert main([*RUN, '-o', str(out), '--force']) == 2
    assert f'it holds {"src" if inner else "main.c"}, which ins_sim did not write' in \
        capsys.readouterr().err
    assert contents(out) == before and mine.read_text() == 'int main;'
    mine.unlink()
    if inner:
        mine.parent.rmdir()
    assert main([*RUN, '-o', str(out), '--force']) == 0
    assert [p.name for p in tmp_path.iterdir()] == ['run']


def test_what_comes_while_it_is_computed_stays(tmp_path):
    """A file put into the old folder while the new run is computed keeps the folder."""
    out = tmp_path / 'out'
    with whole_folder(out) as work:
        (work / 'a').write_text('old')
    with pytest.raises(ValueError, match='it holds notes, which ins_sim did not write'):
        with whole_folder(out, replace=True) as work:
            (work / 'a').write_text('new')
            (out / 'notes').write_text('mine')
    assert contents(out) == {MARKER: (out / MARKER).read_bytes(), 'a': b'old', 'notes': b'mine'}
    assert [p.name for p in tmp_path.iterdir()] == ['out']


def test_the_current_folder_and_the_root_are_refused(tmp_path, monkeypatch, capsys):
    """``cd run && ins_sim simulate -o . --force`` loses neither the old run nor the new one."""
    out = tmp_path / 'run'
    assert main([*RUN, '-o', str(out)]) == 0
    before = contents(out)
    (out / 'inner').mkdir()
    for here, name in ((out, '.'), (out / 'inner', '..')):
        monkeypatch.chdir(here)
        assert main([*RUN, '-o', name, '--force']) == 2
        said = capsys.readouterr().err
        assert f'simulate: {name} holds the current folder, ' in said
        assert 'run it from outside this folder' in said and contents(out) == before
    for words in ([*RUN, '-o', '/'], [*RUN, '-o', '/', '--force'], ['dtg-study', '-o', '/'],
                  [*RUN, '-o', str(tmp_path / 'new'), '--bag', '/']):
        assert main(words) == 2
        assert '/ is the root of all folders' in (said := capsys.readouterr().err) or \
            '/ exists; expected a new path for the bag' in said


def test_the_second_of_two_at_once_is_refused(tmp_path, capsys):
    """A second process with the same folder is refused at its start; the first one finishes."""
    out = tmp_path / 'run'
    for force in ([], ['--force']):
        with whole_folder(out, bool(force), 'summary.json') as work:
            assert main([*RUN, '-o', str(out), *force]) == 2
            assert f'{out} is being written by another process' in capsys.readouterr().err
            (work / 'summary.json').write_text('first')
        assert (out / 'summary.json').read_text() == 'first'
    bag = BagWriter(tmp_path / 'bag')
    with pytest.raises(ValueError, match='is being written by another process'):
        OwnFolder(tmp_path / 'bag', replace=True)
    bag.close()
    assert sorted(p.name for p in tmp_path.iterdir()) == ['bag', 'run']


def test_what_a_killed_process_left_is_in_nobodys_way(tmp_path):
    """A temporary folder of a killed process is removed by the next run; a foreign one is not."""
    out = tmp_path / 'out'
    subprocess.run([sys.executable, '-c', KILLED, out],
                   env={**os.environ, 'PYTHONPATH': str(ROOT)})
    assert (tmp_path / '.out.part' / 'half').exists()
    with whole_folder(out) as work:
        assert [p.name for p in work.iterdir()] == [MARKER]
    (tmp_path / '.out.part').mkdir()
    (tmp_path / '.out.part' / 'mine').write_text('x')
    with pytest.raises(ValueError, match='is in the way and was not written by ins_sim'):
        with whole_folder(out, replace=True):
            pass
    assert (tmp_path / '.out.part' / 'mine').exists() and out.exists()


def test_a_link_leads_to_the_folder_that_is_replaced(tmp_path):
    """The link stays, and the folder it points to is replaced."""
    for _ in range(2):
        with whole_folder(tmp_path / 'link' if (tmp_path / 'link').exists() else tmp_path / 'out',
                          replace=True) as work:
            (work / 'file').write_text('x')
        if not (tmp_path / 'link').exists():
            (tmp_path / 'link').symlink_to('out')
    assert (tmp_path / 'link').is_symlink() and not (tmp_path / 'out').is_symlink()
    assert (tmp_path / 'out' / 'file').exists()


def test_a_marker_leads_nowhere_else(tmp_path):
    """A marker file that names files outside its folder is invalid."""
    with whole_folder(tmp_path / 'out') as work:
        (work / 'file').write_text('x')
    (tmp_path / 'victim').write_text('x')
    with open(tmp_path / 'out' / MARKER, 'a') as marker:
        marker.write('"../victim"\n')
    with pytest.raises(ValueError, match='has no marker'):
        with whole_folder(tmp_path / 'out', replace=True):
            pass
    assert (tmp_path / 'victim').exists()


def test_parents_that_were_made_go_again(tmp_path):
    """A run that is refused or fails removes the parent folders it made."""
    with pytest.raises(RuntimeError):
        with whole_folder(tmp_path / 'a' / 'b' / 'c'):
            raise RuntimeError
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize('writer', [
    lambda folder: whole_folder(folder).__enter__(), OwnFolder, BagWriter])
def test_an_interrupt_that_another_thread_takes_leaves_nothing(writer, tmp_path, monkeypatch):
    """
    An interrupt received by another thread waits until the folder is locked, and leaves nothing.

    Threads of NumPy's libraries may receive it.
    """
    end = threading.Event()
    other = threading.Thread(target=end.wait)
    other.start()
    lock, (came, wakeup) = fcntl.flock, os.pipe()
    os.set_blocking(wakeup, False)

    def interrupted(*words):
        signal.pthread_kill(other.ident, signal.SIGINT)
        # The other thread has received it: Python runs the handler next.
        os.read(came, 1)
        return lock(*words)

    monkeypatch.setattr(fcntl, 'flock', interrupted)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    before_fd = signal.set_wakeup_fd(wakeup)
    try:
        with pytest.raises(KeyboardInterrupt):
            writer(tmp_path / 'run')
        assert list(tmp_path.iterdir()) == []
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.set_wakeup_fd(before_fd)
        signal.signal(signal.SIGINT, before)
        os.close(came)
        os.close(wakeup)
        end.set()
        other.join()
