"""Two gyros with four channels: combination, parity, faults, response and drift."""

import math

import numpy as np
import pytest
from support.studies import DEG_PER_HOUR, MOTION_2, settings

from ins_sim.core.attitude import quaternion
from ins_sim.core.sensors.tuned_gyro.pair import (ARRANGEMENTS, channel_axes, CHANNELS,
                                                  COVARIANCE_FACTORS, GyroPair)
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.attitude.integration import Orientation
from ins_sim.core.prediction.drift import channel_drift
from ins_sim.core.sensors.tuned_gyro.rotor import PRESETS

TACTICAL = PRESETS['tactical']
DT = 1e-3


def pair(arrangement='paper', **options):
    """Return a pair of tactical gyros."""
    return GyroPair(TACTICAL, DT, arrangement, **options)


def steps(w, count, dt=DT):
    """Return body rates (count, 3, 3) for a function of time: step, start-middle-end, axis."""
    t = dt * (np.arange(count)[:, None] + np.array((0.0, 0.5, 1.0)))
    return np.moveaxis(np.array(np.broadcast_arrays(*w(t))), 0, -1)


def tumbling(t):
    """Return a rate about all three axes."""
    return (0.3 * np.sin(20 * t), 0.5 * np.cos(13 * t), 0.2 * np.sin(31 * t + 1))


@pytest.mark.parametrize('arrangement', ARRANGEMENTS)
def test_combination_is_least_squares(arrangement):
    """The combination equals lstsq, covariance diag(1/2, 1, 1); parity is the null vector."""
    h, combine = channel_axes(arrangement), pair(arrangement).combine
    np.testing.assert_allclose(np.linalg.inv(h.T @ h), np.diag(COVARIANCE_FACTORS), atol=1e-15)
    rows = [combine(row) for row in np.eye(4)]
    parity = np.array([row[1] for row in rows])
    assert np.linalg.norm(parity) == pytest.approx(1.0) and abs(parity @ h).max() < 1e-15
    estimate = np.array([row[0] for row in rows]).T
    np.testing.assert_allclose(estimate, np.linalg.pinv(h), atol=1e-15)


@pytest.mark.parametrize('arrangement', ARRANGEMENTS)
def test_channels_are_the_body_rates_along_their_axes(arrangement):
    """At a steady rate each channel reads the body rate along its axis; cases are right-handed."""
    w = (0.1, -0.2, 0.3)
    gyros, settled = pair(arrangement), pair(arrangement)
    for _ in range(300):
        y = gyros.channels(w, w, w)
    settled.settle(w)
    np.testing.assert_allclose(settled.channels(w, w, w), y, atol=1e-12)
    np.testing.assert_allclose(y, channel_axes(arrangement) @ w, atol=1e-12)
    omega, parity = gyros.step(w, w, w)
    np.testing.assert_allclose(omega, w, atol=1e-12)
    assert abs(parity) < 1e-12
    axes = channel_axes(arrangement)
    np.testing.assert_allclose(np.cross(axes[0], axes[1]), (0, 0, 1), atol=1e-15)
    np.testing.assert_allclose(np.cross(axes[2], axes[3]), (0, 1, 0), atol=1e-15)


def test_both_arrangements_give_the_same_rates():
    """Both arrangements give the same rates; rotated pick-offs change the parity only."""
    w = steps(tumbling, 500)
    a, b = (pair(arrangement).advance(w) for arrangement in ARRANGEMENTS)
    np.testing.assert_allclose(a[0], b[0], rtol=0, atol=1e-13)
    np.testing.assert_allclose(a[1], b[1], rtol=0, atol=1e-13)


@pytest.mark.parametrize('arrangement', ARRANGEMENTS)
@pytest.mark.parametrize('channel', range(4))
def test_parity_sees_a_fault(arrangement, channel):
    """
    The parity shows a fault of any channel if pick-offs are rotated, otherwise of two only.

    These are the two along x.
    """
    gyros, w = pair(arrangement), (0.0, 0.0, 0.0)
    gyros.inject(CHANNELS[channel], bias_rad_s=1e-3)
    _, parity = gyros.step(w, w, w)
    expected = {'turned': 0.5, 'paper': math.sqrt(0.5) if channel in (0, 3) else 0.0}
    print(f'\n{arrangement}, {CHANNELS[channel]} + 1e-3 rad/s: parity {parity:.3e} rad/s')
    assert abs(parity) == pytest.approx(1e-3 * expected[arrangement], abs=1e-18)
    gyros.clear_faults()
    assert gyros.step(w, w, w)[1] == 0.0


def test_a_dead_channel():
    """With scale 0 on a channel, rotated pick-offs show half of its rate in the parity."""
    gyros, w = pair('turned'), (0.2, 0.1, 0.0)
    for _ in range(300):
        y = gyros.channels(w, w, w)
    gyros.inject(2, scale=0.0)
    assert abs(gyros.step(w, w, w)[1]) == pytest.approx(0.5 * y[2], rel=1e-9)


