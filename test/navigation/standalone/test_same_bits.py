"""A live IMU without truth gives the bits of ``ins_sim navigate`` on its recording."""

from dataclasses import replace
import math

import numpy as np
import pytest
from support.nodes.live_imu import (LIVE, OFFLINE, play, read, reference_of, same_bits, stage_of,
                                    vehicle)

import ins_sim
from ins_sim.core.attitude import quaternion
from ins_sim.core.postprocessing.navigate import navigate
from ins_sim.core.postprocessing.sources import Sources
from ins_sim.io import csv_imu
from ins_sim.settings.catalogue import build
from ins_sim.settings.navigate import NavigateSettings

FRD = {'mounting.rpy_deg': (180.0, 0.0, 0.0)}
PLACE = {'initial.latitude_deg': 50.0, 'initial.longitude_deg': 8.0, 'initial.height_m': 100.0}


def offline(imu, fixes, values):
    """Return the offline NavigationResult for a record."""
    sources = Sources('record', imu, 'imu', reference_of(fixes) if fixes else None)
    return navigate(build(NavigateSettings, values), sources)


@pytest.mark.parametrize('late_s', [0.0, 0.35])
def test_a_coarse_imu_that_takes_the_course_of_its_fixes(late_s):
    """A coarse IMU waits for the course of the fixes, then navigates from the standstill on."""
    imu, fixes = vehicle()
    said = play(stage_of(), imu, fixes, round(late_s * 1e9))
    result = offline(imu, fixes, {})
    assert 'the course of fix' in result.figures['heading_source']
    same_bits(said, result.states[0])
    assert said.has('heading from the course') and said.has('gyro bias at standstill')


def test_a_fine_imu_that_sees_the_earth_turn():
    """A fine IMU starts by gyrocompass, with the position interpolated between fixes."""
    imu, fixes = vehicle(noise=(1e-7, 1e-4), bias=(0.0, 0.0, 0.0))
    known = {'alignment.gyro_bias_sigma_deg_h': 0.01}
    said, result = play(stage_of(known), imu, fixes), offline(imu, fixes, known)
    assert result.figures['heading_source'] == 'gyrocompass'
    same_bits(said, result.states[0])


@pytest.mark.parametrize('kind', ['instant', 'integrated', 'rotation_vector'])
def test_a_given_start(kind):
    """With all initial values given, the first sample is the start, for every kind of input."""
    imu, _ = vehicle()
    given = {**PLACE, 'initial.heading_deg': 70.0, 'initial.roll_deg': 1.0, 'input': kind,
             'initial.velocity_m_s': (1.0, 2.0, 0.5)}
    said = play(stage_of({**given, 'initial.source': 'given'}), imu)
    result = offline(imu, [], {**given, 'initial.attitude': 'given', 'initial.velocity': 'given',
                               'initial.position': 'given'})
    same_bits(said, result.states[0])


def test_a_start_from_a_fix():
    """With the position from fixes, the start is the first sample between two fixes."""
    imu, fixes = vehicle()
    given = {'initial.heading_deg': 70.0}
    said = play(stage_of({**given, 'initial.source': 'fix', 'initial.heading': 'given'}), imu,
                fixes[2:])
    result = offline(imu, fixes[2:], {**given, 'initial.attitude': 'given',
                                      'initial.velocity': 'given'})
    assert said.t_ns[0] > imu.t_ns[90]
    same_bits(said, result.states[0])


def test_a_mounting_found_by_level():
    """Mounting source level rotates the mean force upwards from the standstill used offline."""
    imu, fixes = vehicle()
    imu = imu.turned(quaternion.exponential((1.0, 0.2, 0.0)))
    values = {'mounting.source': 'level', 'mounting.rpy_deg': (0.0, 0.0, 20.0)}
    same_bits(play(stage_of(values), imu, fixes), offline(imu, fixes, values).states[0])


