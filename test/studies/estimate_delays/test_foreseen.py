"""Expected sigmas of bench motions by covariance alone: the values of the specification."""

import math

import numpy as np
import pytest

from ins_sim.core.calibration.channel_fit import fit_channel
from ins_sim.core.calibration.channel_sums import (ASYMMETRY, channel_sums, DELAY, LAST, NEXT,
                                                   SCALE)
from ins_sim.core.calibration.delays import estimate_triad, noise_of, NotObservable
from ins_sim.core.calibration.foreseen import planned_record
from ins_sim.core.calibration.separability import eigenvectors, weak_directions
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.sensors.imu.triad_model import triad_model
from ins_sim.studies import bench_motions
from support.readings.bench import DIAGONAL, FOG, ideal, MOTION_2, read, THREE_ANGLES
from support.studies import settings

CHOSEN = settings(FOG)
WHITE = triad_model(CHOSEN.imu_sensor.gyro.errors, 0.01).white
CASES = {case.name: case for case in bench_motions.bench_cases()}


def foreseen(name, chosen=CHOSEN):
    return bench_motions.foresee_case(CASES[name], chosen, WHITE, 600.0)


def test_rocking_about_the_diagonal():
    """
    FOG, 5 deg, 1 Hz, 600 s: sigma is 0.101 us for a channel and 0.143 us for a difference.

    The oscillation is about the diagonal.
    """
    found = foreseen('rocking about the diagonal, 5 deg, 1 Hz')
    assert found.refused == ('', '', '')
    assert 1e6 * np.array(found.sigmas) == pytest.approx(0.101, abs=0.0005)
    assert 1e6 * math.hypot(*found.sigmas[:2]) == pytest.approx(0.143, abs=0.0005)


def test_motion_2_reversed_half_way():
    """
    Motion 2 reversed half-way: sigma of y and z is 0.466 us, of their difference 0.658 us.

    x rotates uniformly and cannot be estimated. N / sqrt(T) divided by the rms of the derivative,
    0.5 cos(30 deg) / sqrt(2), is 0.4654.
    """
    found = foreseen('motion 2, reversed half-way')
    assert [bool(why) for why in found.refused] == [True, False, False]
    assert 1e6 * np.array(found.sigmas[1:]) == pytest.approx(0.466, abs=0.001)
    assert 1e6 * math.hypot(*found.sigmas[1:]) == pytest.approx(0.658, abs=0.0005)


def test_motion_2_in_one_sense_cannot_measure_delays():
    """
    Motion 2 in one direction is refused: sigma is 2000 us.

    A delay of 1 us looks like 0.5 urad of misalignment.
    """
    still = settings(FOG, earth__rotation=False)
    found = foreseen('motion 2 in one sense', still)
    assert all(found.refused)
    assert 1e6 * np.array(found.sigmas[1:]) == pytest.approx(2000.0, rel=1e-3)
    record, chosen = ideal({**MOTION_2, **FOG}, 60.0)
    with pytest.raises(NotObservable) as refusal:
        estimate_triad([read(record, chosen, 0)])
    for text in ('not observable',
                 'a delay of y of 1 us has the effect of 0.5 urad of misalignment towards z',
                 'a delay of z of 1 us has the effect of 0.5 urad of misalignment towards y',
                 'the rate of x changes by at most'):
        assert text in str(refusal.value)


def test_the_diagonal_is_best_and_speed_helps():
    """
    Only two motions give three delays, and the diagonal is eleven times better.

    Sigma is proportional to the inverse of the amplitude and of the square of the frequency; the
    mean over a sampling interval reduces it by sin(x)/x, x = pi f dt.
    """
    worst = {name: foreseen(name) for name in CASES}
    three = {name: found.worst for name, found in worst.items() if not any(found.refused)}
    assert min(three, key=three.get) == 'rocking about the diagonal, 5 deg, 1 Hz'
    assert len(three) == 2
    frequencies = np.array([0.5, 1.0, 2.0, 4.0, 10.0])
    sweep = bench_motions.sweep_rocking(CHOSEN, WHITE, 600.0, frequencies)
    x = math.pi * frequencies * 0.01
    expected = (1.0 / np.array(sweep.amplitudes_deg)) / (
        np.sin(x) / x * frequencies * frequencies)[:, None]
    seen = np.isfinite(sweep.sigmas)
    assert not seen[-1, -1] and seen.sum() == seen.size - 1
    # Large amplitudes rotate the Earth rate more; a few periods are not exactly 600 s.
    ratio = (sweep.sigmas / sweep.sigmas[1, 1] / (expected / expected[1, 1]))[seen]
    assert ratio == pytest.approx(1.0, abs=5e-3)


