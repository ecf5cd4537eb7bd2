"""Compressed arrays keep their bits, and arrays that would not shrink are not compressed."""

from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile

from ins_sim.core.timeseries.histories import NavErrors
from ins_sim.report import spool, storage
from ins_sim.report.files.packed_arrays import write_arrays
from ins_sim.report.files.tables import write_table
from ins_sim.report.files.wanted import EveryNth
import numpy as np
import pytest

COUNT = 20000
ARRAYS = {
    't_ns': np.arange(COUNT) * 10_000_000, 'constant': np.full((COUNT, 3), 6000.0),
    'noise': np.random.default_rng(1).normal(size=(COUNT, 3)),
    'odd': np.array([np.nan, np.inf, -np.inf, -0.0, 5e-324]), 'none': np.zeros((0, 3)),
    'flags': np.array([True, False]), 'texts': np.array(['valid', 'outage'])}


def test_arrays_come_back_to_the_bit(tmp_path):
    """numpy.load restores types, shapes and bytes, also of arrays that are not contiguous."""
    arrays = {**ARRAYS, 'across': np.asfortranarray(ARRAYS['noise']),
              'every 7th': ARRAYS['noise'][::7]}
    write_arrays(tmp_path / 'run.npz', arrays)
    with np.load(tmp_path / 'run.npz') as found:
        assert list(found) == list(arrays)
        for name, values in arrays.items():
            assert found[name].dtype == values.dtype and found[name].shape == values.shape
            assert found[name].tobytes() == values.tobytes()


def test_only_what_shrinks_is_compressed(tmp_path):
    """Stamps and constants are compressed, noise is not."""
    write_arrays(tmp_path / 'run.npz', ARRAYS)
    with ZipFile(tmp_path / 'run.npz') as archive:
        for name, method in (('t_ns', ZIP_DEFLATED), ('constant', ZIP_DEFLATED),
                             ('noise', ZIP_STORED)):
            assert archive.getinfo(f'{name}.npy').compress_type == method
        assert archive.getinfo('t_ns.npy').compress_size < 0.6 * ARRAYS['t_ns'].nbytes


@pytest.mark.parametrize('period_ns', [10_000_000, 2 ** 20])
def test_a_long_run_at_rest_can_be_read_again(period_ns, tmp_path):
    """
    Eight hours of a perfect IMU at rest shrink a thousandfold and can be read again.

    Stamps shrink less. The reader refuses a file that unpacks to more than a hundred times its
    size, but not this one.
    """
    count = 2_900_000
    imu = {'imu_t_ns': np.arange(count) * period_ns,
           'imu_omega': np.tile([0.0, 4e-5, 6e-5], (count, 1)),
           'imu_f': np.tile([0.0, 0.0, 9.8], (count, 1))}
    assert imu['imu_f'].nbytes > 1 << 26
    write_arrays(tmp_path / storage.ARRAYS, imu)
    read = storage.read_imu(tmp_path)
    assert np.array_equal(read.f, imu['imu_f']) and np.array_equal(read.t_ns, imu['imu_t_ns'])


@pytest.mark.parametrize('step', [1, 3, 8192, 9000, 30000])
def test_every_nth_row_of_a_column_in_a_file(step, tmp_path):
    """Rows of several blocks, selected block by block, equal those of the array."""
    values = np.random.default_rng(2).normal(size=(COUNT, 3))
    errors = NavErrors(np.arange(COUNT), values, 2.0 * values, 3.0 * values, 4.0 * values)
    with spool.Spool(tmp_path) as spooled:
        store = spooled.store()
        for block in errors.blocks(777):
            store.append(block)
        kept = NavErrors(**{name: EveryNth(column, step)
                            for name, column in store.history().arrays().items()})
        assert len(kept) == len(errors[::step]) and kept.drift.shape == errors.drift[::step].shape
        write_arrays(tmp_path / 'run.npz', kept.arrays())
        write_table(tmp_path / 'kept.csv', kept)
    write_table(tmp_path / 'array.csv', errors[::step])
    with np.load(tmp_path / 'run.npz') as found:
        for name, column in errors[::step].arrays().items():
            assert found[name].tobytes() == column.tobytes()
    assert (tmp_path / 'kept.csv').read_bytes() == (tmp_path / 'array.csv').read_bytes()
