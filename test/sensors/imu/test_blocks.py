"""Blocks of streamed truth give the same readings and faults as single pushes, bit for bit."""

from dataclasses import replace

import numpy as np
import pytest
from support.studies import MOTION_2, settings

from ins_sim.core.motion.factory import make_motion
from ins_sim.core.numerics.instants import period_ns
from ins_sim.core.sensors.imu.stream import make_imu
from ins_sim.core.streams.faults import StreamFault

LATE = {**MOTION_2, 'source': 'stream', 'gyro.delay_us.x': 2.5, 'gyro.delay_us.z': -1.0,
        'accelerometer.delay_us.y': 700.0}
NOISY = {'gyro.errors.angle_random_walk_deg_sqrt_h': [0.01] * 3,
         'gyro.errors.bandwidth_hz': [30.0] * 3,
         'accelerometer.errors.quantisation_mm_s': [0.01] * 3}
TUNED = {'gyro.model': 'dtg', 'output': 'integrated', 'input': 'integrated'}
KINDS = {'rotations': {}, 'integrals': {'output': 'integrated'}, 'frozen': {'history': 'frozen'},
         'looking far back': {'gyro.delay_us.x': 40000.0, 'accelerometer.delay_us.x': 15000.0},
         'looking back beyond the line': {'gyro.delay_us.y': 120000.0,
                                          'accelerometer.delay_us.z': 90000.0},
         'looking ahead': {'gyro.delay_us.x': -30000.0}, 'noisy': NOISY, 'tuned': TUNED,
         'on the motion': {'source': 'motion'}}


def sensor_and_truth(values, truth_rate=100.0, count=400, jitter_ns=0, first_ns=0):
    """Return a function that makes the IMU of settings, and a Truth record."""
    s = settings({**LATE, **values})
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    t_ns = first_ns + period_ns(truth_rate) * np.arange(count, dtype=np.int64)
    t_ns += np.random.default_rng(2).integers(-jitter_ns, jitter_ns + 1, count)
    return lambda: make_imu(s.imu_sensor, motion), motion.at(t_ns)


def pushed(imu, truth):
    """Return the readings of single pushes, and the fault that ended them, with its index."""
    readings = []
    for k, sample in enumerate(imu.samples(truth)):
        try:
            readings += imu.push(*sample)
        except StreamFault as fault:
            return readings, k, fault
    return readings, None, None


def as_list(samples):
    """Return ImuSamples in the form of the readings of ``push``, with lists as vectors."""
    parity = [None] * len(samples) if samples.parity is None else samples.parity.tolist()
    return list(zip(samples.t_ns.tolist(), samples.omega.tolist(), samples.f.tolist(), parity))


def listed(readings):
    """Return the readings of ``push`` with lists instead of tuples."""
    return [(t, list(omega), list(f), parity) for t, omega, f, parity in readings]


def in_cuts(imu, truth, rng):
    """Return the readings from blocks of random length mixed with single samples and pushes."""
    readings, start = [], 0
    while start < len(truth):
        end = start + int(rng.choice([1, 2, 5, 40, 150]))
        if rng.random() < 0.2:
            readings += listed(pushed(imu, truth[start:end])[0])
        else:
            readings += as_list(imu.advance(truth[start:end]))
        start = end
    return readings


@pytest.mark.parametrize('truth_rate', [50.0, 100.0, 270.0, 1000.0])
@pytest.mark.parametrize('kind', KINDS)
def test_any_cutting_gives_the_readings_of_single_pushes(kind, truth_rate):
    """Any cutting gives the bits of single pushes, at any truth rate and with jitter."""
    make, truth = sensor_and_truth(KINDS[kind], truth_rate, jitter_ns=3000, first_ns=7_000_000)
    expected = listed(pushed(make(), truth)[0])
    assert len(expected) > 20
    rng = np.random.default_rng(4)
    for _ in range(3):
        assert in_cuts(make(), truth, rng) == expected
    imu = make()
    for _ in range(2):
        assert as_list(imu.advance(truth)) == expected
        imu.reset()


def spoilt(truth, k, what):
    """Return a Truth record whose sample k is invalid."""
    arrays = {name: values.copy() for name, values in truth.arrays().items()}
    if what == 'repeat':
        arrays['t_ns'][k] = arrays['t_ns'][k - 1]
    elif what == 'jump back':
        arrays['t_ns'][k:] -= period_ns(100.0) * 3
    elif what == 'gap':
        arrays['t_ns'][k:] += period_ns(100.0)
    elif what == 'norm':
        arrays['q_nb'][k] *= 1.1
    elif what == 'turn':
        arrays['omega_ib_b'][k] = 300.0
    else:
        arrays['f_ib_b'][k, 1] = {'nan': np.nan, 'infinite': np.inf, 'huge': 1e200}[what]
    return replace(truth, **arrays)


@pytest.mark.parametrize('kind', ['rotations', 'integrals', 'noisy', 'tuned', 'on the motion'])
@pytest.mark.parametrize('what', ['nan', 'infinite', 'huge', 'repeat', 'jump back', 'gap', 'norm',
                                  'turn'])
def test_a_fault_is_that_of_single_pushes(kind, what):
    """A bad sample raises the same fault as in single pushes; earlier readings are returned."""
    make, truth = sensor_and_truth(KINDS[kind], count=60)
    for k in (1, 2, 3, 30, 59):
        bad = spoilt(truth, k, what)
        readings, index, fault = pushed(make(), bad)
        imu = make()
        if fault is None:
            assert as_list(imu.advance(bad)) == listed(readings)
            continue
        with pytest.raises(StreamFault) as raised:
            imu.advance(bad)
        assert (str(raised.value), raised.value.restart) == (str(fault), fault.restart)
        assert raised.value.index == index
        assert as_list(raised.value.readings) == listed(readings)
        if not fault.restart:
            # The sample was dropped; the stream continues with a good one in its place.
            single = make()
            pushed(single, bad[:k + 1])
            assert as_list(imu.advance(truth[k:])) == listed(pushed(single, truth[k:])[0])


def test_rotors_that_run_away_lose_no_reading():
    """If the rotors diverge the fault comes with all readings before it."""
    unstable = {**TUNED, 'gyro.dtg.preset': 'sapegin_2016', 'gyro.dtg.on_unstable': 'warn'}
    with pytest.warns(UserWarning, match='unstable'):
        make, truth = sensor_and_truth(unstable, count=100)
        imu, single = make(), make()
    for one in (imu, single):
        pair = one.pair.pair

        def settle(w, pair=pair):
            # The nutation grows by exp(0.0745) per sample: it overflows after 62 samples.
            pair.state = ((1e306, 0.0, 1e306, 0.0),) * 2

        pair.settle = settle
    readings, index, fault = pushed(single, truth)
    with pytest.raises(StreamFault, match='the rotors of the gyros have diverged') as raised:
        imu.advance(truth)
    assert str(raised.value) == str(fault) and raised.value.index == index and 1 < index < 99
    assert as_list(raised.value.readings) == listed(readings)
