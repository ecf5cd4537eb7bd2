"""The velocity meter outside its limits, and with bad streams of truth and INS."""

import math
import warnings

from support.meter_studies import DT_NS, flight, meter_settings, same
import numpy as np
import pytest

from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.sensors.velocity_meter.ins_means import NO_ANGLE, NO_INS, WAIT_NS
from ins_sim.core.sensors.velocity_meter.meter import CALM, VelocityMeter

V = 200.0
MODES = ('signal', 'surrogate')


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
    """A window outside the limits gives NaN and its reason; other windows are unaffected."""
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
    """Windows that overlap a scheduled drop-out are invalid; windows are (0, 0.1], (0.1, 0.2]."""
    s = meter_settings({'window.cycles': 10, 'drop_outs.start_s': [start, 20.0],
                        'drop_outs.end_s': [end, 30.0]})
    fixes = VelocityMeter(s).advance(*flight(40))
    assert [m for m, fix in enumerate(fixes, 1) if fix.status == CALM] == lost


def test_standing_still():
    """An hour on the ground gives invalid fixes, without exception or warning."""
    for mode in MODES:
        meter = VelocityMeter(meter_settings(mode=mode, attack_angle='ins', window__cycles=100))
        t_ns, v_b, height = flight(1000, (0.0, 0.0, 0.0))
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            fixes = meter.advance(t_ns, v_b, height, v_b)
        assert len(fixes) == 10 and not any(fix.valid for fix in fixes)


def test_without_an_ins():
    """Windows wait for the INS, in order, at most WAIT_NS; then their fixes are invalid."""
    s = meter_settings(attack_angle='ins', window__cycles=100)
    meter, seconds = VelocityMeter(s), WAIT_NS // 1_000_000_000
    fixes = meter.advance(*flight(100 * (seconds + 2)))
    assert [(fix.end_ns, fix.status) for fix in fixes] == \
        [(m * 100 * DT_NS, NO_INS) for m in (1, 2)]
    # The INS arrives late: windows that it did not see are invalid; later ones do not wait.
    fixes = meter.push_ins(100 * (seconds + 2) * DT_NS, (V, 0.0, 0.0))
    assert [fix.status for fix in fixes] == [NO_INS] * (seconds - 1) + ['valid']


@pytest.mark.parametrize('v', [(0.0, 0.0, 0.0), (-200.0, 0.0, 1.0), (10.0, 0.0, 11.0)])
def test_an_ins_that_gives_no_angle(v):
    """A fix is invalid, with the reason, if the INS velocity gives no angle of attack."""
    s = meter_settings(attack_angle='ins', window__cycles=10)
    t_ns, v_b, height = flight(10)
    fix, = VelocityMeter(s).advance(t_ns, v_b, height, np.tile(v, (11, 1)))
    assert fix.status == NO_ANGLE and fix.tan_alpha == 0.0


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
    """A fault of the truth raises one message; a dropped sample does not change the meter."""
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
    """Stamps off by a tenth of a period and a repeated first sample change nothing."""
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
    """NaN from the INS is dropped and a repeat ignored; a jump back or gap raises no fault."""
    meter = VelocityMeter(meter_settings(attack_angle='ins', window__cycles=20))
    with pytest.raises(StreamFault, match='INS velocity at 0.010000000 s holds') as raised:
        meter.push_ins(DT_NS, (V, math.nan, 0.0))
    assert not raised.value.restart
    for k in (1, 1, 50):
        assert meter.push_ins(k * DT_NS, (V, 0.0, 0.0)) == []
    assert meter.push_ins(40 * DT_NS, (V, 0.0, 0.0)) == []
    # If the meter does not use the INS, its faults do not matter.
    deaf = VelocityMeter(meter_settings())
    assert [deaf.push_ins(k, (math.nan, 0.0, 0.0)) for k in (5, 3)] == [[], []]
