"""Azimuth and mounting error with GNSS: filter, equation (27) of Ivanov (2015), least squares."""

from dataclasses import replace
import math

from ins_sim import parameter_files, resources
from ins_sim.core.simulation.aided import make_instruments
from ins_sim.core.simulation.aided_run import navigate_aided, with_truth
from ins_sim.core.sensors.gnss import Gnss
from ins_sim.core.aiding.mounting_calibration import (azimuth_error, calibrate_mounting,
                                                      least_squares, mounting_sum)
from ins_sim.core.motion.factory import make_motion
from ins_sim.core.timeseries.histories import Truth
from ins_sim.core.simulation.inertial import imu_blocks
from ins_sim.core.sensors.velocity_meter.over_truth import MeterOnTruth
from ins_sim.core.sensors.velocity_meter.meter import VelocityMeter
import numpy as np
import pytest

ARCMIN = math.radians(1.0 / 60.0)
MOUNTING = 20.0
K_Z = 0.05


@pytest.fixture(scope='module')
def flight():
    """Return the settings, blocks and truth of the ten minutes with two turns of 60 deg."""
    settings = parameter_files.read_aided(
        [resources.config(name) for name in ('gnss_outage_flight', 'grade_mid')],
        ['duration_s:=600.0', 'gnss_model.use:=true', f'antennas.mounting_yaw_arcmin:={MOUNTING}',
         f'surrogate.k_z:={K_Z}', 'meter_model.mounting_sigma_arcmin:=30.0',
         'meter_model.scale_z_sigma:=0.1'])
    generator = settings.simulation.motion_generator
    motion = make_motion(generator.motion, generator.datum, generator.earth)
    return settings, list(with_truth(motion, imu_blocks(settings.simulation, motion)))


def fixes_of(settings, blocks):
    """Return the fixes of GNSS and of the velocity meter."""
    truth = Truth.concatenate(t for _, t in blocks)
    return (Gnss(settings.gnss).advance(truth),
            MeterOnTruth(VelocityMeter(settings.velocity_meter)).advance(truth))


def test_the_two_manoeuvres_give_azimuth_and_mounting(flight):
    """Two turns of a mid-grade free INS: equation (27) gives 20 arcmin within 2, and k_z."""
    settings, blocks = flight
    model = settings.aided_navigator
    free = navigate_aided(replace(model, filter='free',
                                  gnss_model=replace(model.gnss_model, use=False)),
                          blocks)
    gnss, meter = fixes_of(settings, blocks)
    found = calibrate_mounting(free.states, gnss, meter)
    true = -free.errors.attitude[len(free.states) // 2, 2]
    print(f'azimuth error {true / ARCMIN:.2f} arcmin, found {found.dpsi / ARCMIN:.2f} '
          f'+- {found.dpsi_sigma / ARCMIN:.2f}')
    mu, sigma = found.least_squares
    print(f'mounting {MOUNTING} arcmin, (27): {found.two_manoeuvres / ARCMIN:.2f}, least squares '
          f'{mu / ARCMIN:.2f} +- {sigma / ARCMIN:.2f}; k_z {found.k_z:.4f} '
          f'+- {found.k_z_sigma:.4f} of {K_Z}')
    assert abs(found.dpsi - true) < 4.0 * found.dpsi_sigma + 0.3 * ARCMIN
    assert mu / ARCMIN == pytest.approx(MOUNTING, abs=2.0)
    assert found.k_z == pytest.approx(K_Z, abs=4.0 * found.k_z_sigma)
    # Equation (27) assumes k_z = 0.
    plain = settings.velocity_meter
    plain = replace(plain, surrogate=replace(plain.surrogate, k_z=0.0))
    _, meter = fixes_of(replace(settings, velocity_meter=plain), blocks)
    found = calibrate_mounting(free.states, gnss, meter)
    print(f'without k_z (27): {found.two_manoeuvres / ARCMIN:.2f}')
    assert found.two_manoeuvres / ARCMIN == pytest.approx(MOUNTING, abs=2.0)


def test_the_filter_recovers_20_arcmin_to_2(flight):
    """The eskf with GNSS finds mu to within 2 arcmin and three sigmas, k_z within three."""
    settings, blocks = flight
    run = navigate_aided(settings.aided_navigator, blocks, *make_instruments(settings))
    errors = run.errors
    mu, _, k_z = errors.estimates[-1]
    print(f'eskf: mu {mu / ARCMIN:.2f} arcmin, k_z {k_z:.4f}')
    assert mu / ARCMIN == pytest.approx(MOUNTING, abs=2.0)
    assert k_z == pytest.approx(K_Z, abs=0.02)


def turned_and_scaled(velocity, total, k_z):
    """Return the reading of a meter rotated by a small angle, rad, with a lateral scale error."""
    x, z = velocity.T
    return np.stack([x, (1.0 + k_z) * (z + total * x)], axis=1)


def test_exact_data_give_exact_estimates():
    """Without noise azimuth, mounting and scale are exact to rounding."""
    t = np.arange(300.0)
    course = np.radians(30.0 + 60.0 / (1.0 + np.exp(-(t - 150.0) / 10.0)))
    v = 200.0 * np.stack([np.sin(course), np.cos(course)], axis=1)
    dpsi = 1.5e-3
    # The computed heading is too far clockwise, so the integrated velocity is rotated clockwise.
    turned = dpsi * np.stack([v[:, 1], -v[:, 0]], axis=1)
    off = 0.05 + 1e-3 * t[:, np.newaxis] * (1.0, -1.0)
    found, _ = azimuth_error(t, v + turned - turned[0] + off, v)
    assert found == pytest.approx(dpsi, abs=1e-12)
    computed = np.stack([np.full(40, 200.0), np.linspace(-8.0, 8.0, 40)], axis=1)
    read = turned_and_scaled(computed, 6e-3, 0.03)
    # In the sum the lateral velocities cancel; the effect of the scale error remains.
    assert mounting_sum(read, computed) == pytest.approx(1.03 * 6e-3, abs=1e-12)
    total, _, k_z, _ = least_squares(read, computed)
    assert (total, k_z) == pytest.approx((6e-3, 0.03), abs=1e-12)


def test_wind_on_one_side_spoils_the_sum_and_not_the_least_squares():
    """A mean drift times k_z adds to (27); the regression on V_z1N removes it."""
    computed = np.stack([np.full(40, 200.0), np.linspace(2.0, 8.0, 40)], axis=1)
    read = turned_and_scaled(computed, 6e-3, 0.05)
    assert mounting_sum(read, computed) - 1.05 * 6e-3 == pytest.approx(0.05 * 5.0 / 200.0)
    assert least_squares(read, computed)[0] == pytest.approx(6e-3, abs=1e-12)


def test_what_cannot_show_an_azimuth_is_refused():
    """A straight flight, or too few fixes, are rejected with one message each."""
    t = np.arange(60.0)
    v = np.tile((100.0, 170.0), (60, 1))
    with pytest.raises(ValueError, match='expected a turn, because the azimuth error is '
                                         'observable only in turns'):
        azimuth_error(t, v, v)
    states = Truth(*(np.zeros(2),) * 3, np.zeros(2), np.zeros((2, 3)), np.zeros((2, 4)),
                   np.zeros((2, 3)), np.zeros((2, 3)))
    with pytest.raises(ValueError, match='0 GNSS fixes; expected at least 10'):
        calibrate_mounting(states, [], [])
