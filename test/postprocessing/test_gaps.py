"""Gaps, bad stamps and bad samples of a record: the remaining solution and the notes."""

from dataclasses import replace
import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest

from ins_sim.core.earth import ellipsoid
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.postprocessing.imu_record import find_gaps, ordered_samples, RecordedImu
from ins_sim.core.postprocessing.reference import Reference, SampledTrack
from ins_sim import parameter_files
from support.readings.recorded_imu import end_errors, recorded, run, stamps

SETTINGS = parameter_files.read([], ['motion.kind:=sinusoids', 'source:=motion'])
MOTION = make_motion(SETTINGS.motion_generator.motion, SETTINGS.motion_generator.datum,
                     SETTINGS.motion_generator.earth)
AIR = {'initial.attitude': 'reference'}
SECOND = 1_000_000_000


def with_gap(first_s=8.0, length_s=0.5):
    """Return a record of 20 s with a gap."""
    t_ns = stamps(100.0)
    start = t_ns[0] + round(first_s * SECOND)
    return t_ns[(t_ns <= start) | (t_ns >= start + round(length_s * SECOND))]


def test_a_gap_ends_the_solution():
    """With on_gap stop the last state is the one before the gap, and a note states this."""
    t_ns = with_gap()
    got = run(*recorded(t_ns))
    assert got.states[-1].t_ns[-1] == 9 * SECOND and len(got.states) == 1
    assert any('gap of 0.5 s from 9.000000000 s: the solution ends there' in n for n in got.notes)
    assert got.figures['gaps'] == 1


def test_a_gap_restarts_from_the_reference():
    """on_gap restart: a second segment starts with the state of the reference."""
    got = run(*recorded(with_gap()), on_gap='restart')
    assert [s.t_ns[0] for s in got.states] == [SECOND, 9_500_000_000]
    errors = got.comparisons[0]
    k = int(np.searchsorted(errors.position.t_ns, 9_500_000_000))
    assert np.linalg.norm(errors.position.values[k]) < 1e-8
    assert np.linalg.norm(errors.attitude.values[k]) < 1e-12


def test_a_gap_without_a_restart_says_why():
    """
    Without an attitude in the reference or a standstill there is no restart; a note states why.

    The setting is on_gap restart.
    """
    imu, reference = recorded(with_gap())
    truth = MOTION.at(imu.t_ns[:1])
    roll, pitch, heading = _degrees(truth.q_nb[0])
    got = run(imu, replace(reference, attitude=None), on_gap='restart',
              initial__attitude='given', initial__roll_deg=roll, initial__pitch_deg=pitch,
              initial__heading_deg=heading)
    assert len(got.states) == 1
    assert any('no restart: no stationary interval' in n for n in got.notes)


