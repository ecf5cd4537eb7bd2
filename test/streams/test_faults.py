"""Bad samples in streams are reported with one message, and no solution integrates over them."""

import math
import pickle

import numpy as np
import pytest
from support.studies import MOTION_2, settings

from ins_sim.core.numerics.instants import seconds
from ins_sim.core.streams.faults import StreamFault
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.navigation.live import Navigator

DT = period_ns(100.0)


@pytest.fixture
def truth():
    """Return a function of k: arguments of ``push`` and of ``push_truth`` for sample k."""
    s = settings(MOTION_2).motion_generator
    motion, frame = make_motion(s.motion, s.datum, s.earth), MapFrame(s.datum, True)

    def sample(k, dt=DT):
        one = motion.at(np.array([k * dt]))
        r_m, q_mb, v_b = frame.pose(one.lat, one.lon, one.height, one.v_n, one.q_nb)
        q = tuple(q_mb[0].tolist())
        return ((k * dt, q, tuple(one.omega_ib_b[0].tolist()), tuple(one.f_ib_b[0].tolist())),
                (k * dt, tuple(r_m[0].tolist()), q, tuple(v_b[0].tolist())))

    return sample


@pytest.fixture(params=['stream', 'motion'])
def imu(request):
    """Return the IMU on the stream or on the closed form."""
    return imu_of(settings(MOTION_2, source=request.param))


def imu_of(chosen):
    """Return the IMU of SimulationSettings."""
    generator = chosen.motion_generator
    return make_imu(chosen.imu_sensor,
                    make_motion(generator.motion, generator.datum, generator.earth))


def refused(push, sample, sentence, restart):
    """Check that a push is refused with one message."""
    with pytest.raises(StreamFault) as fault:
        push(*sample)
    assert sentence in str(fault.value) and '\n' not in str(fault.value)
    assert fault.value.restart is restart


def test_first_sample_may_be_repeated(imu, truth):
    """A repeated first sample, as lock-step sends it, is answered the same each time."""
    first = imu.push(*truth(0)[0])
    assert [r[0] for r in first] == [0]
    assert imu.push(*truth(0)[0]) == first
    assert [r[0] for r in imu.push(*truth(1)[0])] == [DT]


def test_nan_is_dropped(imu, truth):
    """A sample with NaN is refused, and the stage continues with the next."""
    imu.push(*truth(0)[0])
    t, q, w, f = truth(1)[0]
    for bad in ((t, q, (math.nan, 0.0, 0.0), f), (t, q, w, (0.0, math.inf, 0.0))):
        refused(imu.push, bad, 'expected finite numbers', False)
    assert len(imu.push(*truth(1)[0])) == 1


