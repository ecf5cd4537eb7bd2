"""The streams of IMU and truth give the same solution and faults, whichever is ahead."""

from functools import lru_cache

from hypothesis import example, given, settings, strategies as st
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.navigation.live import Navigator
import numpy as np
import pytest
from support import studies

DT = 10_000_000
# Indices missing from the 40 IMU samples of the first run; the second run has 20 samples.
LOST = (7, 8, 20, 38)
GAPS = [f'imu has a gap from {a / 100:.9f} s to {b / 100:.9f} s; expected steps of 0.01 s'
        for a, b in ((6, 9), (19, 21), (37, 39))]
BACK = 'imu jumps back from 0.390000000 s to 0.000000000 s; expected rising stamps'


@lru_cache(maxsize=None)
def streams():
    """Return [(push, arguments)] for 40 samples of the IMU and of the truth."""
    s = studies.settings(studies.MOTION_2).motion_generator
    truth = make_motion(s.motion, s.datum, s.earth).at(np.arange(40) * DT)
    poses = MapFrame(s.datum, True).pose(truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)

    def rows(push, *arrays):
        return [(push, (t, *map(tuple, row))) for t, *row in zip(
            truth.t_ns.tolist(), *(a.tolist() for a in arrays))]

    return (rows('push_imu', truth.omega_ib_b, truth.f_ib_b), rows('push_truth', *poses))


def run(order, imu, truth):
    """Push as a node does, the IMU if order is True; return outputs and faults."""
    navigator, outputs, faults = Navigator(studies.settings(studies.MOTION_2).strapdown), [], []
    left = {True: list(imu), False: list(truth)}
    for of_imu in (*order, *(True,) * len(imu), *(False,) * len(truth)):
        if not left[of_imu]:
            continue
        push, arguments = left[of_imu].pop(0)
        try:
            outputs += getattr(navigator, push)(*arguments)
        except StreamFault as fault:
            faults.append(str(fault))
            navigator.reset()
            outputs += getattr(navigator, push)(*arguments)
        faults += map(str, navigator.faults)
        navigator.faults.clear()
    assert not navigator.waiting
    return outputs, faults


def with_gaps():
    """Return the streams without the samples LOST."""
    imu, truth = streams()
    return [e for k, e in enumerate(imu) if k not in LOST], truth


ORDER = st.lists(st.booleans(), min_size=80, max_size=80)


@settings(max_examples=50, deadline=None)
@given(order=ORDER)
@example(order=[True] * 80)
@example(order=[False] * 80)
def test_gaps_are_where_they_are(order):
    """Samples that wait for truth before a gap are still solved, and each gap is reported."""
    imu, truth = with_gaps()
    expected, faults = run([False] * 80, imu, truth)
    assert [o[0] // DT for o in expected] == [k for k in range(40) if k not in LOST]
    assert faults == GAPS
    assert run(order, imu, truth) == (expected, GAPS)


@settings(max_examples=100, deadline=None)
@given(order=ORDER)
@example(order=[True] * 80)
@example(order=[False] * 80)
def test_a_run_after_a_jump_back_is_whole(order):
    """
    After a jump back the new run is complete, in any order of the streams.

    Of the earlier run the solution extends as far as its truth. Both streams have begun the first
    run before one of them ends it.
    """
    imu, truth = with_gaps()
    start = [True, False] * 2
    whole, _ = run([False] * 80, imu, truth)
    second, _ = run([False] * 80, *(s[:20] for s in streams()))
    outputs, faults = run([*start, *order], *(a + b[:20] for a, b in zip((imu, truth), streams())))
    assert outputs[-20:] == second
    assert outputs[:-20] == whole[:len(outputs) - 20]
    assert faults[-1] == BACK and faults[:-1] == GAPS[:len(faults) - 1]


def test_truth_that_does_not_follow_a_jump_back():
    """If the truth does not jump back as well, samples wait until the streams agree again."""
    imu, truth = streams()
    navigator = Navigator(studies.settings(studies.MOTION_2).strapdown)
    for (_, sample), (_, pose) in zip(imu[:30], truth[:30]):
        navigator.push_truth(*pose)
        navigator.push_imu(*sample)
    with pytest.raises(StreamFault, match='jumps back'):
        navigator.push_imu(*imu[20][1])
    navigator.reset()
    for k in range(20, 30):
        assert navigator.push_imu(*imu[k][1]) == []
    for k in range(30, 35):
        assert navigator.push_truth(*truth[k][1]) == []
    assert navigator.waiting
    navigator.rejoin()
    for k in range(35, 40):
        assert navigator.push_imu(*imu[k][1]) == []
        (t_ns, _, _, _), = navigator.push_truth(*truth[k][1])
        assert t_ns == k * DT
