"""Compressed arrays: the same bits come back, and what gains nothing is not compressed."""

from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile

from ins_sim.report import storage
from ins_sim.report.files.packed_arrays import write_arrays
import numpy as np
import pytest

COUNT = 20000
ARRAYS = {
    't_ns': np.arange(COUNT) * 10_000_000, 'constant': np.full((COUNT, 3), 6000.0),
    'noise': np.random.default_rng(1).normal(size=(COUNT, 3)),
    'odd': np.array([np.nan, np.inf, -np.inf, -0.0, 5e-324]), 'none': np.zeros((0, 3)),
    'flags': np.array([True, False]), 'texts': np.array(['valid', 'outage'])}


def test_arrays_come_back_to_the_bit(tmp_path):
    """By numpy.load: types, shapes and bytes, of arrays that do not lie row after row too."""
    arrays = {**ARRAYS, 'across': np.asfortranarray(ARRAYS['noise']),
              'every 7th': ARRAYS['noise'][::7]}
    write_arrays(tmp_path / 'run.npz', arrays)
    with np.load(tmp_path / 'run.npz') as found:
        assert list(found) == list(arrays)
        for name, values in arrays.items():
            assert found[name].dtype == values.dtype and found[name].shape == values.shape
            assert found[name].tobytes() == values.tobytes()


def test_only_what_shrinks_is_compressed(tmp_path):
    """Stamps and constants are; noise, of which every bit is news, is not."""
    write_arrays(tmp_path / 'run.npz', ARRAYS)
    with ZipFile(tmp_path / 'run.npz') as archive:
        for name, method in (('t_ns', ZIP_DEFLATED), ('constant', ZIP_DEFLATED),
                             ('noise', ZIP_STORED)):
            assert archive.getinfo(f'{name}.npy').compress_type == method
        assert archive.getinfo('t_ns.npy').compress_size < 0.6 * ARRAYS['t_ns'].nbytes


@pytest.mark.parametrize('period_ns', [10_000_000, 2 ** 20])
def test_a_long_run_at_rest_can_be_read_again(period_ns, tmp_path):
    """
    Eight hours of a perfect IMU at rest shrink a thousandfold, but for their stamps.

    The reader refuses what unpacks to more than a hundred times its size.
    """
    count = 2_900_000
    imu = {'imu_t_ns': np.arange(count) * period_ns,
           'imu_omega': np.tile([0.0, 4e-5, 6e-5], (count, 1)),
           'imu_f': np.tile([0.0, 0.0, 9.8], (count, 1))}
    assert imu['imu_f'].nbytes > 1 << 26
    write_arrays(tmp_path / storage.ARRAYS, imu)
    read = storage.read_imu(tmp_path)
    assert np.array_equal(read.f, imu['imu_f']) and np.array_equal(read.t_ns, imu['imu_t_ns'])
