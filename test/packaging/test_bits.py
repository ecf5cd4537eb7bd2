"""The shipped configurations give the guaranteed bits (docs/design/bits.md)."""

import importlib
import platform

from ins_sim.core.numerics.compilation import numba
import pytest
from support.places import ROOT


@pytest.fixture
def bits(monkeypatch):
    """Return the module tools/bits.py; skip the test where nothing is guaranteed."""
    if platform.machine() not in ('x86_64', 'AMD64'):
        pytest.skip(f'the bits are promised for x86-64; this is {platform.machine()}')
    monkeypatch.syspath_prepend(str(ROOT / 'tools'))
    return importlib.import_module('bits')


def expect(found, bits):
    """Compare digests with the stored ones."""
    assert len(found) > 60
    assert not bits.different(found, bits.reference()), (
        'if the numbers are meant to change: python tools/bits.py --write, and say so in '
        'CHANGELOG.rst')


def test_the_bits_are_those_stored(bits):
    """The digests equal the stored ones, with any Python, NumPy and C library."""
    expect(bits.in_child(options=['--plain']), bits)


@pytest.mark.slow
def test_an_older_processor_gives_the_same_bits(bits):
    """Without AVX and fused multiply-add the digests are the same."""
    expect(bits.in_child(bits.older_processor(), ['--plain']), bits)


@pytest.mark.slow
def test_compiled_loops_give_the_same_bits(bits):
    """With all loops compiled from the first sample the digests are the same."""
    if numba() is None:
        pytest.skip('Numba is not installed')
    expect(bits.in_child(options=['--compiled']), bits)
