"""Run k of an ensemble is the single run k, to the bit, however the work is shared out."""

from dataclasses import replace
import math

import numpy as np
import pytest

from ins_sim import parameter_files, resources
from ins_sim.core.ensemble import group, many_runs
from ins_sim.core.simulation.inertial import simulate
from ins_sim.io.motion import read_motion

NOISY = ('imu_tactical_fog',)
LAGGED = ('accelerometer.errors.bandwidth_hz:=[20.0, 0.0, 30.0]',
          'gyro.errors.quantisation_arcsec:=[0.1, 0.1, 0.0]')


def settings_of(*assignments, names=('motion_2',), seconds=12.0):
    """Return SimulationSettings of shipped files."""
    return parameter_files.read([resources.parameter_file(name) for name in names],
                                [f'duration_s:={seconds}', *assignments])


def drawn_initial(settings):
    """Return a function of the number of a run that returns other initial errors for each."""
    def initial(run):
        a, b, c = np.random.default_rng(run).normal(size=(3, 3))
        return replace(settings.strapdown.initial, attitude_error_deg=tuple((0.1 * a).tolist()),
                       velocity_error_m_s=tuple(b.tolist()), position_error_m=tuple(c.tolist()))

    return initial


def single(settings, motion, run, initial=None):
    """Return the SimulationResult of a run."""
    if initial is not None:
        settings = replace(settings, strapdown=replace(settings.strapdown, initial=initial(run)))
    return simulate(settings, motion, twin=False, run=run)


def errors_of(result):
    """Return the errors of a SimulationResult, nine columns."""
    errors = result.errors
    return np.concatenate([errors.attitude, errors.velocity, errors.position], axis=1)


@pytest.mark.parametrize('names, assignments', [
    (('motion_2',), ('vertical.channel:=truth',)),
    (('motion_2', *NOISY), ('vertical.channel:=free', 'initial.after_s:=1.003')),
    (('cruise', *NOISY), ('vertical.channel:=damped', 'input:=integrated', 'output:=integrated')),
    (('motion_2', *NOISY), LAGGED)])
def test_a_lane_is_the_single_run(names, assignments):
    """Solution and errors of a run are those of simulate with that run, whatever the channel."""
    settings = settings_of(*assignments, names=names)
    motion, initial = read_motion(settings.motion_generator), drawn_initial(settings)
    found = many_runs.simulate_runs(settings, motion, range(5, 22), [2.0, 7.003, 12.0],
                                    initial=initial)
    assert found.diverged == () and found.statistics.count.tolist() == [17] * 3
    for k in (0, 7, 16):
        one = single(settings, motion, 5 + k, initial)
        states = one.states
        assert found.final[k, 0] == states.lat[-1] and found.final[k, 1] == states.lon[-1]
        assert found.final[k, 2] == states.height[-1]
        np.testing.assert_array_equal(found.final[k, 3:6], states.v_n[-1])
        np.testing.assert_array_equal(found.final_errors[k], errors_of(one)[-1])
