"""Pairing of two streams by their stamps, whichever is ahead."""

from itertools import chain

from hypothesis import given, strategies as st
from ins_sim.core.streams.pairs import StampPairs


@given(st.lists(st.booleans(), max_size=60), st.integers(1, 3), st.integers(1, 3))
def test_every_common_instant_is_paired_once(order, every_first, every_second):
    """Every common instant is paired once, in any order, if the queue is long enough."""
    pairs, found, sent = StampPairs(1000), [], [0, 0]
    turns = chain(order, [True] * 60, [False] * 120)
    for is_first in turns:
        k = sent[not is_first]
        if k >= 60:
            continue
        sent[not is_first] += 1
        push = pairs.push_first if is_first else pairs.push_second
        t = k * (every_first if is_first else every_second)
        found += push(t, ('first' if is_first else 'second', t))
    common = sorted({k * every_first for k in range(60)} & {k * every_second for k in range(60)})
    assert found == [(t, ('first', t), ('second', t)) for t in common]
    assert pairs.waiting == (59 * every_first > 59 * every_second)


def test_a_stream_that_jumps_back_begins_anew():
    """After a jump back, values of the first run are not paired with those of the second."""
    pairs = StampPairs(10)
    assert not pairs.waiting
    assert pairs.push_first(5, 'a') == [] and pairs.waiting
    assert pairs.push_first(0, 'b') == []
    assert pairs.push_second(0, 'B') == [(0, 'b', 'B')] and not pairs.waiting
    assert pairs.push_first(0, 'c') == [(0, 'c', 'B')]
    assert pairs.push_second(5, 'A') == [] and not pairs.waiting
    assert pairs.push_second(1, 'B') == [] and pairs.push_first(5, 'd') == []
    assert pairs.waiting
    pairs.clear()
    assert not pairs.waiting


def test_of_a_silent_partner_so_many_values_are_kept():
    """If a partner is silent, only the newest values up to the limit, here 3, are kept."""
    pairs = StampPairs(3)
    for t in range(10):
        pairs.push_first(t, t)
    assert pairs.push_second(6, 'x') == [] and pairs.push_second(7, 'x') == [(7, 7, 'x')]
