"""How the truth adapter classifies its input, and the scheme that follows from it."""

import math

import numpy as np
import pytest
from support.other_simulators import AdaptedRun, OtherSimulator, PLACE

from ins_sim.core.streams.adapter.judgement import judged
from ins_sim.core.streams.adapter.knots import Sample
from ins_sim.core.streams.adapter.scheme import LOOSE, position_hold, TIGHT
from ins_sim.core.streams.adapter.stage import TruthAdapter
from ins_sim.core.streams.adapter.stamps import NominalClock, round_period_ns, steadiness
from ins_sim.settings.catalogue import build
from ins_sim.settings.truth_adapter import TruthAdapterSettings


def judgement_of(simulator, **more):
    """Return the Judgement of all samples."""
    return judged([Sample(*row) for row in simulator.samples()], **more)


def test_noise_is_found_by_axis():
    """The estimated sigmas by axis equal those of the noise within the scatter of 100 samples."""
    j = judgement_of(OtherSimulator('racetrack', 50.0, 2.0).noisy(1e-3, 0.01, 2e-3, 0.02))
    # The mean square of 300 values with common noise has a standard deviation of 10 %.
    for value, sigma in ((j.sigma_m, 1e-3), (j.sigma_rad, math.radians(0.01)),
                         (j.sigma_m_s, 2e-3), (j.sigma_rad_s, math.radians(0.02))):
        assert value == pytest.approx(sigma, rel=0.3)
    assert not j.why_not() and not j.in_parent
    assert j.force_noise(True) == pytest.approx(2.7 * 2e-3 * 50.0, rel=0.3)


def test_a_noisy_twist_is_held_tighter_where_the_positions_bear_it():
    """
    The position loop is tight for a noisy twist and loose for noisy positions.

    Between these limits its bandwidth follows the square root of the ratio of the noises.
    """
    def hold(*noise):
        return position_hold(judgement_of(OtherSimulator('racetrack', 50.0, 4.0).noisy(*noise)))
    assert hold(1e-3) == LOOSE
    assert hold(1e-3, 0.01, 1e-3, 0.01) == TIGHT
    # Tolerance: noise of two estimates, 10 % each.
    assert hold(1.5e-2, 0.0, 1e-3) == pytest.approx(
        math.sqrt(0.1 * 2.7 * 1e-3 * 50.0 / (math.sqrt(3.0) * 1.5e-2)), rel=0.3)


@pytest.mark.parametrize('rate_hz', [20.0, 50.0])
@pytest.mark.parametrize('twist, noise', [('use', {'metres_s': 1e-3}),
                                          ('ignore', {'metres': 1e-4})])
def test_the_noise_of_the_force_is_the_expected_one(twist, noise, rate_hz):
    """The noise of the force is the reported one within 15 %."""
    simulator = OtherSimulator('motion_1', rate_hz, 40.0).noisy(**noise)
    _, truths = simulator.adapted(twist=twist)
    exact = simulator.motion.at(np.array([truth.t_ns for truth in truths])).f_ib_b
    off = np.array([truth.f_ib_b for truth in truths]) - exact
    expected = judgement_of(simulator).force_noise(twist == 'use')
    assert np.sqrt(np.mean(np.sum(off * off, axis=1))) == pytest.approx(expected, rel=0.15)


@pytest.mark.parametrize('rate_hz', [20.0, 50.0, 100.0])
@pytest.mark.parametrize('name', ['racetrack', 'sinusoids', 'aggressive'])
def test_the_frame_of_the_twist_is_found(name, rate_hz):
    """The frame of the twist, parent or child, is found, and the twist agrees with the poses."""
    for parent in (False, True):
        simulator = OtherSimulator(name, rate_hz, 2.0)
        j = judgement_of(simulator.parent_twist() if parent else simulator)
        assert j.in_parent == parent and not j.why_not()
        assert judgement_of(simulator, in_parent=not parent).why_not().endswith('m/s')


def test_a_late_twist_is_found_with_its_delay():
    """A twist averaged over the last 10 ms is found to be 4.5 to 5 ms late, as specified."""
    j = judgement_of(OtherSimulator('racetrack', 50.0, 2.0).averaged_twist())
    assert 'velocity is late or wrong' in j.why_not()
    assert 4.4e-3 < j.delay_s < 5.1e-3


