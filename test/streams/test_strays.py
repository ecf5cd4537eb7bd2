"""Stray samples are distinguished from restarts, so that no stream waits for ever."""

from ins_sim.core.navigation.live import Navigator
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.streams.faults import MOST_PERIODS, StreamFault
from ins_sim.core.streams.grid import SampleGrid, STEADY
from ins_sim.core.streams.restarts import LastStamps
from ins_sim.core.earth.frames import MapFrame
from ins_sim.core.motion.factory import make_motion
import numpy as np
import pytest
from support import studies

DT = 10_000_000


def test_what_the_last_stamps_say():
    """The last two stamps distinguish a stray ahead, a stray of the past, and a jump."""
    stamps = LastStamps()
    assert not any(stamps.take(t) for t in (1, 2, 3, 1000))
    assert stamps.was_ahead(4) and not stamps.was_ahead(2) and not stamps.was_ahead(3)
    assert not stamps.take(4)
    assert not stamps.was_ahead(5) and not stamps.take(0)
    assert not stamps.was_of_the_past(1) and stamps.was_of_the_past(5)
    assert stamps.take(5) and not stamps.take(6)
    # A restart: the following stamps belong to the new run.
    assert not any(stamps.take(t) for t in (0, 1, 2))
    assert not stamps.was_of_the_past(3)


def samples(count):
    """Return [(t, omega, f)] and [(t, r, q, v)] of a motion."""
    s = studies.settings(studies.MOTION_2).motion_generator
    truth = make_motion(s.motion, s.datum, s.earth).at(np.arange(count) * DT)
    poses = MapFrame(s.datum, True).pose(truth.lat, truth.lon, truth.height, truth.v_n, truth.q_nb)
    stamps = truth.t_ns.tolist()
    return ([(t, tuple(w), tuple(f)) for t, w, f in zip(stamps, truth.omega_ib_b.tolist(),
                                                        truth.f_ib_b.tolist())],
            [(t, *map(tuple, pose)) for t, pose in zip(stamps, zip(*(p.tolist() for p in poses)))])


@pytest.mark.parametrize('lead', [0, 3], ids=['with the truth', 'truth ahead'])
@pytest.mark.parametrize('stray', ['push_imu', 'push_truth'])
@pytest.mark.parametrize('shift', [100, -100, 1, -1], ids='{:+d}'.format)
def test_one_stray_costs_a_few_samples(stray, shift, lead):
    """A stray in either stream, ahead or of the past, costs at most 10 samples."""
    imu, truth = samples(400)
    navigator, outputs, faults = Navigator(studies.settings(studies.MOTION_2).strapdown), [], []

    def push(name, sample):
        try:
            outputs.extend(getattr(navigator, name)(*sample))
        except StreamFault as fault:
            faults.append(str(fault))
            if fault.restart:
                navigator.reset()
                outputs.extend(getattr(navigator, name)(*sample))

    for k in range(lead):
        push('push_truth', truth[k])
    for k in range(300):
        push('push_truth', truth[k + lead])
        push('push_imu', imu[k])
        if k == 200:
            of = {'push_imu': imu[k], 'push_truth': truth[k + lead]}[stray]
            # Not at the instant of another sample.
            push(stray, (of[0] + shift * DT + DT // 2, *of[1:]))
    solved = [t // DT for t, *_ in outputs]
    assert solved[-89:] == list(range(211, 300)) and solved[:200] == list(range(200))
    assert not navigator.parted


def push_all(imu, stamps):
    """Return the readings of an IMU at rest at these stamps, and its faults."""
    readings, faults = [], []
    for t_ns in stamps:
        sample = (t_ns, (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 9.8))
        try:
            readings += imu.push(*sample)
        except StreamFault as fault:
            faults.append(str(fault))
            imu.reset()
            readings += imu.push(*sample)
    return readings, faults


@pytest.mark.parametrize('source', ['stream', 'motion'])
def test_no_push_computes_more_than_a_bounded_number_of_readings(source):
    """Two strays far apart in time, at the start or later, are refused as a gap by rate_hz."""
    s = studies.settings(studies.MOTION_2, source=source)
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    far = [1_000_000 * 10**9, 1_020_000 * 10**9]
    for stamps in (far, [0, DT, *far, 2 * DT, 3 * DT]):
        readings, faults = push_all(make_imu(s.imu_sensor, motion), stamps)
        assert len(readings) == len(stamps)
        assert any(f'{MOST_PERIODS} periods of rate_hz at most' in fault for fault in faults)
    readings, faults = push_all(make_imu(s.imu_sensor, motion), [0, MOST_PERIODS * DT])
    assert not faults and len(readings) == MOST_PERIODS + 1
    *_, faults = push_all(make_imu(s.imu_sensor, motion), [0, (MOST_PERIODS + 1) * DT])
    assert faults == ['truth steps from 0.000000000 s to 10.010000000 s; expected '
                      f'{"1e-05" if source == "stream" else "0"} to 10 s, 1000 periods of rate_hz '
                      'at most']


def test_a_grid_of_a_stray_is_left():
    """A steady stream between the instants of readings is reported; jitter, other rates not."""
    def check(stamps, reading_ns, dt_ns=DT):
        grid = SampleGrid(dt_ns)
        for t_ns in stamps:
            grid.check(t_ns, reading_ns)

    steady = [k * DT for k in range(5, 100)]
    check(steady, 5 * DT)
    check(steady, None)
    # A reading may be of the past, or late because of negative delays.
    check(steady, 2 * DT)
    with pytest.raises(StreamFault, match='is 0.009999999 s off the instants') as raised:
        check(steady, 5 * DT + 1)
    assert raised.value.restart
    # At twice and half the rate every second sample, or reading, is on the grid.
    check([k * DT // 2 for k in range(5, 100)], 5 * DT)
    check([k * 2 * DT for k in range(5, 100)], 5 * DT)
    # With jitter no ten steps are equal, and at 70 Hz samples need not be on the grid.
    check([t + k % 7 for k, t in enumerate(steady)], 5 * DT + 1)
    check([k * 14_285_714 for k in range(100)], 5 * DT + 1)
    check(steady[:STEADY], 5 * DT + 1)
