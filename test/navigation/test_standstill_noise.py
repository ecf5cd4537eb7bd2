"""Standard error of a gyrocompass: gyro bias, rocking base, noise at any sampling rate."""

import math

import numpy as np
import pytest
from support.studies import settings as simulation

from ins_sim.core.attitude import quaternion
from ins_sim.core.attitude.angles import from_compass, to_compass
from ins_sim.core.earth import ellipsoid
from ins_sim.core.navigation import alignment
from ins_sim.core.postprocessing import standstill
from ins_sim.core.postprocessing.standstill import standard_error
from ins_sim.core.postprocessing.windows import StillWindow
from ins_sim.core.postprocessing.imu_record import RecordedImu
from ins_sim.core.postprocessing.sources import Sources
from ins_sim.core.postprocessing.navigate import navigate
from ins_sim.settings.catalogue import build
from ins_sim.settings.navigate import AlignmentSettings, NavigateSettings
from ins_sim.settings.presets import preset
from ins_sim.studies.at_rest import resting_record

LAT = math.radians(55.0)
OMEGA = ellipsoid.ROTATION_RATE
DEG_H = math.radians(1.0) / 3600.0


def heading_error(q_nb, q_true):
    """Return the heading minus the true one, rad."""
    error = float(to_compass(np.array(q_nb))[2] - to_compass(np.array(q_true))[2])
    return math.remainder(error, 2.0 * math.pi)


def fog(seed):
    """Return the RecordedImu of the FOG preset at rest for 60 s at latitude 55 degrees."""
    chosen = simulation({**preset('tactical_fog'), 'seed': seed, 'datum.latitude_deg': 55.0,
                         'motion.theta_deg': 0.0, 'rate_hz': 100.0})
    blocks = list(resting_record(chosen, 61.0))
    t_ns, omega, f = (np.concatenate([getattr(b, name) for b in blocks])
                      for name in ('t_ns', 'omega', 'f'))
    return RecordedImu(t_ns, omega, f, np.full((len(t_ns), 4), np.nan))