def test_a_twist_noisier_than_the_poses_is_left():
    """A twist that is noisier than the poses is not used."""
    adapter, truths = OtherSimulator('racetrack', 50.0, 3.0).noisy(metres_s=0.05).adapted()
    assert 'only the poses are used, not the twist (it is noisier' in adapter.notes[0]
    assert adapter.state == 'poses only' and truths


def resting_first(simulator, rest_s):
    """Prepend to the motion of a simulator a rest at its first pose with zero twist."""
    count = round(rest_s / 1e-9 / (simulator.t_ns[1] - simulator.t_ns[0]))
    simulator.t_ns = np.arange(len(simulator.t_ns) + count) * simulator.t_ns[1]
    for name in 'rqvw':
        values = getattr(simulator, name)
        first = np.repeat(values[:1] * (name in 'rq'), count, axis=0)
        setattr(simulator, name, np.concatenate([first, values]))
    return simulator


@pytest.mark.parametrize('twist, wanted', [(True, 'the twist is believed'),
                                           (False, 'only the poses')])
def test_a_vehicle_at_rest_is_judged_when_it_moves(twist, wanted):
    """The twist is not classified at rest, but as soon as the vehicle moves."""
    simulator = OtherSimulator('sinusoids', 50.0, 8.0)
    if not twist:
        simulator.without_twist()
    adapter, truths = resting_first(simulator, 5.0).adapted()
    assert 'it is zero while the vehicle does not move' in adapter.notes[0]
    assert len(adapter.notes) == 2 and wanted in adapter.notes[1]
    # The change of the scheme loses no instant.
    assert set(np.diff([truth.t_ns for truth in truths])) == {5_000_000}


def test_a_twist_that_goes_wrong_is_given_up():
    """A twist that becomes zero is rejected within two examinations of two seconds."""
    simulator = OtherSimulator('racetrack', 50.0, 12.0)
    simulator.v[250:] = simulator.w[250:] = 0.0
    adapter, truths = simulator.adapted()
    assert 'the twist is believed' in adapter.notes[0]
    assert 'only the poses are used, not the twist (it is missing)' in adapter.notes[1]
    late = [truth for truth in truths if truth.t_ns > 9_500_000_000]
    run = AdaptedRun(simulator, late)
    assert run.f < 2e-3 and run.farthest() < 1e-6


@pytest.mark.parametrize('twist, said', [
    ('use', 'the twist is believed although it is missing'),
    ('ignore', 'poses are used, not the twist (parameter twist is ignore)')])
def test_a_choice_is_kept(twist, said):
    """With twist use or ignore the scheme is fixed; the report states what auto would choose."""
    simulator = OtherSimulator('racetrack', 50.0, 5.0)
    if twist == 'use':
        simulator.without_twist()
    adapter, _ = simulator.adapted(twist=twist)
    assert len(adapter.notes) == 1 and said in adapter.notes[0]


def test_the_world_is_turned_by_its_yaw():
    """A world whose x axis points north gives the truth of one whose x axis points east."""
    plain, turned = (OtherSimulator('sinusoids', 50.0, 4.0) for _ in range(2))
    c, s = 0.0, 1.0
    x, y, z = turned.r.T
    turned.r = np.stack([c * x + s * y, c * y - s * x, z], axis=-1)
    half = -math.radians(45.0)
    qx, qy, qz, qw = turned.q.T
    a, b = math.sin(half), math.cos(half)
    turned.q = np.stack([b * qx - a * qy, b * qy + a * qx, b * qz + a * qw, b * qw - a * qz], -1)
    for parent in (False, True):
        for simulator in (plain, turned):
            if parent:
                simulator.parent_twist()
        for one, other in zip(plain.adapted()[1], turned.adapted(world__yaw_deg=90.0)[1]):
            for values, others in zip(one[1:], other[1:]):
                assert values == pytest.approx(others, abs=1e-9)


