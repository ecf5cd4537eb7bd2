"""Sliding windows: their instants, contents, and common cycles."""

from dataclasses import replace
import math

from hypothesis import given, settings as hypothesis_settings, strategies as st
from support.meter_studies import DT_NS, flight, meter_settings, same
import numpy as np
import pytest

from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.core.streams.faults import StreamFault

MODES = ('signal', 'surrogate')
UNBIASED = {'surrogate.bias_x_m_s': 0.0}


def wavy(cycles, first=0):
    """Return t_ns, v_b, height of a flight with acceleration, sideslip and climb."""
    t_ns, v_b, height = flight(cycles, first=first)
    s = t_ns * 1e-9
    v_b[:, 0], v_b[:, 1], v_b[:, 2] = 200.0 + 3.0 * s, 4.0 * np.sin(s), np.cos(2.0 * s)
    return t_ns, v_b, height


def velocities(fixes):
    """Return ends (cycles) and velocities (n, 2), m/s."""
    return [fix.end_ns // DT_NS for fix in fixes], np.array([fix.velocity for fix in fixes])


@pytest.mark.parametrize('cycles, step', [(6, 1), (6, 2), (6, 3), (10, 5)])
def test_a_window_is_the_mean_of_its_cycles_and_of_their_noise(cycles, step):
    """
    A window is the mean of its cycles and of their noise, as windows of one cycle show.

    The flight has no sideslip, so all sigmas are equal. Tolerance: rounding of sums of 10 numbers.
    """
    t_ns, v_b, height = flight(60)
    v_b[:, 0] += np.sin(t_ns * 1e-9)
    ones = VelocityMeter(meter_settings({**UNBIASED, 'window.cycles': 1})).advance(
        t_ns, v_b, height)
    s = meter_settings({**UNBIASED, 'window.cycles': cycles, 'window.slide_cycles': step})
    fixes = VelocityMeter(s).advance(t_ns, v_b, height)
    ends, found = velocities(fixes)
    assert ends == list(range(cycles, 61, step))
    assert all(fix.end_ns - fix.start_ns == cycles * DT_NS and fix.cycles == cycles
               for fix in fixes)
    _, single = velocities(ones)
    assert single.std(axis=0).min() > 5.0
    expected = [single[end - cycles:end].mean(axis=0) for end in ends]
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


def test_neighbours_share_the_noise_of_their_common_cycles():
    """Windows k steps apart have correlation 1 - k m/N, within five standard deviations."""
    cycles, step, n = 8, 2, 8000
    s = meter_settings(window__cycles=cycles, window__slide_cycles=step)
    _, v = velocities(VelocityMeter(s).advance(*flight(n * step)))
    z = (v - v.mean(axis=0)) / v.std(axis=0)
    for k in range(6):
        found = (z[:len(z) - k] * z[k:]).mean(axis=0)
        expected = max(0.0, 1.0 - k * step / cycles)
        # The squares of the correlations add up to about 3.
        assert np.abs(found - expected).max() < 5.0 * math.sqrt(3.0 / n)


@pytest.mark.parametrize('mode', MODES)
def test_windows_at_whole_multiples_are_those_that_do_not_overlap(mode):
    """Windows at whole multiples equal those that do not overlap, to rounding (order of sums)."""
    terms = {'mode': mode, 'window.cycles': 12}
    apart = VelocityMeter(meter_settings(terms)).advance(*wavy(48))
    slid = VelocityMeter(meter_settings({**terms, 'window.slide_cycles': 4})).advance(*wavy(48))
    assert len(apart) == 4 and len(slid) == 10
    common = [fix for fix in slid if fix.end_ns % (12 * DT_NS) == 0]
    np.testing.assert_allclose(velocities(common)[1], velocities(apart)[1], rtol=1e-9)
    # In mode signal these windows are those of a flight that begins at their start.
    assert all(fix.valid for fix in slid)


@pytest.mark.parametrize('slide', [0, 12])
def test_slides_of_whole_windows_change_no_bit(slide):
    """slide_cycles of 0 and of N both give adjacent windows, with the same bits."""
    s = meter_settings(window__cycles=12, attack_angle='ins')
    t_ns, v_b, height = wavy(48)
    slid = replace(s, window=replace(s.window, slide_cycles=slide))
    assert not slid.window.slides
    assert same(VelocityMeter(slid).advance(t_ns, v_b, height, v_b),
                VelocityMeter(s).advance(t_ns, v_b, height, v_b))


@hypothesis_settings(deadline=None, max_examples=15)
@given(mode=st.sampled_from(MODES), attack=st.sampled_from(['ins', 'none']),
       window=st.sampled_from([(6, 1), (6, 3), (8, 2)]), first=st.integers(0, 20),
       cuts=st.lists(st.integers(1, 40), max_size=5))
def test_neither_cutting_nor_joining_changes_a_bit(mode, attack, window, first, cuts):
    """Blocks, single pushes, and a meter that starts at any time give the same bits."""
    cycles, step = window
    s = meter_settings(mode=mode, attack_angle=attack, window__cycles=cycles,
                       window__slide_cycles=step)
    t_ns, v_b, height = wavy(40)
    whole = VelocityMeter(s).advance(t_ns, v_b, height, v_b)
    assert len(whole) == (40 - cycles) // step + 1
    meter, found, ends = VelocityMeter(s), [], [0, *sorted(set(cuts)), 41]
    for a, b in zip(ends, ends[1:]):
        found += meter.advance(t_ns[a:b], v_b[a:b], height[a:b], v_b[a:b])
    assert same(found, whole)
    meter, found = VelocityMeter(s), []
    for t, v, h in zip(t_ns.tolist(), v_b.tolist(), height.tolist()):
        found += meter.push_truth(t, v, h)
        found += meter.push_ins(t, v)
    assert same(found, whole)
    late = VelocityMeter(s).advance(t_ns[first:], v_b[first:], height[first:], v_b[first:])
    seen_ns = -(-first // step) * step * DT_NS
    assert same(late, [fix for fix in whole if fix.start_ns >= seen_ns])


@pytest.mark.parametrize('attack', ['ins', 'none'])
def test_a_cycle_that_cannot_be_measured_spoils_the_windows_that_hold_it(attack):
    """A cycle that cannot be measured invalidates exactly the windows that contain it."""
    s = meter_settings(attack_angle=attack, window__cycles=6, window__slide_cycles=2,
                       limits__height_max_m=1000.0)
    t_ns, v_b, height = wavy(40)
    height[15] = 2000.0
    fixes = VelocityMeter(s).advance(t_ns, v_b, height, v_b)
    bad = [fix.end_ns // DT_NS for fix in fixes if not fix.valid]
    # The sample at 15 ends cycle 15 and begins cycle 16.
    assert bad == [16, 18, 20] and len(fixes) == 18
    assert {fix.status for fix in fixes if not fix.valid} == {'height outside the limits'}


def test_a_drop_out_spoils_the_windows_that_overlap_it():
    """A drop-out invalidates exactly the windows that overlap it in motion time."""
    s = meter_settings({'window.cycles': 6, 'window.slide_cycles': 2,
                        'drop_outs.start_s': (0.125,), 'drop_outs.end_s': (0.135,)})
    fixes = VelocityMeter(s).advance(*wavy(40))
    assert [fix.end_ns // DT_NS for fix in fixes if not fix.valid] == [14, 16, 18]


def test_the_angle_of_attack_is_that_of_the_window():
    """The angle of attack is the mean over the whole window, although it is summed by slides."""
    s = meter_settings(attack_angle='ins', window__cycles=6, window__slide_cycles=2)
    t_ns, v_b, height = wavy(40)
    for fix in VelocityMeter(s).advance(t_ns, v_b, height, v_b):
        inside = (t_ns > fix.start_ns) & (t_ns <= fix.end_ns)
        forward, _, up = v_b[inside].sum(axis=0)
        assert fix.tan_alpha == pytest.approx(-up / forward, rel=1e-12)


def test_after_a_gap_a_window_is_seen_from_its_start_again():
    """After a gap, windows that contain the gap are not reported."""
    s = meter_settings(window__cycles=6, window__slide_cycles=2)
    t_ns, v_b, height = wavy(40)
    meter = VelocityMeter(s)
    found = meter.advance(t_ns[:14], v_b[:14], height[:14])
    with pytest.raises(StreamFault, match='gap'):
        meter.push_truth(int(t_ns[15]), v_b[15].tolist(), 500.0)
    meter.reset()
    found += meter.advance(t_ns[15:], v_b[15:], height[15:])
    whole = VelocityMeter(s).advance(t_ns, v_b, height)
    assert same(found, [fix for fix in whole
                        if fix.end_ns <= 13 * DT_NS or fix.start_ns >= 16 * DT_NS])


@pytest.mark.parametrize('slide', [4, 7, 20])
def test_a_slide_that_is_no_divisor_is_refused(slide):
    """A slide that is not a divisor of N is refused with one message."""
    with pytest.raises(ValueError, match=f'window.slide_cycles is {slide} with window.cycles 10; '
                                         'expected 0 or a divisor of window.cycles'):
        meter_settings(window__cycles=10, window__slide_cycles=slide)
