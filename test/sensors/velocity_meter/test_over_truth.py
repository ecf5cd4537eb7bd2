"""The velocity meter on records of the truth, with the angle of attack from an INS."""

from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
from ins_sim.core.sensors.velocity_meter.over_truth import MeterOnTruth
from ins_sim.core.timeseries.histories import Truth
import numpy as np
import pytest
from support.meter_studies import meter_settings, same

COUNT = 4097


def record(rate_hz):
    """Return the Truth of a level flight to the east."""
    t_ns = np.arange(COUNT) * round(1e9 / rate_hz)
    still, level = np.zeros(COUNT), np.tile((0.0, 0.0, 0.0, 1.0), (COUNT, 1))
    v_n = np.column_stack((200.0 + np.sin(1e-9 * t_ns), still, still + 0.5))
    return Truth(t_ns, still + 0.9, still + 0.6, still + 500.0, v_n, level, np.zeros((COUNT, 3)),
                 np.zeros((COUNT, 3)))


@pytest.mark.parametrize('rate_hz', (100.0, 10.0))
def test_long_blocks_leave_no_window_without_the_ins(rate_hz):
    """
    At 10 Hz a block of 4096 samples exceeds the wait for the INS, yet no window lacks its angle.

    Cuts between blocks change no bit, even if they separate INS samples from the truth 3 ms later.
    """
    settings, truth = meter_settings(attack_angle='ins', rate_hz=rate_hz), record(rate_hz)
    ins_ns, ins_v = truth.t_ns - 3_000_000, truth.v_n + 0.1
    found = []
    for cuts in ((), (100, 1717)):
        meter = MeterOnTruth(VelocityMeter(settings))
        meter.follow_ins(ins_ns, ins_v)
        edges = (0, *cuts, COUNT)
        found.append([fix for a, b in zip(edges, edges[1:]) for fix in meter.advance(truth[a:b])])
    assert len(found[0]) == 4096 // settings.window.cycles
    assert all(fix.valid for fix in found[0])
    assert same(*found)
