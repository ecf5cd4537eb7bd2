"""Input that prevents a start, and headings from other sources: one message each."""

from dataclasses import replace
import math

import numpy as np
import pytest
from support.nodes.live_imu import play, stage_of, vehicle

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import to_compass
from ins_sim.core.earth.atmosphere import pressure, pressure_height
from ins_sim.core.navigation.errors import position_error

# A rest of 8 s is sufficient.
SHORT = {'alignment.longest_s': 8.0, 'alignment.shortest_s': 5.0}
GIVEN = {**SHORT, 'initial.heading': 'given', 'initial.heading_deg': math.degrees(1.2)}


def headings(said):
    """Return the heading at the start, rad."""
    return float(to_compass(np.array(said.solved[0].state[4]))[2])


def test_alignment_on_the_move_is_never_trusted():
    """A shaking vehicle has no standstill; steady motion is recognised by its fixes."""
    imu, fixes = vehicle(length_s=40.0, rest_s=40.0)
    rng = np.random.default_rng(2)
    shaken = replace(imu, f=imu.f + 0.5 * rng.standard_normal((len(imu), 3)))
    said = play(stage_of(GIVEN), shaken, fixes)
    assert not said.solved and said.has('no stationary interval of 5 s in 30 s')
    going = [f._replace(lat=f.lat + 2e-6 * k) for k, f in enumerate(fixes)]
    said = play(stage_of(GIVEN), imu, going)
    assert not said.solved and said.has('seemed to be at rest; expected a vehicle at rest')


def test_a_standstill_that_is_cut_short_begins_anew():
    """A standstill of 3 s is too short; the next one is used."""
    imu, fixes = vehicle(length_s=60.0, rest_s=60.0)
    f = imu.f.copy()
    f[160:180, 0] += 2.0
    said = play(stage_of(GIVEN), replace(imu, f=f), fixes)
    assert said.has('alignment starts again: the vehicle has moved at 1000000003.4')
    assert said.t_ns[0] > imu.t_ns[180] + 7 * 10**9 and abs(headings(said) - 1.2) < 1e-3


@pytest.mark.parametrize('scale, part', [
    (1.0 / 9.80665, 'mean specific force at rest is 1.0 m/s^2; expected 9.8: is it in g?'),
    (1000.0 / 9.80665, 'is it in mg?'), (0.0, 'was gravity removed?')])
@pytest.mark.parametrize('source', ['alignment', 'given'])
def test_another_unit_of_the_accelerometers(scale, part, source):
    """Specific force in another unit is reported, and navigation does not start."""
    imu, fixes = vehicle(length_s=30.0, rest_s=30.0, noise=(2e-4, 1e-4))
    values = SHORT if source == 'alignment' else {'initial.source': 'given'}
    said = play(stage_of(values), replace(imu, f=scale * imu.f), fixes)
    assert not said.solved and said.has(part)


def test_upside_down():
    """An IMU mounted upside down is navigated as it is; a message names mounting.rpy_deg."""
    imu, fixes = vehicle(length_s=30.0, rest_s=30.0)
    turn = quaternion.exponential((math.pi, 0.0, 0.0))
    said = play(stage_of(GIVEN), imu.turned(turn), fixes)
    assert said.solved and said.has('alignment: roll ')
    assert said.has('Is the IMU mounted rotated? Then set mounting.rpy_deg, or mounting')
    mounted = {**GIVEN, 'mounting.rpy_deg': (180.0, 0.0, 0.0)}
    said = play(stage_of(mounted), imu.turned(turn), fixes)
    assert said.solved and not said.has('Is the IMU mounted rotated?')


def test_zeros_in_turns():
    """A driver that sends rates and forces in alternate messages is reported."""
    imu, fixes = vehicle(length_s=30.0, rest_s=30.0, noise=(2e-4, 1e-3))
    f = imu.f.copy()
    f[::10] = 0.0
    said = play(stage_of({**GIVEN, 'alignment.force_sd_m_s2': 10.0}), replace(imu, f=f), fixes)
    assert not said.solved and said.has('the driver seems to send them alternately')


def test_readings_that_are_no_numbers():
    """Ten readings that are not finite are dropped and counted."""
    imu, fixes = vehicle(length_s=30.0, rest_s=30.0)
    f = imu.f.copy()
    f[100:110] = np.inf
    said = play(stage_of(GIVEN), replace(imu, f=f), fixes)
    assert said.solved and said.stage.samples.dropped == 10
    assert said.has('holds NaN or infinity')


def test_a_long_gap_begins_anew():
    """After a long gap a new standstill is needed; a given initial state is no longer valid."""
    imu, fixes = vehicle(length_s=60.0, rest_s=60.0)
    kept = np.ones(len(imu), dtype=bool)
    kept[1000:1200] = False
    said = play(stage_of(SHORT | {'initial.heading': 'magnetometer'}), imu[kept], fixes)
    assert said.stage.begun == 2 and said.has('starting anew (gap 1)')
    said = play(stage_of({'initial.source': 'given', 'initial.latitude_deg': 50.0}), imu[kept])
    assert said.stage.begun == 1 and said.has('expected a call of ~/reset when the vehicle is in')
    assert said.t_ns[-1] < imu.t_ns[1000] and said.stage.state == 'waiting for ~/reset'
    said.stage.reset()
    assert play(said, imu[1300:]).stage.begun == 2


