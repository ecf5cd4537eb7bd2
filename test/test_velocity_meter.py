"""The velocity meter as an instrument: windows, streams, the angle of attack, invalid fixes."""

from dataclasses import astuple
import math
import warnings

from hypothesis import example, given, settings as hypothesis_settings, strategies as st
from meter_studies import body, DT_NS, flight, meter_settings, PERFECT
import numpy as np
import pytest
from scipy.stats import chi2

from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.sensors.velocity_meter.meter import (CALM, NO_ANGLE, NO_INS, VelocityMeter,
                                                       WAIT_NS)
from ins_sim.core.sensors.velocity_meter.surrogate import sigmas

V = 200.0
MODES = ('signal', 'surrogate')


def same(a, b):
    """Return whether two lists of fixes are equal to the bit, NaN included."""
    return repr([astuple(fix) for fix in a]) == repr([astuple(fix) for fix in b])


def wavy(cycles, first=0):
    """Return t_ns, v_b, height of a flight that speeds up, slips and climbs."""
    t_ns, v_b, height = flight(cycles, first=first)
    s = t_ns * 1e-9
    v_b[:, 0], v_b[:, 1], v_b[:, 2] = V + 3.0 * s, 4.0 * np.sin(s), -5.0 + np.cos(2.0 * s)
    return t_ns, v_b, height


def test_windows():
    """Window m is ((m - 1) N dt, m N dt]; stamps, arrival and mean are those of the window."""
    s = meter_settings({**PERFECT, 'window.cycles': 7, 'window.latency_ms': 12.5})
    t_ns, v_b, height = wavy(30)
    fixes = VelocityMeter(s).advance(t_ns, v_b, height)
    assert [(fix.start_ns, fix.end_ns) for fix in fixes] == \
        [(7 * m * DT_NS, 7 * (m + 1) * DT_NS) for m in range(4)]
    for m, fix in enumerate(fixes):
        part = v_b[7 * m:7 * m + 8]
        mean = np.trapezoid(part, axis=0) if hasattr(np, 'trapezoid') else np.trapz(part, axis=0)
        assert fix.valid and fix.cycles == 7 and fix.arrival_ns == fix.end_ns + 12_500_000
        # without an angle of attack both are read large by 1/cos(alpha)^2
        scale = 1.0 + (mean[2] / mean[0]) ** 2
        assert fix.velocity == pytest.approx(tuple(scale * mean[:2] / 7), rel=1e-12)
        assert fix.sigma == (0.0, 0.0) and fix.tan_alpha == 0.0


@pytest.mark.parametrize('first, windows', [(0, 3), (1, 2), (9, 2), (10, 2), (11, 1), (-10, 3),
                                            (-3, 3), (20, 1), (21, 0)])
