"""Blocks of the inertial navigator give the bits of single steps, compiled or not."""

from ins_sim.core.attitude.integration import KINDS
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.navigation.navigator import CHANNELS, InertialNavigator
from ins_sim.core.numerics import compilation
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.core.timeseries.histories import ImuSamples
import numpy as np
import pytest
from support.studies import settings

RNG = np.random.default_rng(7)


@pytest.fixture(scope='module')
def flight():
    """Return settings, readings and truth of a flight of 7 s with strong dynamics."""
    chosen = settings({'motion.kind': 'aggressive', 'output': 'integrated', 'duration_s': 7.0,
                       'gyro.errors.angle_random_walk_deg_sqrt_h': [0.1] * 3})
    generator = chosen.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    imu = ImuSamples.concatenate(imu_blocks(chosen, motion))
    return imu, motion.at(imu.t_ns)


def navigator(kind, channel, output):
    return InertialNavigator(settings({
        'orientation': kind, 'vertical.channel': channel, 'output': output, 'input': output,
        'initial.after_s': 0.5, 'initial.position_error_m': [10.0, -20.0, 5.0],
        'initial.attitude_error_deg': [0.01, -0.02, 0.1]}).strapdown)


def rows_of_steps(navigator, imu, truth):
    """Return all outputs of single steps, one list of floats per sample."""
    rows = []
    for k, sample in enumerate(zip(imu.t_ns.tolist(), map(tuple, imu.omega.tolist()),
                                   map(tuple, imu.f.tolist()))):
        errors = navigator.step(*sample, truth.one(k))
        if errors is not None:
            lat, lon, height, v, q = navigator.solution
            rows.append([sample[0], lat, lon, height, *v, *q, *(x for e in errors for x in e)])
    return rows


def rows_of_blocks(navigator, imu, truth):
    cuts = np.sort(RNG.integers(0, len(imu) + 1, 6)).tolist()
    rows = []
    for a, b in zip([0, *cuts], [*cuts, len(imu)]):
        states, errors = navigator.advance(imu.t_ns[a:b], imu.omega[a:b], imu.f[a:b], truth[a:b])
        columns = [*states.arrays().values(), *list(errors.arrays().values())[1:]]
        rows.extend(np.column_stack(columns).tolist())
    return rows


@pytest.mark.parametrize('how', ['plain', 'compiled'])
@pytest.mark.parametrize('kind, channel, output', [
    *((kind, 'damped', 'integrated') for kind in KINDS),
    *(('quaternion', channel, 'rotation_vector') for channel in CHANNELS)])
def test_blocks_have_the_bits_of_steps(flight, monkeypatch, how, kind, channel, output):
    """651 outputs of random blocks, plain and compiled, have the bits of single steps."""
    if how == 'compiled' and compilation.numba() is None:
        pytest.skip('Numba is not installed')
    monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', 10 ** 9 if how == 'plain' else -1)
    expected = rows_of_steps(navigator(kind, channel, output), *flight)
    assert rows_of_blocks(navigator(kind, channel, output), *flight) == expected
    assert len(expected) == 651
