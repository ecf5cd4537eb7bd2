"""Thinning of a curve leaves out nothing that is visible."""

from hypothesis import given, settings, strategies as st
from ins_sim.report.charts.thinning import kept_points, STRETCHES, thinned_curve
import numpy as np


@settings(max_examples=40)
@given(st.integers(0, 30000), st.integers(0, 2 ** 32 - 1), st.booleans())
def test_no_extreme_is_lost(count, seed, gaps):
    """Each stretch keeps its first, last, smallest and largest point: at most seven, in order."""
    rng = np.random.default_rng(seed)
    x, y = np.arange(count, dtype=float), rng.standard_t(1, count)
    if gaps and count:
        y[rng.integers(0, count, count // 7 + 1)] = np.nan
    kept = kept_points(x, y)
    assert np.all(np.diff(kept) > 0)
    assert len(kept) <= 7 * STRETCHES
    size = -(-count // STRETCHES)
    for first in range(0, count, max(size, 1)):
        part = y[first:first + size]
        shown = y[kept[(kept >= first) & (kept < first + size)]]
        finite = part[np.isfinite(part)]
        if finite.size:
            assert np.nanmin(shown) == finite.min() and np.nanmax(shown) == finite.max()
        # A gap remains a gap.
        assert np.isnan(part).any() == np.isnan(shown).any()


def test_a_spike_of_one_sample_is_drawn():
    """One wrong sample in an hour at 100 Hz is kept; taking every 90th point would miss it."""
    y = np.zeros(360001)
    y[123457] = 1.0
    x = np.arange(len(y)) * 0.01
    t, shown = thinned_curve(x, y)
    assert shown.max() == 1.0 and t[shown.argmax()] == x[123457]
    assert len(t) <= 6 * STRETCHES


def test_a_track_keeps_its_corners():
    """A closed curve keeps its ends and its extremes in both directions."""
    angle = np.linspace(0.0, 2.0 * np.pi, 100001)
    x, y = thinned_curve(np.cos(angle), np.sin(angle))
    assert (x.min(), x.max(), y.min(), y.max()) == (-1.0, 1.0, *np.sin(angle)[[75000, 25000]])
    assert (x[0], y[0]) == (1.0, 0.0) and x[-1] == 1.0