def test_jitter_strays_repeats_and_gaps():
    """
    Jittering, repeated or jumping stamps, NaN readings and gaps give the bits of the offline run.

    Offline sees the whole record and drops as few samples as possible; live sees one sample after
    the other. A solution published for a stamp ahead of its time remains, but none after it.
    """
    imu, fixes = vehicle(length_s=50.0)
    rng = np.random.default_rng(4)
    t_ns = imu.t_ns + np.rint(1e6 * rng.uniform(-1.0, 1.0, len(imu))).astype(np.int64)
    t_ns[300] = t_ns[299]
    t_ns[400] = t_ns[398] + 5
    t_ns[1700] = t_ns[1701] + 4_000_000
    t_ns[1900] += 20_000_000_000
    t_ns[2000] -= 3_000_000_000
    omega = imu.omega.copy()
    omega[1600, 1] = np.nan
    kept = np.ones(len(imu), dtype=bool)
    kept[2100:2120] = kept[2300:2307] = False
    imu = replace(imu, t_ns=t_ns, omega=omega)[kept]
    said = play(stage_of(), imu, fixes)
    result = offline(imu, fixes, {'on_gap': 'bridge', 'longest_bridge_s': 1.0})
    assert len(result.states) == 1 and '2 gaps bridged' in ' '.join(result.notes)
    # Published before its stamp was known to be wrong; the sample after it is dropped.
    states = result.states[0]
    assert np.setdiff1d(said.t_ns, states.t_ns) == t_ns[1700]
    assert np.setdiff1d(states.t_ns, said.t_ns) == t_ns[1701]
    said.solved = [s for s in said.solved if s.t_ns != t_ns[1700]]
    same_bits(said, states[states.t_ns != t_ns[1701]])
    for part in ('holds NaN or infinity', 'repeats the stamp', 'goes back from',
                 'ahead of its time', 'bridged by linear interpolation'):
        assert said.has(part), part
    # The first gap is where two samples of the standstill are missing.
    assert said.stage.gaps == 3


@pytest.mark.parametrize('bag, imu, fix, values', [
    ('husky_test1_mcap', '/imu/data', '/fix', {'mounting.rpy_deg': (90.0, 0.0, -90.0)}),
    ('umn_thor_fl75_first90s_sqlite3', '/imu/data', '/gps/fix', {})])
def test_the_recorded_bags(bag, imu, fix, values, shared_data):
    """
    Two real coarse IMUs are levelled at a standstill, with the heading from the course of fixes.

    Live and offline solutions have the same bits.
    """
    path = shared_data / 'rosbags' / bag
    result = ins_sim.navigate(path, {**OFFLINE, **values})
    said = play(stage_of(values), *read(path, imu, fix))
    assert 'the course of' in result.figures['heading_source']
    same_bits(said, result.segments[0])


def test_the_recorded_car_from_a_given_start(shared_data):
    """
    A real MEMS IMU in a car that never stops starts from the state of its reference.

    Live and offline solutions have the same bits.
    """
    folder = shared_data / 'imu_ref'
    imu, _ = csv_imu.read_imu(folder / 'fogmems_imu.csv.gz')
    given = {**FRD, 'initial.latitude_deg': 34.426238931, 'initial.longitude_deg': 111.434225287,
             'initial.height_m': 172.5919, 'initial.roll_deg': 1.41254,
             'initial.pitch_deg': -3.13067, 'initial.heading_deg': 1.29776,
             'initial.velocity_m_s': (-0.62928, 11.5623, -0.25485)}
    said = play(stage_of({**given, 'initial.source': 'given'}), imu)
    result = offline(imu, [], {**given, 'initial.attitude': 'given', 'initial.velocity': 'given',
                               'initial.position': 'given'})
    same_bits(said, result.states[0])


def test_the_recorded_flight_from_its_standstill(shared_data):
    """
    A recorded flight of 670 s is aligned on the ground with given position and heading.

    Live and offline solutions have the same bits.
    """
    imu, _ = csv_imu.read_imu(shared_data / 'imu_ref' / 'umn_thor_fl75_imu.csv.gz')
    given = {**FRD, 'initial.latitude_deg': 45.3288, 'initial.longitude_deg': -93.231,
             'initial.height_m': 249.3, 'initial.heading_deg': 30.0, 'initial.heading': 'given',
             'initial.position': 'given'}
    imu = imu[:8000]
    said = play(stage_of(given), imu)
    same_bits(said, offline(imu, [], given).states[0])


def test_the_settings_are_those_of_navigate():
    """Settings common to live and offline navigation have the same defaults."""
    live, recorded = build(type(stage_of().stage._s), LIVE), NavigateSettings()
    assert live.alignment == recorded.alignment and live.gaps.factor == recorded.gap_factor
    assert live.mounting.rpy_deg == recorded.mounting.rpy_deg
    assert live.alignment.gyro_bias_sigma_deg_h >= 10.0 and math.isclose(
        live.alignment.heading_sigma_deg, 2.0)
