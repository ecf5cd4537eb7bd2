"""The parity test raises no alarm for healthy channels and detects faulty ones."""

import numpy as np
import pytest
from support.studies import settings

from ins_sim.core.motion.factory import make_motion
from ins_sim.core.sensors.tuned_gyro.instrument import PairInstrument
from ins_sim.core.sensors.tuned_gyro.parity import parity_rows, parity_windows, ParityTest
from ins_sim.settings.presets import preset
from ins_sim.core.timeseries.histories import ImuSamples
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.core.numerics.units import DEG_H

DTG = {'gyro.model': 'dtg', 'output': 'integrated', 'input': 'integrated'}
FAULT = {'gyro.dtg.fault.start_s': 10.0, 'gyro.dtg.fault.end_s': 20.0}
TABLE = {'motion.kind': 'static'}


def windows_of(values, duration_s=30.0):
    """Return the windows of a run."""
    s = settings({**DTG, **values}, source='motion', duration_s=duration_s)
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    imu = ImuSamples.concatenate(imu_blocks(s, motion))
    return parity_windows(s.imu_sensor, PairInstrument(s.imu_sensor), imu)


@pytest.mark.parametrize('motion', [
    TABLE, {'motion.kind': 'two_axis'}, {'motion.kind': 'rocking', 'motion.rocking.axis': 'x'},
    {'motion.kind': 'sinusoids'}, {'motion.kind': 'aggressive'}])
@pytest.mark.parametrize('arrangement', ['paper', 'turned'])
@pytest.mark.parametrize('errors', [{}, preset('tactical_dtg')], ids=['perfect', 'tactical'])
def test_healthy_channels_raise_no_alarm(motion, arrangement, errors):
    """
    There is no alarm at rest, turning, rocking, in flight, with or without errors.

    Each case is run with five seeds.
    """
    closest = 0.0
    for seed in range(5 if errors else 1):
        found = windows_of({**motion, **errors, 'seed': seed,
                            'gyro.dtg.arrangement': arrangement})
        assert len(found) == 30 and not found[:, 3].any()
        closest = max(closest, (np.abs(found[:, 1]) / found[:, 2]).max())
    print(f'\n{motion["motion.kind"]}, {arrangement}: at most {closest:.3f} of the threshold')


@pytest.mark.parametrize('arrangement, channel, seen', [
    ('paper', 'gyro_1_y', True), ('paper', 'gyro_2_z', True),
    ('paper', 'gyro_1_z', False), ('paper', 'gyro_2_y', False),
    *(('turned', c, True) for c in ('gyro_1_y', 'gyro_1_z', 'gyro_2_y', 'gyro_2_z'))])
def test_a_fault_is_seen_where_the_parity_can_see_it(arrangement, channel, seen):
    """A fault of 50 deg/h from 10 to 20 s is detected if and only if the parity depends on it."""
    found = windows_of({**TABLE, **preset('tactical_dtg'), **FAULT, 'seed': 2,
                        'gyro.dtg.arrangement': arrangement, 'gyro.dtg.fault.channel':
                            channel, 'gyro.dtg.fault.bias_deg_h': 50.0})
    inside = (found[:, 0] > 11.0) & (found[:, 0] < 20.0)
    print(f'\n{arrangement} {channel}: mean parity {found[inside, 1].mean() / DEG_H:.2f} deg/h, '
          f'threshold {found[inside, 2].mean() / DEG_H:.2f}')
    assert found[inside, 3].all() == seen
    assert not found[(found[:, 0] <= 10.0) | (found[:, 0] > 21.0), 3].any()


def test_a_dead_channel_is_seen_while_it_turns():
    """A channel stuck at zero is detected only while the gyro turns."""
    dead = {**FAULT, 'gyro.dtg.fault.channel': 'gyro_1_y', 'gyro.dtg.fault.scale': 0.0,
            **preset('tactical_dtg')}
    turning = windows_of({**dead, 'motion.kind': 'rocking', 'motion.rocking.axis': 'x',
                          'motion.rocking.frequency_hz': 0.05,
                          'motion.rocking.amplitude_deg': 30.0})
    assert turning[(turning[:, 0] > 11.0) & (turning[:, 0] < 14.0), 3].all()
    assert not windows_of({**dead, **TABLE, 'earth.rotation': False})[:, 3].any()


def test_a_fixed_threshold_and_window():
    """A threshold and a window set by the user are used as given."""
    values = {**TABLE, 'gyro.dtg.parity.threshold_deg_h': 2.0, 'gyro.dtg.parity.window_s': 0.5,
              **FAULT, 'gyro.dtg.fault.channel': 'gyro_1_y', 'gyro.dtg.fault.bias_deg_h': 2.9}
    found = windows_of(values)
    assert len(found) == 60 and np.allclose(found[:, 2], 2.0 * DEG_H)
    inside = (found[:, 0] > 10.0) & (found[:, 0] < 20.0)
    # 2.9/sqrt 2 deg/h exceeds 2 deg/h by 2.5 %.
    assert np.allclose(found[inside, 1], 2.9 * DEG_H / np.sqrt(2.0), rtol=1e-6)
    assert np.array_equal(found[:, 3] == 1.0, inside)


def test_before_the_first_window():
    """Before the first window there is no mean and no alarm, and again after a reset."""
    s = settings({**DTG, **TABLE}).imu_sensor
    test = ParityTest(s, PairInstrument(s))
    for _ in range(2):
        assert not test.exceeded and test.mean == 0.0 and test.threshold == np.inf
        for k in range(99):
            assert not test.push(k, (0.0, 0.0, 0.0), (0.0, 0.0, 9.8), 1.0)
        assert test.push(99, (0.0, 0.0, 0.0), (0.0, 0.0, 9.8), 1.0) and test.exceeded
        test.reset()


@pytest.mark.parametrize('count', [0, 1, 99, 100, 101, 1234])
def test_windows_of_a_run_are_those_of_its_readings(count):
    """Windows and rows computed from arrays equal those from single readings, bit for bit."""
    rng = np.random.default_rng(6)
    imu = ImuSamples((1 + np.arange(count)) * 10_000_000, rng.normal(size=(count, 3)),
                     rng.normal(size=(count, 3)), 1e-4 * rng.normal(size=count))
    s = settings({**DTG, **TABLE, **preset('tactical_dtg')}).imu_sensor
    instrument = PairInstrument(s)
    test, rows, windows = ParityTest(s, instrument), [], []
    for t_ns, *sample in zip(imu.t_ns.tolist(), imu.omega.tolist(), imu.f.tolist(),
                             imu.parity.tolist()):
        if test.push(t_ns, *sample):
            windows.append((t_ns * 1e-9, test.mean, test.threshold, test.exceeded))
        rows.append(test.row(sample[2]))
    assert np.array_equal(parity_rows(s, instrument, imu), np.reshape(rows, (-1, 3)))
    assert np.array_equal(parity_windows(s, instrument, imu), np.reshape(windows, (-1, 4)))