def test_a_window_that_was_not_seen_from_its_start_is_not_reported(first, windows):
    """Nor is one before motion time zero."""
    meter = VelocityMeter(meter_settings(window__cycles=10))
    fixes = meter.advance(*flight(30 - first, first=first))
    assert [fix.end_ns // DT_NS for fix in fixes] == [10, 20, 30][3 - windows:]


@pytest.mark.parametrize('mode', MODES)
@pytest.mark.parametrize('attack', ['ins', 'none'])
def test_numbers_do_not_depend_on_when_the_stream_is_joined(mode, attack):
    """Window 5 is the same to the bit from 0, from its start, and after a reset."""
    s = meter_settings(mode=mode, attack_angle=attack, window__cycles=5)
    t_ns, v_b, height = wavy(25)
    meter = VelocityMeter(s)
    whole = meter.advance(t_ns, v_b, height, v_b)
    late = VelocityMeter(s).advance(t_ns[20:], v_b[20:], height[20:], v_b[20:])
    assert len(whole) == 5 and len(late) == 1 and same(whole[4:], late)
    meter.reset()
    assert same(meter.advance(t_ns, v_b, height, v_b), whole)


@hypothesis_settings(deadline=None, max_examples=15)
@given(mode=st.sampled_from(MODES), attack=st.sampled_from(['ins', 'none']),
       cycles=st.sampled_from([1, 3, 8]),
       lead=st.lists(st.integers(0, 20), min_size=41, max_size=41),
       cuts=st.lists(st.integers(1, 40), max_size=5))
def test_any_cutting_gives_the_same_bits(mode, attack, cycles, lead, cuts):
    """Blocks, single pushes, and the INS ahead of the truth or behind it."""
    s = meter_settings(mode=mode, attack_angle=attack, window__cycles=cycles)
    t_ns, v_b, height = wavy(40)
    ins_v_b = v_b + 0.1
    whole = VelocityMeter(s).advance(t_ns, v_b, height, ins_v_b)
    assert len(whole) == 40 // cycles
    meter, found, ends = VelocityMeter(s), [], [0, *sorted(set(cuts)), 41]
    for a, b in zip(ends, ends[1:]):
        found += meter.advance(t_ns[a:b], v_b[a:b], height[a:b], ins_v_b[a:b])
    assert same(found, whole)
    meter, found, said = VelocityMeter(s), [], 0
    samples = list(zip(t_ns.tolist(), v_b.tolist(), height.tolist(), ins_v_b.tolist()))
    for k, (t, v, h, _) in enumerate(samples):
        reach = min(41, max(0, k - 10 + lead[k]))
        for one in samples[said:reach]:
            found += meter.push_ins(one[0], one[3])
        said = max(said, reach)
        found += meter.push_truth(t, v, h)
    for one in samples[said:]:
        found += meter.push_ins(one[0], one[3])
    assert same(found, whole)


@hypothesis_settings(deadline=None, max_examples=60)
@given(order=st.lists(st.booleans(), min_size=134, max_size=134))
@example(order=[True] * 134)
@example(order=[False] * 134)
def test_a_run_after_a_jump_back_is_whole(order):
    """
    Truth or INS may jump first: windows of the new run have all of its angles and no older one.

    Both streams have begun the first run before one of them can end it.
    """
    s = meter_settings(attack_angle='ins', window__cycles=5)
    t_ns, v_b, height = wavy(40)
    ins_v_b = v_b + 0.1
    whole = VelocityMeter(s).advance(t_ns, v_b, height, ins_v_b)
    runs = [*range(41), *range(26)]
    left, meter, found = {True: list(runs), False: list(runs)}, VelocityMeter(s), []
    for of_truth in (True, False, True, False, *order, *(True,) * 67, *(False,) * 67):
        if not left[of_truth]:
            continue
        k = left[of_truth].pop(0)
        if of_truth:
            sample = int(t_ns[k]), v_b[k].tolist(), float(height[k])
            try:
                found += meter.push_truth(*sample)
            except StreamFault as fault:
                assert fault.restart and 'jumps back' in str(fault)
                meter.reset()
                found += meter.push_truth(*sample)
        else:
            found += meter.push_ins(int(t_ns[k]), ins_v_b[k].tolist())
    assert meter.waits_for_ns is None
    assert same(found[-5:], whole[:5]) and same(found[:-5], whole[:len(found) - 5])


@pytest.mark.parametrize('mode', MODES)
def test_seeds_and_runs(mode):
    """The same give the same, others other numbers."""
    def velocities(run=0, **terms):
        s = meter_settings(mode=mode, window__cycles=10, **terms)
        return [fix.velocity for fix in VelocityMeter(s, run).advance(*flight(20))]

    assert velocities() == velocities() != velocities(seed=1)
    assert velocities(run=1) == velocities(run=1) != velocities()
    assert len(set(velocities())) == 2


@pytest.mark.parametrize('mode', MODES)
@pytest.mark.parametrize('terms, change, says', [
    ({}, ('height', 20.0), 'height outside the limits'),
    ({}, ('height', 16000.0), 'height outside the limits'),
    ({}, ('v', (0.0, 0.0, 0.0)), 'speed outside the limits'),
    ({}, ('v', (-200.0, 0.0, 0.0)), 'speed outside the limits'),
    ({}, ('v', (29.0, 0.0, 0.0)), 'speed outside the limits'),
    ({}, ('v', (401.0, 0.0, 0.0)), 'speed outside the limits'),
    ({}, ('v', (100.0, 120.0, 0.0)), 'sideslip or angle of attack beyond 45 deg'),
    ({}, ('v', (100.0, 0.0, -101.0)), 'sideslip or angle of attack beyond 45 deg'),
    ({'drop_outs.start_s': [0.149], 'drop_outs.end_s': [0.151]}, None, CALM)])
def test_windows_that_measure_nothing(mode, terms, change, says):
    """Window 2 says why, with NaN and no warning; its neighbours are as if nothing was."""
    s = meter_settings({'mode': mode, 'window.cycles': 10, **terms})
    t_ns, v_b, height = flight(40)
    usual = VelocityMeter(meter_settings(mode=mode, window__cycles=10)).advance(t_ns, v_b, height)
    if change:
        name, value = change
        (height if name == 'height' else v_b)[15] = value
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        fixes = VelocityMeter(s).advance(t_ns, v_b, height)
    assert [fix.valid for fix in fixes] == [True, False, True, True]
    assert fixes[1].status == says and np.isnan(fixes[1].velocity + fixes[1].sigma).all()
    assert same(fixes[:1] + fixes[2:], usual[:1] + usual[2:])


@pytest.mark.parametrize('start, end, lost', [(0.1, 0.2, [2]), (0.0999, 0.2001, [1, 2, 3]),
                                              (0.0, 0.1, [1]), (0.25, 0.26, [3]), (0.4, 9.0, [])])
def test_the_schedule_of_drop_outs(start, end, lost):
    """The windows (0, 0.1], (0.1, 0.2], ... that overlap are invalid, whatever else is wrong."""
    s = meter_settings({'window.cycles': 10, 'drop_outs.start_s': [start, 20.0],
                        'drop_outs.end_s': [end, 30.0]})
    fixes = VelocityMeter(s).advance(*flight(40))
    assert [m for m, fix in enumerate(fixes, 1) if fix.status == CALM] == lost


def test_standing_still():
    """An hour on the ground is invalid fixes, neither exception nor warning."""
    for mode in MODES:
        meter = VelocityMeter(meter_settings(mode=mode, attack_angle='ins', window__cycles=100))
        t_ns, v_b, height = flight(1000, (0.0, 0.0, 0.0))
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            fixes = meter.advance(t_ns, v_b, height, v_b)
        assert len(fixes) == 10 and not any(fix.valid for fix in fixes)


def test_the_angle_of_attack_of_the_ins():
    """It is -mean(V_y1)/mean(V_x1) of its samples in the window; with it the body is met."""
    s = meter_settings({**PERFECT, 'attack_angle': 'ins', 'window.cycles': 10})
    v = body(V, 0.05, 0.08)
    t_ns, v_b, height = flight(10, v)
    ins = v_b.copy()
    ins[1:, 2] *= np.linspace(0.5, 1.5, 10)
    fix, = VelocityMeter(s).advance(t_ns, v_b, height, ins)
    assert fix.tan_alpha == pytest.approx(math.tan(0.08), rel=1e-12)
    assert fix.velocity == pytest.approx(v[:2], rel=1e-12) and fix.up == pytest.approx(v[2])
    # one sample in the window will do, the one at its start is not inside
    meter = VelocityMeter(s)
    assert meter.advance(t_ns, v_b, height) == []
    assert meter.push_ins(0, (V, 0.0, -50.0)) == []
    assert meter.push_ins(5 * DT_NS, (V, 0.0, -20.0)) == []
    fix, = meter.push_ins(12 * DT_NS, (V, 0.0, 0.0))
    assert fix.tan_alpha == pytest.approx(0.1) and fix.valid


def test_without_an_ins():
    """A window waits for it, in order, and for no longer than WAIT_NS."""
    s = meter_settings(attack_angle='ins', window__cycles=100)
    meter, seconds = VelocityMeter(s), WAIT_NS // 1_000_000_000
    fixes = meter.advance(*flight(100 * (seconds + 2)))
    assert [(fix.end_ns, fix.status) for fix in fixes] == \
        [(m * 100 * DT_NS, NO_INS) for m in (1, 2)]
    # it comes late: what it did not see is invalid, and nothing waits any more
    fixes = meter.push_ins(100 * (seconds + 2) * DT_NS, (V, 0.0, 0.0))
    assert [fix.status for fix in fixes] == [NO_INS] * (seconds - 1) + ['valid']


@pytest.mark.parametrize('v', [(0.0, 0.0, 0.0), (-200.0, 0.0, 1.0), (10.0, 0.0, 11.0)])
def test_an_ins_that_gives_no_angle(v):
    """The fix says so."""
    s = meter_settings(attack_angle='ins', window__cycles=10)
    t_ns, v_b, height = flight(10)
    fix, = VelocityMeter(s).advance(t_ns, v_b, height, np.tile(v, (11, 1)))
    assert fix.status == NO_ANGLE and fix.tan_alpha == 0.0


def test_the_surrogate_has_its_errors():
    """Bias, scales, and variances by chi-square at 1e-6, with sideslip, N = 4."""
    beta, n = 0.1, 3000
    s = meter_settings(window__cycles=4, surrogate__k_x=0.01, surrogate__k_z=-0.02,
                       beam__sigma_theta_z_rad=0.11)
    v = body(V, beta)
    fixes = VelocityMeter(s).advance(*flight(4 * n, v))
    sigma = sigmas(s.surrogate, 4, beta)
    assert sigma == pytest.approx((4.0 * math.sqrt(1.36), math.hypot(8.7, 16.0) / 2.0))
    mean = 1.01 * v[0] - 4.0, 0.98 * 1.21 * v[1]
    for k in (0, 1):
        z = (np.array([fix.velocity[k] for fix in fixes]) - mean[k]) / sigma[k]
        assert abs(z.sum()) < 5.0 * math.sqrt(n)
        assert chi2.ppf(1e-6, n) < (z ** 2).sum() < chi2.isf(1e-6, n)
        assert abs((z[1:] * z[:-1]).sum()) < 5.0 * math.sqrt(n)


def pushed(meter, cycles):
    """Return a meter that was fed a steady flight."""
    meter.advance(*flight(cycles))
    return meter


@pytest.mark.parametrize('t, v, height, restart, says', [
    (12, (math.nan, 0.0, 0.0), 500.0, False, 'holds'),
    (11, (V, 0.0, 0.0), math.inf, False, 'holds'),
    (10, (V, 0.0, 0.0), 500.0, False, 'repeats the stamp 0.100000000 s'),
    (9, (V, 0.0, 0.0), 500.0, True, 'jumps back'),
    (12, (V, 0.0, 0.0), 500.0, True, 'has a gap from 0.100000000 s to 0.120000000 s'),
    (10.5, (V, 0.0, 0.0), 500.0, False, 'lies between the cycles of rate_hz')])
def test_faults_of_the_truth(t, v, height, restart, says):
    """They are told in one sentence; a dropped sample leaves the meter intact."""
    meter = pushed(VelocityMeter(meter_settings(window__cycles=20)), 10)
    with pytest.raises(StreamFault, match=says) as raised:
        meter.push_truth(round(t * DT_NS), v, height)
    assert raised.value.restart is restart and '\n' not in str(raised.value)
    if not restart:
        t_ns, v_b, heights = flight(20)
        fix, = meter.advance(t_ns[11:], v_b[11:], heights[11:])
        assert same([fix], pushed_fixes())


def pushed_fixes():
    """Return the fixes of the same flight without faults."""
    return VelocityMeter(meter_settings(window__cycles=20)).advance(*flight(20))


def test_jitter_and_repeats():
    """Stamps off by a tenth of a period, and a first sample that is repeated, change nothing."""
    meter = VelocityMeter(meter_settings(window__cycles=20))
    t_ns, v_b, height = flight(20)
    found = []
    for k, (t, v, h) in enumerate(zip(t_ns.tolist(), v_b.tolist(), height.tolist())):
        t += (k % 2) * DT_NS // 10
        found += meter.push_truth(t, v, h)
        if k == 0:
            assert meter.push_truth(t, v, h) == []
    assert same(found, pushed_fixes())


def test_faults_of_the_ins():
    """NaN is dropped, a repeat passed over; a jump back and a gap are none."""
    meter = VelocityMeter(meter_settings(attack_angle='ins', window__cycles=20))
    with pytest.raises(StreamFault, match='INS velocity at 0.010000000 s holds') as raised:
        meter.push_ins(DT_NS, (V, math.nan, 0.0))
    assert not raised.value.restart
    for k in (1, 1, 50):
        assert meter.push_ins(k * DT_NS, (V, 0.0, 0.0)) == []
    assert meter.push_ins(40 * DT_NS, (V, 0.0, 0.0)) == []
    # who does not ask the INS does not mind it
    deaf = VelocityMeter(meter_settings())
    assert [deaf.push_ins(k, (math.nan, 0.0, 0.0)) for k in (5, 3)] == [[], []]
