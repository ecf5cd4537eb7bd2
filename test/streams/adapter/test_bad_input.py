"""Invalid odometry is reported with one message and gives no truth; later truth continues."""

import math

from hypothesis import given, settings as examples, strategies as st
import numpy as np
import pytest
from support.other_simulators import OtherSimulator, PLACE

from ins_sim.core.streams.adapter.stage import TruthAdapter
from ins_sim.core.streams.faults import StreamFault
from ins_sim.settings.catalogue import build
from ins_sim.settings.truth_adapter import TruthAdapterSettings


def pushed(rows, **values):
    """Return the truths and messages for rows that are pushed as a node pushes them."""
    adapter = TruthAdapter(build(TruthAdapterSettings, {**PLACE, **values}))
    truths, said = [], []
    for row in rows:
        try:
            truths += adapter.push(*row)
            continue
        except StreamFault as fault:
            said.append(str(fault))
            if not fault.restart:
                continue
        adapter.reset()
        try:
            truths += adapter.push(*row)
        except StreamFault as fault:
            said.append(str(fault))
    for truth in truths:
        assert all(map(math.isfinite, np.hstack([np.ravel(x) for x in truth])))
    return truths, said


def rows_of(name='sinusoids', rate_hz=50.0, length_s=8.0):
    """Return the rows of an exact input."""
    return list(OtherSimulator(name, rate_hz, length_s).samples())


def changed(rows, k, **fields):
    """Return rows in which row k has other fields."""
    row = dict(zip(('t_ns', 'r', 'q', 'v', 'w'), rows[k]))
    return [*rows[:k], tuple({**row, **fields}.values()), *rows[k + 1:]]


def moved(rows, k, metres):
    """Return rows whose positions are shifted from row k on."""
    return [*rows[:k], *((t, (r[0] + metres, *r[1:]), q, v, w) for t, r, q, v, w in rows[k:])]


@pytest.mark.parametrize('k', [40, 200], ids=['while it is judged', 'later'])
@pytest.mark.parametrize('spoil, said', [
    (lambda rows, k: [*rows[:k], *rows[k + 1:]], 'odom has a gap from'),
    (lambda rows, k: moved(rows, k, 10.0), 'odom jumps at'),
    (lambda rows, k: changed(rows, k, q=(0.0,) * 4), 'orientation of norm 0; expected 1'),
    (lambda rows, k: changed(rows, k, q=(0.0, 0.0, 0.0, 1.01)), 'orientation of norm 1.01'),
    (lambda rows, k: changed(rows, k, v=(math.nan, 0.0, 0.0)), 'expected finite numbers'),
    (lambda rows, k: [*rows[:k], rows[k - 1], *rows[k:]], 'odom repeats the stamp'),
    (lambda rows, k: [*rows[:k], *((t - rows[k][0], *x) for t, *x in rows[k:])],
     'odom jumps back from'),
], ids=['gap', 'jump', 'zero quaternion', 'long quaternion', 'nan', 'repeated', 'backwards'])
def test_a_fault_is_one_sentence_and_passes(spoil, said, k):
    """A bad sample is reported once; the truth then continues or restarts."""
    truths, sentences = pushed(spoil(rows_of(), k))
    # A dropped sample leaves a gap.
    assert said in sentences[0] and len(sentences) <= 2
    assert all('gap' in sentence for sentence in sentences[1:])
    assert len(truths) > 600
    steps = np.diff([truth.t_ns for truth in truths])
    assert (steps == 5_000_000).sum() >= len(steps) - 1


def test_a_turn_too_far_is_said():
    """An input that rotates by more than 2 rad between samples gives no truth, and one message."""
    rows = [(k * 50_000_000, (0.0,) * 3, (0.0, 0.0, math.sin(1.1 * k), math.cos(1.1 * k)),
             (0.0,) * 3, (0.0, 0.0, 44.0)) for k in range(200)]
    truths, said = pushed(rows)
    assert not truths and all('turns 2.2 rad in one step; expected at most 2' in s for s in said)


def test_another_rate_is_taken_for_another_input():
    """A simulator that returns at half the rate is examined again."""
    rows = rows_of(rate_hz=100.0, length_s=12.0)
    truths, said = pushed([*rows[:400], *rows[400::2]])
    assert len(said) == 2 and 'gap' in said[0]
    assert truths[-1].t_ns > 11_000_000_000


def test_a_silence_is_a_gap():
    """An input that pauses gives truth up to the pause, and again from its end."""
    rows = rows_of()
    truths, said = pushed([*rows[:200], *rows[300:]])
    assert len(said) == 1 and 'from 3.980000000 s to 6.000000000 s' in said[0]
    steps = np.diff([truth.t_ns for truth in truths])
    assert (steps > 5_000_000).sum() == 1


def test_stamps_of_a_wrong_unit_do_no_harm():
    """Stamps a thousand times too far apart are refused instead of being filled with truth."""
    truths, said = pushed([(1000 * t, *more) for t, *more in rows_of(length_s=4.0)])
    assert not truths and 'has a gap' in said[0]


@pytest.mark.parametrize('step_ns', [1, 1000])
def test_stamps_too_near_do_no_harm(step_ns):
    """Stamps that are nanoseconds apart neither fill the memory nor repeat messages."""
    rows = rows_of(length_s=4.0)
    adapter = TruthAdapter(build(TruthAdapterSettings, PLACE))
    for k in range(20_000):
        try:
            adapter.push(k * step_ns, *rows[k % 200][1:])
        except StreamFault:
            adapter.reset()
    assert adapter._look is None or len(adapter._look._samples) <= 8192


NUMBERS = st.floats(-1e5, 1e5)
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS)


@examples(max_examples=30, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 199), st.integers(-30_000_000, 60_000_000),
                          st.sampled_from('rqvw'), VECTORS, NUMBERS), max_size=8),
       st.sampled_from(['auto', 'use', 'ignore']), st.sampled_from(['believed', 'nominal']),
       st.sampled_from([0.0, 0.2]))
def test_no_garbage_makes_anything_but_sentences(spoiled, twist, stamps, smoothing_s):
    """For any samples the stage raises StreamFault only, and its truth stays finite."""
    rows = rows_of(length_s=6.0)
    for k, shift_ns, name, vector, w in spoiled:
        value = vector if name != 'q' else (*vector, w)
        rows = changed(rows, k, t_ns=rows[k][0] + shift_ns, **{name: value})
    pushed(rows, twist=twist, stamps=stamps, smoothing_s=smoothing_s)
