"""Increments from single steps, arrays, and plain or compiled loops have the same bits."""

import numpy as np
import pytest
from support.studies import MOTION_2, settings

from ins_sim.core.attitude import quaternion
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.numerics import compilation
from ins_sim.core.sensors.imu import increments
from ins_sim.core.sensors.imu.ideal import MotionImu
from ins_sim.core.sensors.imu.readings import samples_of
from ins_sim.core.sensors.imu.stream import PacedImu
from ins_sim.core.timeseries.histories import ImuSamples

N = 500
RNG = np.random.default_rng(6)
Q_MB = np.array([quaternion.exponential(row) for row in (3.0 * RNG.normal(size=(N, 3))).tolist()])
BEFORE = (0.5, -0.5, 0.5, 0.5)
EARTH = quaternion.exponential((1e-8, 2e-7, 3e-7))
FORCE = 10.0 * RNG.normal(size=(N, 3))


def single_steps(name):
    """Return the results of single steps, and the loop, its array version and its inputs."""
    starts, ends = [BEFORE, *map(tuple, Q_MB[:-1].tolist())], Q_MB.tolist()
    if name == 'rotation':
        return ([increments.rotation_increment(a, b, EARTH) for a, b in zip(starts, ends)],
                (BEFORE, Q_MB, EARTH))
    if name == 'force':
        return ([quaternion.rotate_back(a, f) for a, f in zip(starts, FORCE.tolist())],
                (BEFORE, Q_MB, FORCE))
    return [quaternion.multiply(BEFORE, q) for q in ends], (BEFORE, Q_MB)


@pytest.mark.parametrize('name', ['rotation', 'force', 'turned'])
def test_loops_and_arrays_give_the_bits_of_single_steps(name):
    """The plain loop, the array version and the compiled loop give the bits of single steps."""
    expected, inputs = single_steps(name)
    loop = getattr(increments, f'{name}_rows')
    out = np.empty_like(expected)
    getattr(increments, f'{name}_arrays')(*inputs, out)
    assert np.array_equal(out, expected)
    rows = [0.0] * out.size
    loop(*(x.ravel().tolist() if isinstance(x, np.ndarray) else x for x in inputs), rows)
    assert np.array_equal(np.reshape(rows, out.shape), expected)
    if compilation.numba() is None:
        pytest.skip('Numba is not installed')
    out = np.empty(out.size)
    compilation.compiled(loop)(*(x.ravel() if isinstance(x, np.ndarray) else x for x in inputs),
                               out)
    assert np.array_equal(out.reshape(np.shape(expected)), expected)


@pytest.mark.parametrize('kind', ['static', 'two_axis', 'sculling', 'harmonics', 'aggressive'])
@pytest.mark.parametrize('more', [{}, {'output': 'integrated'}, {'history': 'frozen'}])
def test_an_imu_on_a_motion_gives_equal_bits_compiled_and_plain(kind, more, monkeypatch):
    """
    An IMU on a motion gives equal bits compiled and plain, in whole blocks and random cuts.

    Every channel has its own delay.
    """
    s = settings({**MOTION_2, 'gyro.delay_us.x': -3.0, 'gyro.delay_us.z': 4000.0,
                  'accelerometer.delay_us.y': 15000.0, 'motion.kind': kind, **more})
    generator = s.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    runs = []
    for plain_samples in (10 ** 9, 0):
        monkeypatch.setattr(compilation, 'PLAIN_SAMPLES', plain_samples)
        imu, parts = MotionImu(s.imu_sensor, motion, 70_000_000), []
        while sum(map(len, parts)) < N:
            parts.append(imu.advance(int(RNG.choice([1, 2, 30, 200]))))
        runs += [ImuSamples.concatenate(parts)[:N],
                 MotionImu(s.imu_sensor, motion, 70_000_000).advance(N)]
    monkeypatch.setattr(compilation, 'compiled', None)
    live = PacedImu(s.imu_sensor, motion)
    readings = [r for t in runs[0].t_ns.tolist() for r in live.push(t, (0.0,), (0.0,), (0.0,))]
    # A live node must not stop to compile.
    runs.append(samples_of(readings))
    for run in runs[1:]:
        for name, values in runs[0].arrays().items():
            assert np.array_equal(getattr(run, name), values), name