def test_the_heading_of_fog_gyros_is_within_what_is_stated():
    """
    The heading error of the FOG preset agrees with its standard error over 24 draws.

    1 deg/h at latitude 55 degrees turns the heading by 1 / (15.04 cos 55) = 6.64 degrees. The mean
    square of error over standard error is 1 to within the 99.9 % quantiles of chi-square with 24
    degrees of freedom, 0.34 and 2.13.
    """
    squares, largest = [], 0.0
    for seed in range(24):
        still = standstill.find_standstill(fog(seed), AlignmentSettings())
        compass = alignment.gyrocompass(still, LAT, 1.0 * DEG_H)
        error = heading_error(compass.q_nb, (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
        squares.append((error / compass.sigma) ** 2)
        largest = max(largest, abs(error))
        assert math.degrees(compass.noise_sigma) < 1.0
        assert 6.6 < math.degrees(compass.sigma) < 7.0
        assert not alignment.is_trusted(compass, still, LAT, math.radians(2.0))
    print(f'\nFOG, 24 draws: largest heading error {math.degrees(largest):.3g} deg, standard '
          f'error {math.degrees(compass.sigma):.3g} deg, normalised square {np.mean(squares):.2f}')
    assert math.degrees(largest) > 5.0
    assert 0.34 < np.mean(squares) < 2.13


@pytest.mark.parametrize('given, trusted', [({}, False), ({'sigma': 1.0}, False),
                                            ({'sigma': 0.01}, True)])
def test_navigate_asks_for_the_bias_or_assumes_10_deg_h(given, trusted):
    """Gyro bias cannot be seen in a record: trust in the heading depends on the setting."""
    q_nb = tuple(from_compass(0.0, 0.0, 1.0)[0].tolist())
    rate = quaternion.rotate_back(q_nb, (0.0, OMEGA * math.cos(LAT), OMEGA * math.sin(LAT)))
    force = (0.0, 0.0, ellipsoid.gravity(math.sin(LAT), 0.0))
    imu = RecordedImu(np.arange(3000) * 20_000_000, np.tile(rate, (3000, 1)),
                      np.tile(force, (3000, 1)), np.full((3000, 4), np.nan))
    values = {'initial.position': 'given', 'initial.latitude_deg': 55.0,
              'alignment.longest_s': 20.0}
    if given:
        values['alignment.gyro_bias_sigma_deg_h'] = given['sigma']
    chosen = build(NavigateSettings, values)
    if trusted:
        figures = navigate(chosen, Sources('x', imu, 'imu')).figures
        assert figures['heading_source'] == 'gyrocompass'
        assert figures['heading_sigma_deg'] == pytest.approx(0.0664, abs=1e-3)
        return
    bias = given.get('sigma', 10.0)
    with pytest.raises(ValueError, match=f'standard error {66.4 if bias > 5.0 else 6.64} deg, '
                       f'from noise of .* deg and a gyro bias of {bias:g} deg/h '
                       r'\(alignment.gyro_bias_sigma_deg_h'):
        navigate(chosen, Sources('x', imu, 'imu'))


def rocking(seed, frequency_hz, noise):
    """Return 61 s at 100 Hz on a base that rocks by 0.01 degree about east and north."""
    rng = np.random.default_rng(seed)
    t = np.arange(6100) * 0.01
    w, a = 2.0 * math.pi * frequency_hz, math.radians(0.01)
    phase = rng.uniform(0.0, 2.0 * math.pi, 2)
    rate = np.tile((0.0, OMEGA * math.cos(LAT), OMEGA * math.sin(LAT)), (len(t), 1))
    rate[:, 0] += a * w * np.cos(w * t + phase[0])
    rate[:, 1] += a * w * np.cos(w * t + phase[1])
    force = np.tile((0.0, 0.0, ellipsoid.gravity(math.sin(LAT), 0.0)), (len(t), 1))
    force[:, 1] += 9.8 * a * np.sin(w * t + phase[0])
    force[:, 0] -= 9.8 * a * np.sin(w * t + phase[1])
    return RecordedImu(np.round(t * 1e9).astype(np.int64),
                       rate + noise * rng.standard_normal(rate.shape), force,
                       np.full((len(t), 4), np.nan))


@pytest.mark.parametrize('noise', [0.0, 1e-6, 1e-4])
@pytest.mark.parametrize('frequency_hz', [0.43, 0.83, 1.27, 1.71, 3.37])
def test_a_parked_vehicle_that_rocks(frequency_hz, noise):
    """
    On a rocking base the rms of error over standard error, 40 draws, is between 0.25 and 4.

    The angle is bounded: after 60 s the error of the mean rate is at most twice 0.01 degree over
    60 s, while windows of 1 s, if treated as independent, scatter by many times that.
    """
    ratios, sigmas = [], []
    for seed in range(40):
        still = standstill.find_standstill(rocking(seed, frequency_hz, noise), AlignmentSettings())
        compass = alignment.gyrocompass(still, LAT)
        error = heading_error(compass.q_nb, (0.0, 0.0, 0.0, 1.0))
        ratios.append(error / compass.sigma)
        sigmas.append(math.degrees(compass.sigma))
    rms = math.sqrt(np.mean(np.square(ratios)))
    print(f'\n{frequency_hz:g} Hz, noise {noise:g} rad/s: standard error {np.mean(sigmas):.3g} '
          f'deg, error over it {rms:.2f}')
    assert 0.25 < rms < 4.0


def test_of_white_noise_it_is_the_scatter_over_root_n():
    """
    For white noise the standard error is the standard deviation divided by sqrt(n).

    60 windows give 30 degrees of freedom, so that the mean square of 300 draws is within 4 of its
    standard deviations, sqrt(2 / 30 / 900). For random-walk noise the result is far larger.
    """
    rng = np.random.default_rng(1)
    squares = [standard_error(rng.standard_normal((600, 3)), 60) ** 2 * 600 for _ in range(300)]
    assert abs(np.mean(squares) - 1.0) < 4.0 * math.sqrt(2.0 / 30.0 / 900.0)
    slow = np.cumsum(rng.standard_normal((600, 3)), axis=0)
    assert (standard_error(slow, 60) > 2.0 * slow.std(axis=0) / math.sqrt(600.0)).all()


@pytest.mark.parametrize('rate_hz', [100.0, 8000.0])
def test_noise_is_judged_by_its_rate(rate_hz):
    """
    The noise limit allows for the sampling rate: 0.2 m/s^2 is accepted at 8 kHz, not at 100 Hz.

    0.2 m/s^2 per sample at 8 kHz is 0.022 at 100 Hz, the noise of a MEMS IMU at rest. At 100 Hz a
    scatter of 0.2 comes from an engine or a hand: above the limit of 0.15.
    """
    rng = np.random.default_rng(0)
    n = round(7.0 * rate_hz)
    imu = RecordedImu(np.round(np.arange(n) * 1e9 / rate_hz).astype(np.int64),
                      0.04 * rng.standard_normal((n, 3)),
                      [0.0, 0.0, 9.8] + 0.2 * rng.standard_normal((n, 3)), np.full((n, 4), np.nan))
    if rate_hz == 100.0:
        with pytest.raises(ValueError, match='no stationary interval'):
            standstill.find_standstill(imu, AlignmentSettings())
        return
    still = standstill.find_standstill(imu, AlignmentSettings())
    assert still.together == 20 and still.windows >= 5
    # 0.2 / sqrt(20), for 400 means in a window.
    assert still.force_sd == pytest.approx(0.2 / math.sqrt(20.0), rel=0.05)
    assert still.rate_sd == pytest.approx(0.04 / math.sqrt(20.0), rel=0.05)


def test_the_end_of_a_standstill_is_explained():
    """The message shows the criterion that a window breaks, even if the window itself is quiet."""
    still = StillWindow(0, 100, 10**9, True, np.array([0.0, 0.0, 9.8]), np.zeros(3), 0.01, 1e-4)
    turned = still._replace(middle_ns=3 * 10**9, force=np.array([0.0, 2.0, 9.6]))
    for last, reason in ((turned, 'change of the means 2 m/s^2 and 0 rad/s'),
                         (still._replace(moving=True), 'the reference moves faster than 0.3 m/s')):
        search = standstill.StandstillSearch(AlignmentSettings(), 10**9)
        assert [search.take(window) for window in (still, still, last)] == [None] * 3
        assert 'the vehicle has moved at' in search.moved and reason in search.moved
