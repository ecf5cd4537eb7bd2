"""Latency, jitter and drop-outs in a complete run, and the choice of attitude algorithm."""

import numpy as np
import pytest
from support.studies import MOTION_2, run_offline, settings

from ins_sim.io.motion import read_motion
from ins_sim.studies.orientation import compare_orientations
from ins_sim.core.navigation.sample_clock import SampleClock

DISTURBED = {**MOTION_2, 'sampling.latency_us': 1500.0, 'sampling.jitter_us': 900.0, 'seed': 5}
NOMINAL = {'imu_time': 'nominal', 'imu_latency_us': 1500.0}


def test_nominal_instants_undo_latency_and_jitter():
    """With imu_time nominal the solution has the bits of perfect stamps; only stamps differ."""
    perfect = run_offline(settings(MOTION_2, duration_s=20.0), twin=False)
    found = run_offline(settings({**DISTURBED, **NOMINAL}, duration_s=20.0), twin=False)
    off = (found.imu.t_ns - perfect.imu.t_ns) * 1e-3
    print(f'\nstamps late by {off.mean():.0f} +- {off.std():.0f} us')
    assert 5.0 * 900.0 / np.sqrt(len(off)) > abs(off.mean() - 1500.0)
    # Five standard deviations of an estimate from this number of stamps.
    assert off.std() == pytest.approx(900.0, rel=5.0 / np.sqrt(2.0 * len(off)))
    assert np.array_equal(found.imu.omega, perfect.imu.omega)
    for name, value in perfect.errors.arrays().items():
        assert np.array_equal(getattr(found.errors, name), value)


def test_stamps_taken_at_their_word_cost_accuracy():
    """
    Jittering stamps cause an attitude random walk of w' dt times the jitter.

    With the jitter d_k of stamp k the angle of a step has the error -w' dt (d_k + d_{k-1})/2.
    """
    values = {**MOTION_2, 'gyro.delay_us.y': 0.0, 'sampling.jitter_us': 200.0}
    sizes = []
    for seed in range(4):
        found = run_offline(settings({**values, 'seed': seed}, duration_s=20.0), twin=False)
        assert not found.faults
        sizes.append(np.linalg.norm(found.errors.attitude[-1]))
    # |w'| = psi' gamma' cos(30 deg) of the horizontal rate, which rotates in the body.
    expected = 1.0 * 0.5 * np.cos(np.radians(30.0)) * 0.01 * 200e-6 * np.sqrt(2000.0)
    size = np.sqrt(np.mean(np.square(sizes)))
    print(f'\nattitude off by {size:.2e} rad, root mean square; expected {expected:.2e}')
    # Chi-square with about 8 degrees of freedom.
    assert 0.4 * expected < size < 1.8 * expected
    wild = run_offline(settings({**values, 'sampling.jitter_us': 900.0}, duration_s=5.0),
                       twin=False)
    assert any('comes at another rate' in f for f in wild.faults)


def test_drop_outs_start_the_strapdown_anew():
    """Each run of lost samples is one gap, after which the error starts at zero."""
    values = {**MOTION_2, 'sampling.drop_out_probability': 0.003, 'seed': 3}
    found = run_offline(settings(values, duration_s=60.0), twin=False)
    gaps = np.flatnonzero(np.diff(found.imu.t_ns) > 10_000_000)
    print(f'\n{6001 - len(found.imu)} samples lost in {len(gaps)} gaps: {found.faults[0]}')
    assert len(gaps) > 5 and len(found.faults) == len(gaps)
    assert all('imu has a gap from' in f for f in found.faults)
    after = np.isin(found.errors.t_ns, found.imu.t_ns[gaps + 1])
    # Resolution of a latitude: 1e-9 m.
    assert np.abs(found.errors.position[after]).max() <= 2e-9
    with pytest.raises(ValueError, match='imu has a gap from'):
        run_offline(settings({**values, 'on_fault': 'stop'}, duration_s=60.0), twin=False)


def test_sample_clock():
    """Half a period belongs to the later instant; the latency is subtracted first."""
    s = settings({**NOMINAL, 'imu_latency_us': 2000.0}).strapdown
    clock = SampleClock(s, 10_000_000)
    assert [clock.instant(t) for t in (2_000_000, 6_999_999, 7_000_000, 12_000_000)] == [
        0, 0, 10_000_000, 10_000_000]
    assert clock.instant(np.array([12_000_000])).tolist() == [10_000_000]
    assert SampleClock(settings({}).strapdown, 10_000_000).instant(123) == 123


@pytest.mark.parametrize('values, says', [
    ({'imu_latency_us': 5.0}, 'imu_latency_us is 5 us with imu_time stamp; expected imu_time nom'),
    ({'imu_time': 'nominal', 'start_s': 0.004}, 'start_s is 0.004 s with imu_time nominal; exp')])
def test_bad_clocks_are_refused(values, says):
    """Invalid settings of the stamps are refused with one message."""
    with pytest.raises(ValueError, match=says):
        run_offline(settings(values, duration_s=1.0))


def test_orientation_algorithms_agree_to_their_truncation():
    """
    Poisson's equation and the Euler vector by RK4 agree with the exact quaternion on motion 2.

    For a constant rate w, RK4 has an angle error of (w dt)^5/120 a step with Poisson's equation,
    and less with the Euler vector; ten minutes.
    """
    chosen = settings(MOTION_2, duration_s=600.0)
    results = compare_orientations(chosen, read_motion(chosen.motion_generator))
    assert [r.kind for r in results] == ['quaternion', 'poisson', 'euler_vector']
    # sqrt(1 + 0.25 + 2 x 0.5 x sin 30 deg) rad/s, 60000 steps of 10 ms.
    bound = 60000 * (np.sqrt(1.75) * 0.01) ** 5 / 120.0
    for r in results:
        print(f'\n{r.kind}: off the quaternion by {r.apart:.2e} rad (bound {bound:.2e}), drift '
              f'{r.drift}, step {1e6 * r.step_s:.2f} us')
    assert results[0].apart <= 1e-15
    assert 0.0 < results[2].apart <= results[1].apart <= bound
    for r in results[1:]:
        assert np.abs(r.drift - results[0].drift).max() <= 2.0 * bound / 600.0