def test_either_sign_of_a_quaternion_is_the_same():
    """Alternating signs of quaternions, and norms within 1e-3 of one, change only the rounding."""
    plain, other = (OtherSimulator('motion_2', 50.0, 4.0) for _ in range(2))
    length = 1.0 + 9e-4 * np.sin(np.arange(len(other.q)))
    other.q = other.q * (length * np.where(np.arange(len(other.q)) % 3, -1.0, 1.0))[:, None]
    for values in ({}, {'twist': 'ignore'}):
        for one, two in zip(plain.adapted(**values)[1], other.adapted(**values)[1]):
            assert one.omega_ib_b == pytest.approx(two.omega_ib_b, abs=1e-12)
            assert one.f_ib_b == pytest.approx(two.f_ib_b, abs=1e-9)


def test_nominal_instants_do_not_shake():
    """With stamps off by 1 ms, nominal instants give the force of a steady input."""
    simulator = OtherSimulator('racetrack', 50.0, 20.0).off_stamps(1e-3)
    adapter, truths = simulator.adapted(stamps='nominal')
    run = AdaptedRun(simulator, truths)
    assert run.f < 5e-3 and run.farthest() < 0.1


def test_a_round_rate_is_known_from_two_seconds():
    """A rate of 50 Hz is recognised from two seconds despite jitter; an odd rate is kept."""
    rng = np.random.default_rng(1)
    for period, wanted in ((2e7, 2e7), (16e6, 16e6), (2.0123e7, None)):
        steady, line = steadiness(np.rint(np.arange(101) * period + 1e5 * rng.standard_normal(
            101)).astype(np.int64).tolist())
        assert steady.jitter_ns == pytest.approx(1e5, rel=0.2) and len(line) == 101
        assert round_period_ns(steady, 101) == (wanted or steady.period_ns)


def test_a_nominal_clock_follows_a_rate_that_is_another():
    """Nominal instants rise and stay within a few periods of stamps that drift by 100 ppm."""
    clock = NominalClock(0, 2e7)
    stamps = [round(k * 2e7 * (1.0 + 1e-4)) for k in range(1, 20001)]
    instants = [clock.instant(t_ns) for t_ns in stamps]
    assert (np.diff(instants) > 0).all()
    # Twice the relative drift divided by the bandwidth.
    assert abs(instants[-1] - stamps[-1]) == pytest.approx(2e-4 / 0.1 * 1e9, rel=0.01)


@pytest.mark.parametrize('smoothing_s', [0.0, 0.1])
def test_poses_are_smoothed_over_the_time_that_is_set(smoothing_s):
    """Smoothing reduces the noise of the force and delays the truth by half its length."""
    simulator = OtherSimulator('motion_1', 100.0, 6.0).noisy(1e-4)
    adapter, truths = simulator.adapted(twist='ignore', smoothing_s=smoothing_s)
    run = AdaptedRun(simulator, truths)
    assert (run.f > 2.0) == (smoothing_s == 0.0)
    late_ns = int(simulator.t_ns[-1]) - truths[-1].t_ns
    assert late_ns == 20_000_000 + round(0.5e9 * smoothing_s)


@pytest.mark.parametrize('truth_rate_hz', [0.0, 200.0, 333.0, 1000.0])
def test_the_truth_has_its_own_rate(truth_rate_hz):
    """Truth has any rate from twice the IMU's; it begins at a multiple of the IMU period."""
    adapter, truths = OtherSimulator('sinusoids', 30.0, 4.0).adapted(truth_rate_hz=truth_rate_hz)
    stamps = [truth.t_ns for truth in truths]
    assert stamps[0] % 10_000_000 == 0
    assert set(np.diff(stamps)) == {round(1e9 / (truth_rate_hz or 200.0))}


def test_memory_is_bounded():
    """The stage stores only two seconds of knots and what the curves need, in any run."""
    adapter = TruthAdapter(build(TruthAdapterSettings, PLACE))
    simulator = OtherSimulator('racetrack', 200.0, 30.0)
    for row in simulator.samples():
        adapter.push(*row)
    assert len(adapter._watch.knots) <= 201
    assert len(adapter._fit._samples) <= 8 and not adapter._look
