"""The velocity meter as a sensor: windows, streams, angle of attack, invalid fixes."""

import math

from hypothesis import example, given, settings as hypothesis_settings, strategies as st
from support.meter_studies import body, DT_NS, flight, meter_settings, PERFECT, same
import numpy as np
import pytest
from scipy.stats import chi2

from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.core.sensors.velocity_meter.surrogate import velocity_sigmas

V = 200.0
MODES = ('signal', 'surrogate')


def wavy(cycles, first=0):
    """Return t_ns, v_b, height of a flight with acceleration, sideslip and climb."""
    t_ns, v_b, height = flight(cycles, first=first)
    s = t_ns * 1e-9
    v_b[:, 0], v_b[:, 1], v_b[:, 2] = V + 3.0 * s, 4.0 * np.sin(s), -5.0 + np.cos(2.0 * s)
    return t_ns, v_b, height


def test_windows():
    """Window m is ((m - 1) N dt, m N dt], with its stamps, arrival and mean velocity."""
    s = meter_settings({**PERFECT, 'window.cycles': 7, 'window.latency_ms': 12.5})
    t_ns, v_b, height = wavy(30)
    fixes = VelocityMeter(s).advance(t_ns, v_b, height)
    assert [(fix.start_ns, fix.end_ns) for fix in fixes] == \
        [(7 * m * DT_NS, 7 * (m + 1) * DT_NS) for m in range(4)]
    for m, fix in enumerate(fixes):
        part = v_b[7 * m:7 * m + 8]
        mean = np.trapezoid(part, axis=0) if hasattr(np, 'trapezoid') else np.trapz(part, axis=0)
        assert fix.valid and fix.cycles == 7 and fix.arrival_ns == fix.end_ns + 12_500_000
        # Without an angle of attack both velocities read large by 1/cos(alpha)^2.
        scale = 1.0 + (mean[2] / mean[0]) ** 2
        assert fix.velocity == pytest.approx(tuple(scale * mean[:2] / 7), rel=1e-12)
        assert fix.sigma == (1e-3, 1e-3) and fix.tan_alpha == 0.0


@pytest.mark.parametrize('first, windows', [(0, 3), (1, 2), (9, 2), (10, 2), (11, 1), (-10, 3),
                                            (-3, 3), (20, 1), (21, 0)])
def test_a_window_that_was_not_seen_from_its_start_is_not_reported(first, windows):
    """A window that began before the first sample, or before time zero, is not reported."""
    meter = VelocityMeter(meter_settings(window__cycles=10))
    fixes = meter.advance(*flight(30 - first, first=first))
    assert [fix.end_ns // DT_NS for fix in fixes] == [10, 20, 30][3 - windows:]


@pytest.mark.parametrize('mode', MODES)
@pytest.mark.parametrize('attack', ['ins', 'none'])
def test_numbers_do_not_depend_on_when_the_stream_is_joined(mode, attack):
    """Window 5 has the same bits from time 0, from its own start, and after a reset."""
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
    """Blocks, single pushes, and an INS ahead or behind give the same bits."""
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
    After truth or INS has jumped back, windows of the new run have only its own angles.

    Both streams have begun the first run before one of them ends it.
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
    """The same seed and run give the same numbers; others give different ones."""
    def velocities(**terms):
        s = meter_settings(mode=mode, window__cycles=10, **terms)
        return [fix.velocity for fix in VelocityMeter(s).advance(*flight(20))]

    assert velocities() == velocities() != velocities(seed=1)
    assert velocities(run=1) == velocities(run=1) != velocities()
    assert len(set(velocities())) == 2


def test_the_angle_of_attack_of_the_ins():
    """tan(alpha) is -mean(V_y1)/mean(V_x1) of the INS; it recovers the body velocity."""
    s = meter_settings({**PERFECT, 'attack_angle': 'ins', 'window.cycles': 10})
    v = body(V, 0.05, 0.08)
    t_ns, v_b, height = flight(10, v)
    ins = v_b.copy()
    ins[1:, 2] *= np.linspace(0.5, 1.5, 10)
    fix, = VelocityMeter(s).advance(t_ns, v_b, height, ins)
    assert fix.tan_alpha == pytest.approx(math.tan(0.08), rel=1e-12)
    assert fix.velocity == pytest.approx(v[:2], rel=1e-12) and fix.up == pytest.approx(v[2])
    # One INS sample in the window is enough; the one at its start is not inside.
    meter = VelocityMeter(s)
    assert meter.advance(t_ns, v_b, height) == []
    assert meter.push_ins(0, (V, 0.0, -50.0)) == []
    assert meter.push_ins(5 * DT_NS, (V, 0.0, -20.0)) == []
    fix, = meter.push_ins(12 * DT_NS, (V, 0.0, 0.0))
    assert fix.tan_alpha == pytest.approx(0.1) and fix.valid


def test_the_surrogate_has_its_errors():
    """
    Mode surrogate has its bias, scales and variances (chi-square at 1e-6).

    The flight has sideslip, and windows have 4 cycles.
    """
    beta, n = 0.1, 3000
    s = meter_settings(window__cycles=4, surrogate__k_x=0.01, surrogate__k_z=-0.02,
                       beam__sigma_theta_z_rad=0.11)
    v = body(V, beta)
    fixes = VelocityMeter(s).advance(*flight(4 * n, v))
    sigma = velocity_sigmas(s.surrogate, 4, beta)
    assert sigma == pytest.approx((4.0 * math.sqrt(1.36), math.hypot(8.7, 16.0) / 2.0))
    mean = 1.01 * v[0] - 4.0, 0.98 * 1.21 * v[1]
    for k in (0, 1):
        z = (np.array([fix.velocity[k] for fix in fixes]) - mean[k]) / sigma[k]
        assert abs(z.sum()) < 5.0 * math.sqrt(n)
        assert chi2.ppf(1e-6, n) < (z ** 2).sum() < chi2.isf(1e-6, n)
        assert abs((z[1:] * z[:-1]).sum()) < 5.0 * math.sqrt(n)