def test_stream_refuses_gaps_jumps_rates_and_norms(truth):
    """A gap, backwards stamp or other rate needs a restart; a repeat or wrong norm is dropped."""
    imu = make_imu(settings(MOTION_2, source='stream').imu_sensor)
    for k in range(3):
        imu.push(*truth(k)[0])
    t, q, w, f = truth(3)[0]
    refused(imu.push, truth(2)[0], 'repeats the stamp 0.020000000 s', False)
    refused(imu.push, (t, tuple(2 * x for x in q), w, f), 'orientation of norm 2', False)
    refused(imu.push, truth(9)[0], 'has a gap from 0.020000000 s to 0.090000000 s', True)
    refused(imu.push, truth(1)[0], 'jumps back from 0.020000000 s to 0.010000000 s', True)
    refused(imu.push, truth(21, DT // 10)[0], 'comes at another rate', True)
    assert len(imu.push(*truth(3)[0])) == 1
    imu.reset()
    assert [r[0] for r in imu.push(*truth(9)[0])] == [9 * DT]


def test_motion_source_refuses_a_jump_back(truth):
    """With source motion stamps must increase; a jump back is refused."""
    imu = imu_of(settings(MOTION_2))
    imu.push(*truth(0)[0])
    imu.push(*truth(5)[0])
    refused(imu.push, truth(1)[0], 'jumps back', True)


def test_truth_that_turns_too_far_is_refused(truth):
    """Truth that rotates too far between two samples is refused: the attitude is ambiguous."""
    imu = make_imu(settings(MOTION_2, source='stream').imu_sensor)
    t, q, w, f = truth(0)[0]
    imu.push(t, q, w, f)
    refused(imu.push, (DT, q, (300.0, 0.0, 0.0), f), 'turns 3 rad in one step', True)


@pytest.fixture
def navigator(truth):
    """Return a navigator that has processed samples 0 to 2."""
    navigator = Navigator(settings(MOTION_2).strapdown)
    for k in range(3):
        navigator.push_truth(*truth(k)[1])
        assert len(navigator.push_imu(k * DT, *truth(k)[0][2:])) == 1
    return navigator


def test_navigator_refuses_bad_imu_samples(navigator, truth):
    """IMU samples with NaN or repeats are dropped; gaps, jumps and other rates need a restart."""
    w, f = truth(3)[0][2:]
    refused(navigator.push_imu, (3 * DT, (math.nan, 0.0, 0.0), f), 'imu at 0.030000000 s', False)
    refused(navigator.push_imu, (2 * DT, w, f), 'imu repeats the stamp', False)
    refused(navigator.push_imu, (9 * DT, w, f), 'imu has a gap', True)
    refused(navigator.push_imu, (2 * DT + DT // 10, w, f), 'another rate; expected'[:12], True)
    navigator.push_truth(*truth(3)[1])
    assert len(navigator.push_imu(3 * DT, w, f)) == 1
    refused(navigator.push_imu, (DT, w, f), 'imu jumps back', True)


def test_navigator_refuses_bad_truth(navigator, truth):
    """Truth with NaN or wrong norm is dropped; other stamps than the IMU's are reported."""
    t, r, q, v = truth(3)[1]
    refused(navigator.push_truth, (t, (math.nan, 0.0, 0.0), q, v), 'expected finite', False)
    refused(navigator.push_truth, (t, r, (0.0, 0.0, 0.0, 0.5), v), 'norm 0.5', False)
    navigator.push_imu(3 * DT, *truth(3)[0][2:])
    assert navigator.waiting
    assert not navigator.push_truth(t + 1000, r, q, v) and not navigator.waiting
    fault, = navigator.faults
    assert 'has no truth of the same stamp, the nearest is 0.030001000 s' in str(fault)
    assert not navigator.navigates


def test_a_lost_truth_is_told_from_another_rate(navigator, truth):
    """A lost truth sample is reported as overload, readings between samples as another rate."""
    for k in (4, 5):
        navigator.push_truth(*truth(k)[1])
    navigator.push_imu(3 * DT, *truth(3)[0][2:])
    assert 'that truth sample was lost, probably because a node cannot keep up and a queue ' \
           'overflowed: expected a lower rate_hz' in str(navigator.faults.pop())
    navigator.reset()
    navigator.push_imu(4 * DT, *truth(4)[0][2:])
    navigator.push_imu(5 * DT - DT // 8, *truth(5)[0][2:])
    assert 'expected a truth rate that is a multiple of the IMU rate, both from the same start: ' \
           'rate_hz must be consistent in all nodes' in str(navigator.faults.pop())


def test_another_rate_names_rate_hz(navigator, truth):
    """The message for an IMU at twice the rate names rate_hz."""
    refused(navigator.push_imu, (2 * DT + DT // 2, *truth(3)[0][2:]),
            'expected steps of 0.01 s: rate_hz must be the same in the node that sends it', True)


def test_navigator_starts_anew_after_a_jump_back(navigator, truth):
    """After a jump back and a reset the same samples give the same output."""
    navigator.reset()
    w, f = truth(0)[0][2:]
    navigator.push_truth(*truth(0)[1])
    (t_ns, solution, errors, _), = navigator.push_imu(0, w, f)
    assert t_ns == 0
    fresh = Navigator(settings(MOTION_2).strapdown)
    fresh.push_truth(*truth(0)[1])
    assert fresh.push_imu(0, w, f) == [(t_ns, solution, errors, None)]
    assert fresh.push_imu(0, w, f) == [(t_ns, solution, errors, None)]


def test_seconds_are_exact_text():
    """``seconds`` prints every nanosecond and the sign."""
    assert seconds(1) == '0.000000001 s'
    assert seconds(-1_500_000_000) == '-1.500000000 s'
    assert seconds(1_700_000_000_123_456_789) == '1700000000.123456789 s'


def test_a_fault_crosses_from_process_to_process():
    """A StreamFault keeps message and restart when pickled, as between processes."""
    for restart in (False, True):
        fault = pickle.loads(pickle.dumps(StreamFault('what happened', restart)))
        assert (str(fault), fault.restart) == ('what happened', restart)
