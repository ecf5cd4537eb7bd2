"""Histories in temporary files: data are read as written, and no file remains."""

import numpy as np
import pytest

from ins_sim.core.timeseries.collecting import Collected
from ins_sim.core.timeseries.histories import NavStates
from ins_sim.report import spool
from ins_sim.report.files.packed_arrays import write_arrays

COUNT = 20000
PARTS = [slice(None), slice(5, 70), slice(10, 5), slice(-5, None), slice(COUNT, None),
         slice(3, 19000, 7), slice(0, None, 10007), slice(30, 20, 3), 0, -1, COUNT - 1]


def states(count):
    """Return a history of random numbers."""
    rng = np.random.default_rng(count)
    return NavStates(np.arange(count) * 10, *rng.normal(size=(3, count)),
                     rng.normal(size=(count, 3)), rng.normal(size=(count, 4)))


def stored(history, store, length=777):
    """Return the history that a store makes from blocks."""
    for block in history.blocks(length):
        store.append(block)
    return store.history()


@pytest.mark.parametrize('part', PARTS, ids=str)
def test_parts_of_a_column_are_those_of_the_array(tmp_path, part):
    """Rows and slices of a column equal those of the array, also with steps beyond a block."""
    history = states(COUNT)
    with spool.Spool(tmp_path) as spooled:
        read = stored(history, spooled.store())
        assert len(read) == COUNT and read.v_n.shape == (COUNT, 3)
        for name, values in history.arrays().items():
            np.testing.assert_array_equal(getattr(read, name)[part], values[part])
            assert getattr(read, name).dtype == values.dtype
        with pytest.raises(IndexError):
            read.t_ns[COUNT]
        with pytest.raises(ValueError, match='step'):
            read.t_ns[::-1]


@pytest.mark.parametrize('length', [1, 4096, 8192, 8193, 50000])
def test_blocks_join_to_the_history(tmp_path, length):
    """Blocks of any length join to the history, in memory and in files."""
    history = states(9000)
    with spool.Spool(tmp_path) as spooled:
        for read in (stored(history, Collected()), stored(history, spooled.store())):
            again = stored(read, Collected(), length)
            for name, values in history.arrays().items():
                np.testing.assert_array_equal(getattr(again, name), values)


def test_a_store_without_blocks_has_no_history(tmp_path):
    """A store without blocks returns no history; the caller refuses such a run."""
    with spool.Spool(tmp_path) as spooled:
        assert spooled.store().history() is None
    assert Collected().history() is None


def test_nothing_is_left_in_the_folder(tmp_path):
    """The folder is empty even while files are open, so that a killed process leaves none."""
    with spool.Spool(tmp_path) as spooled:
        read = stored(states(100), spooled.store())
        assert not list(tmp_path.iterdir())
    with pytest.raises(ValueError):
        read.t_ns[:]


def test_arrays_and_columns_are_saved_alike(tmp_path):
    """NumPy reads saved arrays and columns, also a column longer than the copy buffer."""
    history = states(COUNT)
    with spool.Spool(tmp_path) as spooled:
        read = stored(history, spooled.store())
        write_arrays(tmp_path / 'columns.npz', read.arrays())
    write_arrays(tmp_path / 'arrays.npz', history.arrays())
    for name in ('columns', 'arrays'):
        with np.load(tmp_path / f'{name}.npz') as found:
            assert list(found) == list(history.arrays())
            for key, values in history.arrays().items():
                np.testing.assert_array_equal(found[key], values)
                assert found[key].dtype == values.dtype
