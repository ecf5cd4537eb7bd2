"""An invalid run.npz is refused with one message, without allocating the memory it claims."""

import io
import zipfile

import numpy as np
import pytest

from ins_sim.cli.main import main
from ins_sim.report import storage

GOOD = {'imu_t_ns': np.arange(50), 'imu_omega': np.ones((50, 3)), 'imu_f': np.ones((50, 3))}


def saved(folder, save=np.savez, **changed):
    """Write the arrays of a run, with some of them changed."""
    save(folder / 'run.npz', **{k: v for k, v in {**GOOD, **changed}.items() if v is not None})
    return folder


def test_the_arrays_of_a_run_come_back(tmp_path):
    """Arrays with and without the parity, compressed or not, are read back."""
    for save in (np.savez, np.savez_compressed):
        imu = storage.read_imu(saved(tmp_path, save))
        assert imu.parity is None and np.array_equal(imu.omega, GOOD['imu_omega'])
        imu = storage.read_imu(saved(tmp_path, save, imu_parity=np.zeros(50)))
        assert len(imu.parity) == 50


@pytest.mark.parametrize('changed, sentence', [
    (dict(imu_f=None), "There is no item named 'imu_f.npy'"),
    (dict(imu_f=np.ones((50, 2))), 'imu_f has the type float64 and the shape (50, 2)'),
    (dict(imu_f=np.ones((49, 3))), 'imu_f has the type float64 and the shape (49, 3)'),
    (dict(imu_t_ns=np.array(3)), 'imu_t_ns has the type int64 and the shape ()'),
    (dict(imu_t_ns=np.arange(50.0)), 'imu_t_ns has the type float64'),
    (dict(imu_omega=np.ones((50, 3), dtype=complex)), 'imu_omega has the type complex128'),
    (dict(imu_omega=np.array([['x'] * 3] * 50)), 'imu_omega has the type <U1'),
    (dict(imu_omega=np.array([{}], dtype=object)),
     'imu_omega.npy states a shape of (1,) of object')])
def test_other_arrays_are_named(changed, sentence, tmp_path, capsys):
    """allan names the invalid array and what is wrong with it."""
    saved(tmp_path, **changed)
    (tmp_path / 'parameters.yaml').write_text('/**: {ros__parameters: {rate_hz: 100.0}}\n')
    assert main(['allan', str(tmp_path), '-o', str(tmp_path / 'out')]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1


def test_sizes_that_the_file_does_not_have_are_not_allocated(tmp_path):
    """A header of 2^40 rows, and 100 MB of zeros in 100 kB, are refused without allocation."""
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {'descr': '<i8', 'fortran_order': False,
                                                  'shape': (2 ** 40,)})
    for content, sentence in ((header.getvalue(), 'more than the file'),
                              (b'\x93NUMPY' + bytes(100_000_000), 'unpacks to'),
                              (b'', 'EOF'), (b'\x93NUMPY\x09\x00', 'has the format')):
        saved(tmp_path)
        with zipfile.ZipFile(tmp_path / 'run.npz', 'w', zipfile.ZIP_DEFLATED) as archive:
            archive.writestr('imu_t_ns.npy', content)
        with pytest.raises(ValueError, match=sentence):
            storage.read_imu(tmp_path)
    (tmp_path / 'run.npz').write_bytes(b'no archive')
    with pytest.raises(ValueError, match='File is not a zip file'):
        storage.read_imu(tmp_path)