def test_the_map_is_that_of_the_least_squares():
    """The map over rocking axes has the sigmas of the least squares for each axis."""
    single = foreseen('rocking about the forward axis, 5 deg, 1 Hz').sigmas[0]
    for psi, theta in ((35.26438968, -45.0), (20.0, -60.0), (60.0, -30.0)):
        chosen = settings({**DIAGONAL, 'motion.psi_deg': psi, 'motion.theta_deg': theta})
        case = bench_motions.BenchCase('this', (chosen.motion_generator.motion,))
        found = bench_motions.foresee_case(case, CHOSEN, WHITE, 600.0)
        # North in the body: forward, left, up.
        p, t = math.radians(psi), math.radians(theta)
        forward, left, up = (math.cos(p) * math.cos(t), -math.sin(p), -math.cos(p) * math.sin(t))
        azimuth, elevation = math.degrees(math.atan2(left, forward)), math.degrees(math.asin(up))
        mapped = bench_motions.direction_map(single, np.array([azimuth]), np.array([elevation]))
        assert max(found.sigmas) == pytest.approx(float(mapped[0, 0]), rel=1e-3)
    far = bench_motions.direction_map(single, np.linspace(0.0, 180.0, 181),
                                      np.linspace(-90.0, 90.0, 181))
    # The nearest whole degree is 0.26 deg off the diagonal.
    assert far.min() == pytest.approx(math.sqrt(3.0) * single, rel=0.01)
    assert far.min() > math.sqrt(3.0) * single


def test_what_cannot_be_told_apart_changes_no_reading():
    """On the diagonal scale factor and misalignments of a channel are one combination."""
    generator = CHOSEN.motion_generator
    motion = make_motion(bench_motions.diagonal_rocking(), generator.datum, generator.earth)
    record = planned_record('plan', motion, generator.datum, generator.earth, WHITE, 100.0, 0.0,
                            600.0)
    for axis in range(3):
        sums = [channel_sums(record, axis, 0)]
        noise = noise_of([record], axis)
        fit = fit_channel(sums, noise)
        weak = weak_directions(fit, sums)
        assert len(weak) == 2
        for direction in weak:
            assert set(np.flatnonzero(direction)) <= {SCALE, NEXT, LAST}
            assert direction[ASYMMETRY] == direction[DELAY] == 0.0
            # A direction of length one is unobservable if its effect is below 1e-3; three parts of
            # at most 1e-3 have the length of the root of three.
            size = direction / np.abs(direction).max() * 1e-3
            assert size @ fit.information @ size < 3.0


def test_three_angles_tell_everything():
    """With three independent axes every combination is observable."""
    record, chosen = ideal({**THREE_ANGLES, **FOG}, 60.0)
    for channel in estimate_triad([read(record, chosen, 0)]).channels:
        assert channel.weak == () and not channel.refused


def test_eigenvectors_are_those_of_lapack():
    """
    Eigenvectors equal those of LAPACK for random spectra over eight decades.

    The same holds for a singular matrix.
    """
    rng = np.random.default_rng(4)
    for count in (1, 2, 5, 8):
        q = np.linalg.qr(rng.normal(size=(count, count)))[0]
        sizes = np.sort(10.0 ** rng.uniform(-4.0, 4.0, count))
        a = q * sizes @ q.T
        a = 0.5 * (a + a.T)
        found, v = eigenvectors(a)
        assert np.sort(found) == pytest.approx(np.linalg.eigvalsh(a), rel=1e-10, abs=1e-11)
        assert v.T @ v == pytest.approx(np.eye(count), abs=1e-12)
        assert a @ v == pytest.approx(v * found, abs=1e-9)
    found, _ = eigenvectors(np.ones((3, 3)))
    assert np.sort(found) == pytest.approx([0.0, 0.0, 3.0], abs=1e-12)
