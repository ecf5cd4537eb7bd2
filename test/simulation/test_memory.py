"""Memory grows with the block length, not with the run; any length gives the same bits."""

import tracemalloc

import numpy as np
import pytest
from support.studies import FLIGHT, MOTION_2, settings

from ins_sim.core.prediction import drift, predict as prediction
from ins_sim.core.simulation import inertial
from ins_sim.io.motion import read_motion
from ins_sim.report.spool import Spool
from ins_sim.settings.presets import preset

TUNED = {**preset('tactical_dtg'), **FLIGHT, 'motion.kind': 'aggressive', 'output': 'integrated'}
# Bytes of truth, readings, solution and errors for each sample.
WHOLE = 384


def peak_of(work):
    """Return the peak memory that a function allocates, bytes."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize('values', [
    {**MOTION_2, 'initial.after_s': 1.0}, {**FLIGHT, 'motion.kind': 'cruise'}, TUNED],
    ids=['motion 2', 'cruise', 'tuned gyros'])
def test_blocks_of_a_prediction_join_to_the_bit(values, monkeypatch):
    """Integrals, rotors, RK4 and the mean drift are carried from block to block."""
    chosen = settings(values, duration_s=47.33, accelerometer__delay_us__y=-2.0)
    motion = read_motion(chosen.motion_generator)
    whole = prediction.predict(chosen, motion)
    for steps in (1, 7, 100):
        for module in (drift, prediction):
            monkeypatch.setattr(module, 'BLOCK', steps * drift.SUBSAMPLES)
        cut = prediction.predict(chosen, motion)
        for name in ('drift', 't_s', 'attitude', 'position', 'largest'):
            np.testing.assert_array_equal(getattr(cut, name), getattr(whole, name), err_msg=name)
    np.testing.assert_array_equal(whole.largest, abs(whole.position).max(axis=0))


def test_a_prediction_without_histories_has_the_same_figures():
    """
    A prediction without histories gives the same numbers.

    Two hours with histories need 600 MB, 85 kB a second.
    """
    chosen = settings(MOTION_2, duration_s=7200.0)
    motion = read_motion(chosen.motion_generator)
    found = []
    peak = peak_of(lambda: found.append(prediction.predict(chosen, motion, collect=None)))
    assert peak < 100e6  # Numba needs some 25 MB of this, if it is installed.
    whole = prediction.predict(chosen, motion)
    assert found[0].t_s is found[0].attitude is found[0].position is None
    np.testing.assert_array_equal(found[0].drift, whole.drift)
    np.testing.assert_array_equal(found[0].largest, whole.largest)


def test_a_spooled_run_takes_the_memory_of_its_blocks(tmp_path, monkeypatch):
    """Ten times the run needs a quarter of the memory of its further samples as arrays."""
    monkeypatch.setattr(inertial, 'BLOCK', 256)
    peaks = []
    # The first run loads what stays in memory, such as compiled loops.
    for duration_s in (100.0, 10.0, 100.0):
        chosen = settings(MOTION_2, duration_s=duration_s)
        motion = read_motion(chosen.motion_generator)
        with Spool(tmp_path) as spooled:
            peaks.append(peak_of(lambda: inertial.simulate(chosen, motion, twin=False,
                                                           collect=spooled.store)))
    print(f'\n{peaks[1] / 1e6:.2f} and {peaks[2] / 1e6:.2f} MB')
    assert peaks[2] - peaks[1] < 0.25 * WHOLE * 9000


def test_a_spooled_run_is_the_run_in_memory(tmp_path):
    """Every field of every history of a spooled run, and of its twin, equals that in memory."""
    chosen = settings({**MOTION_2, **preset('tactical_fog')}, duration_s=60.0, output_every=3)
    motion = read_motion(chosen.motion_generator)
    expected = inertial.simulate(chosen, motion)
    with Spool(tmp_path) as spooled:
        found = inertial.simulate(chosen, motion, collect=spooled.store)
        for record in ('truth', 'imu', 'states', 'errors', 'twin'):
            for name, values in getattr(expected, record).arrays().items():
                np.testing.assert_array_equal(getattr(getattr(found, record), name)[:], values)
