"""Compression of bags: every library reads the output of the others; plain bags need none."""

import importlib
import tracemalloc

from ins_sim.bags import compression
from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.cli.main import main
from ins_sim.messages import topics
import numpy as np
import pytest

LIBRARIES = [('lz4', 'lz4.frame'), ('zstd', 'compression.zstd'), ('zstd', 'backports.zstd'),
             ('zstd', 'zstandard')]
DATA = np.random.default_rng(1).integers(0, 9, 300_000, dtype=np.uint8).tobytes()


@pytest.fixture
def only(monkeypatch):
    """Return a function that makes only the given modules available for a compression."""
    def leave(name, *modules):
        for module in modules:
            pytest.importorskip(module)
        monkeypatch.setitem(compression.MODULES, name, modules)
        compression.compression_library.cache_clear()
    yield leave
    compression.compression_library.cache_clear()


def installed(module):
    """Return whether a module can be imported."""
    try:
        importlib.import_module(module)
    except ImportError:
        return False
    return True


@pytest.mark.parametrize('name, module', LIBRARIES)
def test_each_library_reads_what_any_wrote(name, module, only):
    """Data pass through every pair of libraries unchanged."""
    only(name, module)
    packed = compression.compress(memoryview(DATA), name)
    assert compression.compression_library(name).__name__ == module
    assert len(packed) < len(DATA)
    for other in {other for of, other in LIBRARIES if of == name and installed(other)}:
        only(name, other)
        assert compression.decompress(packed, name, len(DATA)) == DATA


@pytest.mark.parametrize('name, module', LIBRARIES)
def test_bad_data_are_refused(name, module, only):
    """Truncated data, other data, and data of an unstated size are refused with one message."""
    only(name, module)
    packed = bytes(compression.compress(DATA, name))
    for stop in (0, 3, 20, len(packed) // 2):
        with pytest.raises(ValueError, match='corrupt|expected|cannot unpack'):
            compression.decompress(packed[:stop], name, len(DATA))
    with pytest.raises(ValueError, match='corrupt|expected|cannot unpack'):
        compression.decompress(DATA[:1000], name, 1000)
    for size in (len(DATA) - 1, len(DATA) + 1):
        with pytest.raises(ValueError, match='expected'):
            compression.decompress(packed, name, size)


@pytest.mark.parametrize('name, module', LIBRARIES)
def test_memory_is_bounded_by_what_the_chunk_says(name, module, only):
    """A chunk that unpacks to 200 MB but states 1 MB needs less than 20 MB of memory."""
    only(name, module)
    packed = compression.compress(bytes(200_000_000), name)
    tracemalloc.start()
    with pytest.raises(ValueError, match='expected'):
        compression.decompress(packed, name, 1_000_000)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 20_000_000


def write(path, name):
    """Write a bag of a thousand readings."""
    stamps = np.arange(1000) * 10_000_000
    with BagWriter(path, compression=name) as bag:
        bag.add_topic('imu/data_raw', topics.IMU)
        bag.write_blocks({'imu/data_raw': (stamps, topics.IMU_RAW.writer().block(
            stamps, np.zeros((1000, 6))))})
    return path


@pytest.mark.parametrize('name, package', [('lz4', 'python3-lz4'), ('zstd', 'python3-zstandard')])
def test_a_missing_library_is_one_sentence(name, package, only, tmp_path, capsys):
    """The message for a missing library names what to install; plain bags need none."""
    write(tmp_path / 'packed', name)
    only('lz4')
    only('zstd')
    for attempt in (lambda: open_bag(tmp_path / 'packed'),
                    lambda: BagWriter(tmp_path / 'new', compression=name)):
        with pytest.raises(ValueError, match='extra "compression"') as caught:
            attempt()
        assert package in str(caught.value) and 'corrupt' not in str(caught.value)
    assert not (tmp_path / 'new').exists()
    for words in (['info', str(tmp_path / 'packed')],
                  ['simulate', '-p', 'duration_s:=1.0', '-o', str(tmp_path / 'run'),
                   '--bag', str(tmp_path / 'new'), '--compression', name]):
        assert main(words) == 2
        error = capsys.readouterr().err
        assert error.count('\n') == 1 and f'compression by {name} needs a library' in error
    with open_bag(write(tmp_path / 'plain', 'none')) as bag:
        assert len(bag.arrays('imu/data_raw')) == 1000


def test_a_cut_bag_loses_no_chunk_to_a_missing_library(only, tmp_path):
    """In a truncated bag a missing library is not mistaken for a damaged last chunk."""
    path = write(tmp_path / 'bag', 'zstd') / 'bag_0.mcap'
    path.write_bytes(path.read_bytes()[:-50])
    with open_bag(path) as bag:
        assert bag.cut and len(bag.arrays('imu/data_raw')) == 1000
    only('zstd')
    with pytest.raises(ValueError, match='python3-zstandard'):
        open_bag(path)


@pytest.mark.parametrize('name', ['lz4', 'zstd'])
def test_a_chunk_that_gains_more_than_messages_do_is_refused_before_it_is_unpacked(name):
    """A chunk may unpack to 64 MB at any ratio; a gigabyte of zeros is refused before."""
    data = compression.compress(bytes(1 << 20), name)
    assert compression.decompress(data, name, 1 << 20) == bytes(1 << 20)
    with pytest.raises(ValueError, match='it claims 1073741824 bytes; expected at most '
                                         '67108864 for its'):
        compression.decompress(data, name, 1 << 30)