def test_a_gap_restarts_from_a_standstill_behind_it():
    """With a fix but no attitude in the reference the IMU gyrocompasses again after the gap."""
    lat = 0.7
    t_ns = stamps(50.0, 60.0, 0.0)
    t_ns = t_ns[(t_ns <= 20 * SECOND) | (t_ns >= 25 * SECOND)]
    n = len(t_ns)
    rate = (0.0, ellipsoid.ROTATION_RATE * math.cos(lat), ellipsoid.ROTATION_RATE * math.sin(lat))
    imu = RecordedImu(t_ns, np.tile(rate, (n, 1)),
                      np.tile([0.0, 0.0, ellipsoid.gravity(math.sin(lat), 0.0)], (n, 1)),
                      np.full((n, 4), np.nan))
    reference = Reference('fix', SampledTrack(t_ns, np.tile([lat, 0.0, 0.0], (n, 1))))
    got = run(imu, reference, on_gap='restart', initial__attitude='align',
              alignment__longest_s=8.0, alignment__gyro_bias_sigma_deg_h=0.0)
    assert [int(s.t_ns[0]) // SECOND for s in got.states] == [7, 32]
    assert sum('heading by gyrocompassing' in note for note in got.notes) == 2
    # Forward is east, so that q_nb is the identity.
    assert np.abs(got.states[1].q_nb[-1] - [0.0, 0.0, 0.0, 1.0]).max() < 1e-11


def _degrees(q_nb):
    from ins_sim.core.attitude.angles import to_compass
    return [math.degrees(float(a)) for a in to_compass(q_nb)]


def test_a_gap_is_bridged_by_straight_lines(capsys):
    """
    With on_gap bridge the error is that of linear interpolation, and a note states the bridge.

    Bound on the attitude: the largest second derivative of the rates (their sinusoids have at most
    0.7 Hz) times T^3 / 12, T = 0.05 s, which is the error of the trapezoidal rule.
    """
    t_ns = with_gap(length_s=0.05)
    imu, reference = recorded(t_ns)
    bridged = run(imu, reference, on_gap='bridge')
    whole = run(*recorded(stamps(100.0)))
    cost = abs(end_errors(bridged)[1] - end_errors(whole)[1])
    rate = np.linalg.norm(imu.omega, axis=1).max()
    bound = rate * (2 * math.pi * 0.7) ** 2 * 0.05 ** 3 / 12.0
    with capsys.disabled():
        print(f'\nbridging 0.05 s costs {cost:.3g} rad (bound {bound:.3g})')
    assert cost < bound
    assert len(bridged.states) == 1
    assert any('1 gaps bridged' in n for n in bridged.notes)


def test_a_gap_of_decades_is_not_bridged():
    """A gap of decades is not bridged, because it would take millions of steps."""
    t_ns = np.append(stamps(100.0), 1_700_000_000 * SECOND)
    imu, reference = recorded(t_ns[:-1])
    rows = np.append(np.arange(len(imu)), len(imu) - 1)
    got = run(replace(imu[rows], t_ns=t_ns), reference, on_gap='bridge')
    assert got.states[-1].t_ns[-1] == t_ns[-2]
    assert any('the solution ends there (on_gap bridge, longest_bridge_s 600)' in note
               for note in got.notes)


@settings(max_examples=100, deadline=None)
@given(st.lists(st.integers(0, 30), min_size=2, max_size=25))
def test_as_few_stamps_as_possible_are_dropped(values):
    """As few samples are dropped as by the quadratic textbook method; the rest increases."""
    t_ns = np.array(values, dtype=np.int64)
    longest = [1] * len(values)
    for k in range(len(values)):
        for j in range(k):
            if values[j] < values[k]:
                longest[k] = max(longest[k], longest[j] + 1)
    imu = RecordedImu(t_ns, np.zeros((len(t_ns), 3)), np.zeros((len(t_ns), 3)),
                      np.full((len(t_ns), 4), np.nan))
    if max(longest) < 2:
        with pytest.raises(ValueError, match='expected at least two good ones'):
            ordered_samples(imu)
        return
    kept, losses = ordered_samples(imu)
    assert (np.diff(kept.t_ns) > 0).all()
    assert len(kept) == max(longest) == len(values) - losses.out_of_order - losses.repeated


def test_nan_samples_and_bad_stamps_are_dropped_and_counted():
    """The solution equals that of the record without the bad samples."""
    imu, reference = recorded(stamps(100.0))
    clean = np.delete(np.arange(len(imu)), [500, 900])
    omega, t_ns = imu.omega.copy(), imu.t_ns.copy()
    omega[500, 1] = np.nan
    # One stamp far ahead must cost only its own sample.
    t_ns[900] += 3600 * SECOND
    got = run(replace(imu, omega=omega, t_ns=t_ns), reference)
    expected = run(imu[clean], reference)
    assert (got.figures['not_finite'], got.figures['out_of_order']) == (1, 1)
    assert np.array_equal(got.states[0].q_nb, expected.states[0].q_nb)
    assert list(find_gaps(got.states[0].t_ns, 3.0)) == []


def test_a_solution_that_runs_away_is_cut_and_said():
    """
    With rates in deg/s taken for rad/s the solution is cut where it diverges, with a note.

    There is no NaN and no traceback.
    """
    imu, reference = recorded(stamps(100.0, 300.0))
    got = run(replace(imu, omega=imu.omega * 57.3, f=imu.f * 9.8 * 1000.0), reference)
    assert any('the solution diverges' in n for n in got.notes)
    assert all(np.isfinite(s.q_nb).all() and np.isfinite(s.lat).all() for s in got.states)