def test_state_can_be_kept_and_set_back():
    """A saved state that is restored gives the same bits again."""
    w, gyros = steps(tumbling, 100), pair('turned')
    gyros.advance(w[:40])
    kept = gyros.state
    first = gyros.advance(w[40:])
    gyros.state = kept
    again = gyros.advance(w[40:])
    assert np.array_equal(first[0], again[0]) and np.array_equal(first[1], again[1])


@pytest.mark.parametrize('axis', range(3))
def test_response_is_that_of_the_simulation(axis):
    """The response matches a simulated rocking about each body axis at 10 Hz, two unlike gyros."""
    w, count = 20 * math.pi, 1000
    gyros = GyroPair((TACTICAL, PRESETS['sapegin_2016_damped']), DT)

    def rate(t):
        return [np.cos(w * t) if k == axis else 0.0 * t for k in range(3)]

    # The slow root of sapegin_2016_damped decays with 7.5 1/s.
    settle = 3000
    found = gyros.advance(steps(rate, settle + count))[0][settle:]
    t = DT * (settle + np.arange(count))
    carrier = np.exp(-1j * w * t)
    phasor = found.T @ carrier / (((np.sin(w * (t + DT)) - np.sin(w * t)) / (w * DT)) @ carrier)
    np.testing.assert_allclose(phasor, gyros.response(np.array([w]))[0][:, axis], atol=1e-7)


BAD = {"arrangement is 'heap'; expected paper or turned": lambda: pair('heap'),
       'parameters of 3 gyros are given; expected 2': lambda: GyroPair((TACTICAL,) * 3, DT),
       "channel is 'x'; expected 0 to 3 or one of gyro_1_y": lambda: pair().inject('x'),
       'channel is 4; expected 0 to 3': lambda: pair().inject(4),
       'bias_rad_s is inf and scale is 1': lambda: pair().inject(0, bias_rad_s=math.inf),
       'the gyro is unstable': lambda: GyroPair(PRESETS['sapegin_2016'], DT)}


@pytest.mark.parametrize('sentence', BAD)
def test_bad_input(sentence):
    """Invalid arguments raise an error of one message."""
    with pytest.raises(ValueError, match=sentence):
        BAD[sentence]()


@pytest.mark.parametrize('preset', ['tactical'])
def test_drift_of_motion_2_is_the_predicted_one(preset):
    """
    The drift of motion 2 is within 1 % of the Fourier sum with the response of the pair.

    It is measured from an attitude integrated at 1 kHz over whole periods. The Earth does not
    rotate here, so n is inertial and the error is that of the readings alone.
    """
    values = {**MOTION_2, 'earth.rotation': False}
    generator = settings(values, duration_s=100.0).motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    gyros = GyroPair(PRESETS[preset], DT, 'turned')
    predicted = channel_drift(motion, gyros.response)
    period = motion.period_s
    settle, count = 1000, round(2 * period / DT)
    t = np.arange(settle + count + 1) * round(1e9 * DT)
    ends = motion.at(t).omega_ib_b.tolist()
    mids = motion.at(t[:-1] + round(5e8 * DT)).omega_ib_b.tolist()
    true, found, offs, worst = Orientation('quaternion'), Orientation('quaternion'), [], 0.0
    gyros.settle(ends[0])
    for k, (start, mid, end) in enumerate(zip(ends, mids, ends[1:])):
        reading, parity = gyros.step(start, mid, end)
        worst = max(worst, abs(parity))
        true.step((start, mid, mid, end), DT)
        found.advance(tuple(DT * w for w in reading), DT)
        if k + 1 in (settle, settle + count):
            offs.append(quaternion.logarithm(quaternion.multiply(
                found.q, quaternion.conjugate(true.q))))
    # From the inertial frame at the start to n.
    q_start = tuple(motion.at(t[:1]).q_nb[0].tolist())
    measured = np.array(quaternion.rotate(q_start, np.subtract(offs[1], offs[0]) / (count * DT)))
    error = np.linalg.norm(measured - predicted) / np.linalg.norm(predicted)
    print(f'\n{preset}: predicted {predicted * DEG_PER_HOUR} deg/h, measured '
          f'{measured * DEG_PER_HOUR}, off by {error:.1e}; '
          f'parity up to {worst:.1e} rad/s')
    assert error <= 0.01


def test_parity_of_a_healthy_pair_in_motion():
    """
    The parity of a moving healthy pair is -x (w_y + w_z) / sqrt 2, x = j w A / (B Omega).

    Tolerance: 1 % at 1 Hz.
    """
    w, gyros = 2 * math.pi, pair('turned')
    found = gyros.advance(steps(lambda t: (np.cos(w * t), np.cos(w * t), 0.0 * t), 2000))[1]
    lag = TACTICAL.transverse_inertia / (TACTICAL.input_inertia * TACTICAL.omega)
    print(f'\nA / (B Omega) = {lag:.4e} s, parity up to {abs(found[1000:]).max():.3e} rad/s')
    assert abs(found[1000:]).max() == pytest.approx(w * lag / math.sqrt(2.0), rel=0.01)