def test_a_clock_that_jumps_back():
    """A clock that jumps back is recognised after ten increasing stamps; alignment restarts."""
    imu, fixes = vehicle(length_s=30.0, rest_s=30.0)
    stage = play(stage_of(GIVEN), imu, fixes)
    said = play(stage, replace(imu, t_ns=imu.t_ns - 10**12),
                [f._replace(t_ns=f.t_ns - 10**12) for f in fixes])
    assert said.stage.begun == 2 and said.has('jumped back to 999999000.18')


def test_a_fix_of_another_clock():
    """A fix with a stamp of another clock is dropped with a message; later fixes are used."""
    imu, fixes = vehicle(length_s=30.0, rest_s=30.0)
    fixes.insert(4, fixes[4]._replace(t_ns=fixes[4].t_ns + 10**12))
    said = stage_of(GIVEN)
    play(said, imu[:120], fixes[:3])
    said.take(said.stage.push_fix(fixes[4]))
    play(said, imu[120:], fixes[5:])
    assert said.has('a fix on gnss/fix is 1001') and said.stage.located


def test_a_solution_that_runs_away():
    """A solution that diverges is stopped with one message."""
    imu, _ = vehicle(length_s=10.0, rest_s=10.0)
    said = play(stage_of({'initial.source': 'given', 'initial.height_m': 9.9e5,
                          'initial.velocity_m_s': (0.0, 0.0, 9e3)}), imu)
    assert said.has('the solution diverges') and len(said.solved) < len(imu)


@pytest.mark.parametrize('declination', [0.0, 0.12])
@pytest.mark.parametrize('turn', [(0.0, 0.0, 0.0), (0.3, -0.2, 0.0)])
def test_a_heading_by_the_magnetic_field(declination, turn):
    """The magnetic heading is independent of dip and roll, and corrected for the declination."""
    imu, fixes = vehicle(length_s=20.0, rest_s=20.0, noise=(2e-4, 1e-4))
    turn = quaternion.exponential(turn)
    imu = imu.turned(quaternion.conjugate(turn))
    said = stage_of(GIVEN | {'initial.heading': 'magnetometer', 'initial.heading_deg': 0.0},
                    declination=lambda t_ns, place: (declination, 'as given'))
    true = quaternion.multiply(quaternion.exponential((0.0, 0.0, math.pi / 2 - 1.2)), turn)
    field = quaternion.rotate_back(true, (2e-5 * math.sin(declination),
                                          2e-5 * math.cos(declination), -4e-5))
    for t_ns in imu.t_ns[::5].tolist():
        said.stage.push_field(t_ns, field)
    # The mounting is not known before the first reading.
    said.stage.push_imu(int(imu.t_ns[0]), tuple(imu.omega[0]), tuple(imu.f[0]))
    for t_ns in imu.t_ns[::5].tolist():
        said.stage.push_field(t_ns, field)
    play(said, imu[1:], fixes)
    off = quaternion.logarithm(quaternion.multiply(said.solved[0].state[4],
                                                   quaternion.conjugate(true)))
    assert np.abs(off).max() < 2e-3 and said.has('heading by the magnetic field')


def test_a_field_that_is_not_the_earths():
    """If the field is not that of the Earth the IMU is only levelled; a warning states why."""
    imu, fixes = vehicle(length_s=20.0, rest_s=20.0)
    said = stage_of(SHORT | {'initial.heading': 'magnetometer'})
    for t_ns in imu.t_ns[::5].tolist():
        said.stage.push_field(t_ns, (4e-4, 0.0, 0.0))
    play(said, imu, fixes)
    assert said.has('the magnetic field is 400 uT; expected 20 to 70 uT')
    assert not said.stage.located


def test_a_start_on_the_move_by_the_course_of_fixes():
    """After 20 m a start in motion has the position, velocity and heading of the car."""
    imu, fixes = vehicle(length_s=40.0, rest_s=5.0)
    said = play(stage_of({'initial.source': 'fix', 'initial.heading': 'course'}), imu, fixes)
    t_ns, (lat, lon, height, v, _) = said.solved[0][:2]
    assert abs(headings(said) - 1.2) < 1e-6 and said.has('start on the move')
    after = next(f for f in fixes if f.t_ns > t_ns)
    # At 1 m/s^2 the vehicle moves 1 m more in the next second than in the last one.
    way = math.hypot(*position_error(lat, lon, height, *after.place)[:2])
    assert way < math.hypot(*v[:2]) + 1.0
    assert abs(math.atan2(v[0], v[1]) - 1.2) < 1e-6 and math.hypot(*v) > 4.0


def test_a_late_course_gives_way_to_what_there_is():
    """If the fixes do not move 20 m, the search for a course ends and the IMU is only levelled."""
    imu, fixes = vehicle(length_s=40.0, rest_s=40.0)
    said = play(stage_of(SHORT | {'alignment.course_search_s': 10.0}), imu, fixes)
    assert said.has('moves 0 m on one course within 10 s') and not said.stage.located
    assert said.solved and said.has('levelled only, the heading is unknown')


def test_pressure_and_height_are_inverse():
    """Pressure and height are inverse functions in every layer and above the highest one."""
    for height in (-400.0, 0.0, 1000.0, 11000.0, 15000.0, 25000.0, 40000.0, 50000.0, 60000.0,
                   80000.0, 90000.0):
        assert abs(pressure_height(pressure(height)) - height) < 1e-6
