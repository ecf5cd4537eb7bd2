"""Error budgets that several tests use."""

import pytest

import ins_sim


@pytest.fixture(scope='session')
def fog():
    """Return the ErrorBudget of the tactical FOG on the racetrack, 1 h."""
    return ins_sim.budget(ins_sim.read_settings(['racetrack', 'imu_tactical_fog']))


@pytest.fixture(scope='session')
def mems():
    """Return the ErrorBudget of the tactical MEMS on the racetrack, 1 h."""
    return ins_sim.budget(ins_sim.read_settings(['racetrack', 'imu_tactical_mems']))
