"""The garbage collector is off only within blocks; afterwards its former state returns."""

import gc
import threading

import pytest

from ins_sim.core.numerics.garbage_collection import collector_paused, paused_in_blocks


@pytest.fixture(autouse=True)
def collector():
    """Restore the state of the collector after the test."""
    yield
    gc.enable()


def test_nested_pauses_end_with_the_outer_one():
    """Leaving an inner pause does not enable the collector; leaving the outer one does."""
    with collector_paused:
        with collector_paused:
            assert not gc.isenabled()
        assert not gc.isenabled()
    assert gc.isenabled()


def test_a_pause_ends_with_an_exception():
    """After an exception the collector has its former state, on or off."""
    for before in (gc.enable, gc.disable):
        before()
        enabled = gc.isenabled()
        with pytest.raises(KeyboardInterrupt), collector_paused:
            raise KeyboardInterrupt
        assert gc.isenabled() == enabled


def test_the_last_of_several_threads_restores():
    """The collector stays off while one of several threads is still inside a pause."""
    inside, leave = threading.Event(), threading.Event()

    def work():
        with collector_paused:
            inside.set()
            leave.wait(10.0)

    other = threading.Thread(target=work)
    with collector_paused:
        other.start()
        assert inside.wait(10.0)
    assert not gc.isenabled()
    leave.set()
    other.join()
    assert gc.isenabled()


def test_blocks_are_made_without_the_collector_and_used_with_it():
    """Blocks are made with the collector off and used with it on, even if use stops early."""
    seen, closed = [], []

    @paused_in_blocks
    def blocks(count):
        try:
            for k in range(count):
                seen.append(gc.isenabled())
                yield k
        finally:
            closed.append(True)

    assert [gc.isenabled() for _ in blocks(3)] == [True] * 3
    assert seen == [False] * 3
    for k in blocks(3):
        break
    with pytest.raises(ZeroDivisionError):
        for k in blocks(3):
            k / 0
    assert gc.isenabled() and closed == [True] * 3


def test_an_error_in_a_block_restores():
    """An error in the generator reaches the consumer, and the collector is restored."""
    @paused_in_blocks
    def blocks():
        yield 1
        raise ValueError('gap')

    with pytest.raises(ValueError, match='gap'):
        list(blocks())
    assert gc.isenabled()
